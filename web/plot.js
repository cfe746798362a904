// Plot of the commanded, reported and true speed over time.

import {SPEEDS} from './model.js';
import {element, roundStep, short} from './svg.js';

const MISSING = 2;        // s between two samples without a line; the node sends at least one per second
const MARGIN = {left: 42, right: 8, top: 18, bottom: 20};      // pixels

export class Plot {
  // index: of the value in a sample, 1: forward speed, 2: turn rate; least: smallest range of the vertical axis.
  constructor(svg, title, index, least) {
    Object.assign(this, {svg, title, index, least});
    this.grid = element('path', {class: 'grid'}, svg);
    this.axes = element('path', {class: 'axes'}, svg);
    this.labels = element('g', {}, svg);
    this.curves = Object.fromEntries(['true', 'reported', 'commanded'].map(
      name => [name, element('path', {class: `curve ${name}`}, svg)]));
  }

  // The samples since the time `from`, and the last sample before it.
  static visible(samples, from) {
    let first = samples.length;
    while (first > 0 && samples[first - 1][0] >= from) {
      first -= 1;
    }
    return samples.slice(Math.max(0, first - 1));
  }

  draw(speeds, end, seconds) {
    const width = this.svg.clientWidth, height = this.svg.clientHeight;
    if (!width || end === null) {
      return;
    }
    const from = Math.max(0, end - seconds);
    const shown = Object.fromEntries(SPEEDS.map(name => [name, Plot.visible(speeds[name], from)]));
    const values = Object.values(shown).flat().map(sample => sample[this.index]);
    let low = Math.min(0, ...values), high = Math.max(0, ...values);
    if (high - low < this.least) {
      [low, high] = low < 0 && high <= 0 ? [-this.least, 0] : [low, low + this.least];
    }
    const room = 0.08 * (high - low);
    high += room;
    low -= room;
    const x = time => MARGIN.left + (time - from) / seconds * (width - MARGIN.left - MARGIN.right);
    const y = value => MARGIN.top + (high - value) / (high - low) * (height - MARGIN.top - MARGIN.bottom);
    this.drawAxes({width, height, from, seconds, low, high, x, y});
    for (const name of SPEEDS) {
      this.curves[name].setAttribute('d', this.curve(shown[name], name, from, end, x, y));
    }
  }

  curve(samples, name, from, end, x, y) {
    if (!samples.length) {
      return '';
    }
    const points = samples.map(sample => [Math.max(from, sample[0]), sample[this.index]]);
    const steps = name === 'commanded';     // a command is in force until the next one
    if (steps) {
      points.push([Math.max(end, points[points.length - 1][0]), points[points.length - 1][1]]);
    }
    return points.map(([time, value], index) => {
      const joined = index && (steps || time - samples[index - 1][0] < MISSING);
      return `${joined ? 'L' : 'M'}${x(time).toFixed(1)} ${y(value).toFixed(1)}`;
    }).join('');
  }

  drawAxes({width, height, from, seconds, low, high, x, y}) {
    const texts = [[4, 12, this.title, 'start']], right = width - MARGIN.right, bottom = height - MARGIN.bottom;
    let grid = '';
    const step = roundStep(high - low, 5);
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
      grid += `M${MARGIN.left} ${y(value).toFixed(1)}H${right}`;
      texts.push([MARGIN.left - 5, y(value) + 4, short(value), 'end']);
    }
    const tick = roundStep(seconds, Math.max(3, Math.min(10, width / 80)));
    for (let time = Math.ceil(from / tick) * tick; time <= from + seconds; time += tick) {
      grid += `M${x(time).toFixed(1)} ${MARGIN.top}V${bottom}`;
      texts.push([x(time), height - 5, `${short(time)} s`, x(time) > width - 25 ? 'end' : 'middle']);
    }
    this.grid.setAttribute('d', grid);
    this.axes.setAttribute('d', `M${MARGIN.left} ${y(0).toFixed(1)}H${right}`);
    this.labels.replaceChildren(...texts.map(([tx, ty, text, anchor]) => {
      const made = element('text', {x: tx.toFixed(1), y: ty.toFixed(1), 'text-anchor': anchor});
      made.textContent = text;
      return made;
    }));
  }
}
