// Connects the parts of the page: frames from the node update the model, and the other parts draw it.

import {Connection} from './connection.js';
import {Drive} from './drive.js';
import {Fleet} from './fleet.js';
import {Floor} from './floor.js';
import {LogView} from './log.js';
import {Model, SOURCES, endOf} from './model.js';
import {savePng, saveSvg} from './picture.js';
import {Plot} from './plot.js';
import {EarlierRuns, Poses, fixed, rowOf} from './tables.js';
import {connectView} from './view_controls.js';

const byId = id => document.getElementById(id);
const LEGEND = {truth: 'truth', odometry: 'odometry', estimate: 'estimate',
  commanded: 'commanded', reported: 'reported by the wheels', true: 'true'};

function notify(text, alarm = false) {
  byId('notice').className = alarm ? 'alarm' : '';
  byId('notice').textContent = text;
  byId('notice').hidden = !text;
}

const model = new Model();
const robot = new URLSearchParams(location.search).get('robot') || '';
const connection = new Connection(robot);
const floor = new Floor(byId('floor'));
const fleet = new Fleet(floor, robot);
const poses = new Poses(byId('tables'));
const earlierRuns = new EarlierRuns(byId('earlier'), () => floor.drawEarlier(model.earlier));
const log = new LogView(byId('lines'));
const drive = new Drive(connection, model, notify);
const plots = [new Plot(byId('linear'), 'forward (m/s)', 1, 0.25), new Plot(byId('angular'), 'turning (rad/s), left is up', 2, 1.2)];
let waiting = false;    // whether a redraw has been requested

function facts() {
  const {status} = model, found = [];
  if (status.base) {
    found.push(['Robot', status.simulated ? 'simulated' : 'real']);
  }
  if (status.surface) {
    found.push(['Surface', status.surface]);
  }
  if (status.seed && status.surface !== 'ideal') {
    found.push(['Seed', status.seed]);
  }
  if (status.base) {
    found.push(['Time', status.simulated_time ? `simulated, ${status.factor} times real time` : 'real']);
  }
  return found;
}

function drawFacts() {
  const {title} = model.status;
  if (title && title !== document.title) {
    document.title = byId('title').textContent = title;
  }
  const text = JSON.stringify(facts());
  if (byId('facts').dataset.shown !== text) {
    byId('facts').dataset.shown = text;
    byId('facts').replaceChildren(...facts().map(([name, value]) => {
      const pair = document.createElement('div'), dt = document.createElement('dt'), dd = document.createElement('dd');
      dt.textContent = name;
      dd.textContent = value;
      pair.append(dt, dd);
      return pair;
    }));
  }
}

function draw() {
  waiting = false;
  floor.draw(model);
  poses.draw(model);
  log.draw(model.log);
  drive.draw();
  drawFacts();
  earlierRuns.draw(model.earlier);
  drawHeadline();
  fleet.update(model.status);
  const end = byId('end'), live = Number(end.value) >= Number(end.max);
  end.max = Math.max(0.1, model.time || 0);
  if (live) {
    end.value = end.max;
  }
  for (const plot of plots) {
    plot.draw(model.speeds, model.time === null ? null : live ? model.time : Number(end.value), Number(byId('window').value));
  }
}

function kindOf({name, stopped}) {
  return `${name}${stopped ? ', stopped' : ''}`;
}

// What the exercise is about: how far the robot has missed its start.
function drawHeadline() {
  const {status, run} = model, end = endOf(model.poses);
  const text = end && run && status.started === run && status.outcome === 'finished' ?
    `${model.poses.truth ? 'Missed' : 'By its odometry, missed'} the start by ${fixed(Math.hypot(end[0], end[1]), 2)} m and ${
      fixed(Math.abs(Number(rowOf(end)[2])), 0)}°` : '';
  if (byId('headline').textContent !== text) {
    byId('headline').textContent = text;
  }
}

// The lines of a saved picture: what was run, and the numbers, which are also the legend of the colors.
function caption() {
  const {surface, seed} = model.status;
  const what = [model.run, surface, surface && surface !== 'ideal' && seed && `seed ${seed}`].filter(Boolean).join(', ');
  const shown = model.earlier.filter(run => run.shown);
  const earlier = [...new Set(shown.map(kindOf))].map(kind =>
    ['', `Earlier runs (${kind}): ${shown.filter(run => kindOf(run) === kind).map(run => run.number).join(', ')}`]);
  const numbers = SOURCES.filter(source => model.poses[source]).map(source => {
    const [x, y, heading, distance] = rowOf(model.poses[source]);
    return [source, `${source}: x ${x} m, y ${y} m, heading ${heading}°, ${distance} m from the start`];
  });
  return [['', what], ...earlier, ...numbers];
}

function redraw() {
  if (!waiting) {
    waiting = true;
    requestAnimationFrame(draw);
  }
}

function legendItem(name, parent, checkbox) {
  const label = document.createElement(checkbox ? 'label' : 'span'), swatch = document.createElement('span');
  swatch.className = `swatch ${name}`;
  if (checkbox) {
    const box = document.createElement('input');
    box.type = 'checkbox';
    box.checked = true;
    box.onchange = () => {
      floor.show(name, box.checked);
      redraw();
    };
    label.append(box);
  }
  label.append(swatch, ` ${LEGEND[name]}`);
  parent.append(label);
}

function showConnection() {
  if (drive.connected) {
    byId('connection').className = connection.silent ? 'lost' : 'live';
    byId('connection').textContent = connection.silent ? 'No answer: the page does not show where the robot is now'
      : drive.trusted ? 'Connected' : 'Connected, watching only';
  }
}

function large() {
  const on = document.body.classList.toggle('large');
  byId('large').setAttribute('aria-pressed', on);
  redraw();
}

SOURCES.forEach(source => legendItem(source, byId('legend'), true));
['commanded', 'reported', 'true'].forEach(name => legendItem(name, byId('speed-legend'), false));
connectView(floor, model, redraw);
byId('save-svg').onclick = () => saveSvg(floor.svg, caption());
byId('save-png').onclick = () => savePng(floor.svg, caption());
byId('window').onchange = redraw;
byId('end').oninput = redraw;
byId('large').onclick = large;

connection.addEventListener('welcome', ({detail}) => {
  model.forget();
  drive.trusted = detail.trusted;
  drive.connected = true;
  drive.setHand(false);
  showConnection();
  notify(detail.known_token ? '' :
    'The token in this address is not valid. Open the complete address that the web view printed when it was last started.');
});
connection.addEventListener('frame', ({detail}) => {
  model.add(detail);
  redraw();
});
connection.addEventListener('stopping', ({detail}) => drive.stopReceived(detail));
connection.addEventListener('stopped', ({detail}) => drive.stopAnswered(detail));
connection.addEventListener('silent', () => {
  showConnection();
  drive.draw();
});
connection.addEventListener('heard', showConnection);
connection.addEventListener('refused', ({detail}) => drive.refused(detail));
connection.addEventListener('lost', ({detail}) => {
  drive.connected = false;
  drive.setHand(false);
  redraw();
  byId('connection').className = 'lost';
  byId('connection').textContent = `Not connected${detail ? ` (${detail})` : ''}; retrying`;
});
window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
// for tests, and for use in the console of the browser
window.rbx1 = {model, floor, drive};
