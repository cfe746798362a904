// The floor from above, x to the right and y up, in meters: grid, start, paths, arrows, robots, and earlier runs.

import {SOURCES} from './model.js';
import {element, short} from './svg.js';

const CELL = 0.5;                   // m, as in RViz
const RADIUS = 0.165;               // m, radius of the robot
const ARROW = {length: 0.3, head: 0.08};                // m, as in sim.rviz
const TOLERANCE = {distance: 0.1, angle: 0.5};          // m, rad: between arrows; more of them in a turn cover each other
const FAR = 1000;                   // m from the start: a robot beyond it is only in the table
const MANY = 10;                    // earlier runs beyond which their numbers are smaller
const MIN_SCALE = 10, MAX_SCALE = 3000;                 // pixels per meter
const SEEN = {left: -0.5, right: 1.5, bottom: -0.6, top: 1.0};     // m, visible area before the robot has moved

function wrap(angle) {
  return Math.atan2(Math.sin(angle), Math.cos(angle));
}

// Whether a pose is drawn. At 1e17 m, the coordinates of neighboring grid lines are the same number.
function near([x, y]) {
  return Math.hypot(x, y) < FAR;
}

function arrowPath([x, y, yaw]) {
  const tip = [x + ARROW.length * Math.cos(yaw), y + ARROW.length * Math.sin(yaw)];
  const side = turn => {
    const angle = yaw + Math.PI - turn;
    return `${(tip[0] + ARROW.head * Math.cos(angle)).toFixed(3)} ${(tip[1] + ARROW.head * Math.sin(angle)).toFixed(3)}`;
  };
  const end = `${tip[0].toFixed(3)} ${tip[1].toFixed(3)}`;
  return `M${x} ${y}L${end}M${side(0.4)}L${end}L${side(-0.4)}`;
}

// The path and the arrows of one source. Only new points are added.
class Trace {
  constructor(source, lines, arrows) {
    this.line = element('path', {class: `path ${source}`, 'vector-effect': 'non-scaling-stroke'}, lines);
    this.arrow = element('path', {class: `arrow ${source}`, 'vector-effect': 'non-scaling-stroke'}, arrows);
    this.begin();
  }

  begin() {
    this.count = 0;
    this.lineText = this.arrowText = '';
    this.last = null;       // the pose of the last arrow
  }

  draw(points) {
    if (points.length === this.count) {
      return;
    }
    const before = this.arrowText;
    for (const point of points.slice(this.count).filter(near)) {
      this.lineText += `${this.lineText ? 'L' : 'M'}${point[0]} ${point[1]}`;
      if (!this.last || Math.hypot(point[0] - this.last[0], point[1] - this.last[1]) >= TOLERANCE.distance ||
          Math.abs(wrap(point[2] - this.last[2])) >= TOLERANCE.angle) {
        this.arrowText += arrowPath(point);
        this.last = point;
      }
    }
    this.count = points.length;
    this.line.setAttribute('d', this.lineText);
    if (this.arrowText !== before) {
      this.arrow.setAttribute('d', this.arrowText);
    }
  }

  erase() {
    this.begin();
    this.line.setAttribute('d', '');
    this.arrow.setAttribute('d', '');
  }
}

function lineOf(points) {
  return points.map(([x, y], index) => `${index ? 'L' : 'M'}${x} ${y}`).join('');
}

export class Floor {
  constructor(svg) {
    this.svg = svg;
    this.grid = element('path', {class: 'grid'}, svg);
    this.axes = element('path', {class: 'axes'}, svg);
    this.labels = element('g', {}, svg);
    this.world = element('g', {}, svg);
    this.arrows = element('g', {class: 'arrows'}, this.world);
    this.earlier = element('g', {class: 'earlier'}, this.world);
    const lines = element('g', {}, this.world);
    this.traces = Object.fromEntries(SOURCES.map(source => [source, new Trace(source, lines, this.arrows)]));
    element('path', {class: 'start', d: 'M-.06 0H.06M0-.06V.06', 'vector-effect': 'non-scaling-stroke'}, this.world);
    element('circle', {class: 'start', r: RADIUS, 'stroke-dasharray': '2 4', 'vector-effect': 'non-scaling-stroke'}, this.world);
    this.robots = Object.fromEntries(['odometry', 'truth'].map(source => [source, this.makeRobot(source)]));
    this.shown = Object.fromEntries(SOURCES.map(source => [source, true]));
    this.view = {x: 0.5, y: 0.2, scale: 150};
    this.following = false;
    this.touched = false;       // whether the user has moved the view
    this.cleared = -1;
    this.others = {};       // other robots of a fleet, by name
    this.places = [];       // their starts
    new ResizeObserver(() => this.touched ? this.project() : this.fit()).observe(svg);
  }

  makeRobot(source, parent = this.world) {
    const robot = element('g', {class: `robot ${source}`}, parent);
    element('circle', {r: RADIUS, 'vector-effect': 'non-scaling-stroke'}, robot);
    element('path', {d: `M${-0.4 * RADIUS} ${0.5 * RADIUS}L${0.8 * RADIUS} 0L${-0.4 * RADIUS} ${-0.5 * RADIUS}`,
      fill: 'none', 'vector-effect': 'non-scaling-stroke'}, robot);
    return robot;
  }

  draw(model) {
    if (model.cleared !== this.cleared) {
      this.cleared = model.cleared;
      Object.values(this.traces).forEach(trace => trace.erase());
    }
    if (model.earlier !== this.drawn) {
      this.drawn = model.earlier;
      this.drawEarlier(model.earlier);
    }
    this.poses = model.poses;
    this.points = model.paths;
    for (const source of SOURCES) {
      this.traces[source].draw(model.paths[source]);
    }
    for (const [source, robot] of Object.entries(this.robots)) {
      const pose = model.poses[source], drawn = pose && near(pose);
      robot.style.display = drawn && this.shown[source] ? '' : 'none';
      if (drawn) {
        robot.setAttribute('transform', `translate(${pose[0]} ${pose[1]}) rotate(${pose[2] * 180 / Math.PI})`);
      }
    }
    // if the true pose is known, the robot at its odometry pose is transparent, as in RViz
    this.robots.odometry.classList.toggle('ghost', 'truth' in model.poses);
    const pose = model.poses.truth || model.poses.odometry;
    if (!pose || !near(pose)) {
      return;
    }
    if (this.following) {
      Object.assign(this.view, {x: pose[0], y: pose[1]});
      this.project();
    } else if (!this.touched && !this.inside(pose)) {
      this.fit();
    }
  }

  // Another robot of a fleet, with its name at its start; offset: m to the left of the selected robot.
  drawOther(name, index, offset, model) {
    const source = 'truth' in model.poses ? 'truth' : 'odometry', pose = model.poses[source];
    this.others[name] = this.others[name] || this.makeOther(name, index, offset);
    const {robot, path} = this.others[name];
    robot.style.display = pose && near(pose) ? '' : 'none';
    if (pose && near(pose)) {
      robot.setAttribute('transform', `translate(${pose[0]} ${pose[1]}) rotate(${pose[2] * 180 / Math.PI})`);
    }
    path.setAttribute('d', lineOf(model.paths[source].filter(near)));
  }

  makeOther(name, index, offset) {
    const group = element('g', {class: `other robot-${index % 5}`, transform: `translate(0 ${offset})`}, this.world);
    const path = element('path', {class: 'path', 'vector-effect': 'non-scaling-stroke'}, group);
    const robot = this.makeRobot('', group);
    element('text', {transform: 'translate(-.5 -.03) scale(1 -1)'}, group).textContent = name;
    group.onclick = () => { location.search = `?robot=${name}`; };
    this.places.push([0, offset]);
    if (!this.touched) {
      this.fit();
    }
    return {robot, path};
  }

  // The paths of earlier runs, each with its number at the end; numbers at the same place stand beside each other.
  drawEarlier(runs) {
    const many = runs.length > MANY, size = many ? 0.05 : 0.08, places = [];
    this.earlier.classList.toggle('many', many);
    this.earlier.replaceChildren(...runs.filter(run => run.shown && run.points.some(near)).map(({number, name, points}) => {
      const group = element('g', {'data-run': name}), drawn = points.filter(near);
      element('path', {class: 'path', 'vector-effect': 'non-scaling-stroke',
        d: lineOf(drawn)}, group);
      // the number is at the end of the path, or beside another one there; if there is no place, it is left out
      const [end, y] = drawn[drawn.length - 1], x = [end, end + size, end + 2 * size].find(each => !places.some(
        place => Math.abs(place[0] - each) < size && Math.abs(place[1] - y) < size));
      if (x !== undefined) {
        places.push([x, y]);
        element('text', {transform: `translate(${x} ${y}) scale(1 -1)`}, group).textContent = number;
      }
      return group;
    }));
  }

  show(source, shown) {
    this.shown[source] = shown;
    for (const part of [this.traces[source].line, this.traces[source].arrow]) {
      part.style.display = shown ? '' : 'none';
    }
  }

  size() {
    return [this.svg.clientWidth || 600, this.svg.clientHeight || 400];
  }

  inside([x, y]) {
    const [width, height] = this.size(), margin = 2 * RADIUS;
    return Math.abs(x - this.view.x) < width / 2 / this.view.scale - margin &&
      Math.abs(y - this.view.y) < height / 2 / this.view.scale - margin;
  }

  // Show the start, all robots and all paths, except for poses that are not drawn.
  fit() {
    const box = {...SEEN}, margin = 0.35;
    const poses = [...this.places, ...Object.values(this.poses || {}), ...Object.values(this.points || {}).flat()];
    for (const [x, y] of poses.filter(near)) {
      box.left = Math.min(box.left, x - margin);
      box.right = Math.max(box.right, x + margin);
      box.bottom = Math.min(box.bottom, y - margin);
      box.top = Math.max(box.top, y + margin);
    }
    const [width, height] = this.size();
    this.touched = false;
    this.view = {x: (box.left + box.right) / 2, y: (box.bottom + box.top) / 2,
      scale: this.limited(Math.min(width / (box.right - box.left), height / (box.top - box.bottom)))};
    this.project();
  }

  limited(scale) {
    return Math.max(MIN_SCALE, Math.min(MAX_SCALE, scale));
  }

  // Zoom by a factor about the point (px, py), in pixels from the upper left corner.
  zoom(factor, px, py) {
    const [width, height] = this.size(), before = this.view.scale;
    px = px ?? width / 2;
    py = py ?? height / 2;
    const scale = this.limited(before * factor), moved = 1 / before - 1 / scale;
    this.view.x += (px - width / 2) * moved;
    this.view.y -= (py - height / 2) * moved;
    this.view.scale = scale;
    this.touched = true;
    this.project();
  }

  // Move the view by pixels.
  pan(dx, dy) {
    this.view.x -= dx / this.view.scale;
    this.view.y += dy / this.view.scale;
    this.touched = true;
    this.project();
  }

  // Update grid, labels, and the transform from meters to pixels.
  project() {
    const [width, height] = this.size(), {x, y, scale} = this.view;
    this.world.setAttribute('transform', `translate(${width / 2} ${height / 2}) scale(${scale} ${-scale}) translate(${-x} ${-y})`);
    const px = value => Math.round((value - x) * scale + width / 2) + 0.5;
    const py = value => Math.round(height / 2 - (value - y) * scale) + 0.5;
    const first = (low, step) => Math.ceil(low / step) * step;
    const every = CELL * 2 ** Math.max(0, Math.ceil(Math.log2(8 / (CELL * scale))));    // lines at least 8 pixels apart
    const label = CELL * 2 ** Math.max(0, Math.ceil(Math.log2(45 / (CELL * scale))));
    let grid = '';
    const texts = [];
    for (let gx = first(x - width / 2 / scale, every); gx < x + width / 2 / scale; gx += every) {
      grid += `M${px(gx)} 0V${height}`;
      if (Math.abs(gx / label - Math.round(gx / label)) < 1e-6) {
        texts.push([px(gx) + 3, height - 5, `${short(gx)}${Math.abs(gx) < 1e-9 ? ' m' : ''}`]);
      }
    }
    for (let gy = first(y - height / 2 / scale, every); gy < y + height / 2 / scale; gy += every) {
      grid += `M0 ${py(gy)}H${width}`;
      if (Math.abs(gy / label - Math.round(gy / label)) < 1e-6 && py(gy) < height - 25) {
        texts.push([4, py(gy) - 4, short(gy)]);
      }
    }
    this.grid.setAttribute('d', grid);
    this.axes.setAttribute('d', `M${px(0)} 0V${height}M0 ${py(0)}H${width}`);
    this.labels.replaceChildren(...texts.map(([tx, ty, text]) => {
      const made = element('text', {x: tx, y: ty});
      made.textContent = text;
      return made;
    }));
  }
}
