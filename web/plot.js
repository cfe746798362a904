// Plots of the commanded, reported and true speed over time, with a cursor.

import {SPEEDS} from './model.js';
import {element, roundStep, short} from './svg.js';
import {fixed} from './tables.js';
import {WORDS} from './words.js';

const MISSING = 2;        // s between two samples without a line; the node sends at least one per second
const MARGIN = {left: 42, right: 8, top: 18, bottom: 20};      // pixels

const LINE = 13;                // pixels between two values
const KEYS = {ArrowLeft: -0.01, ArrowRight: 0.01, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1};

// Where the pointer or the arrow keys are in the plots, as a fraction of their width; null: nowhere.
export class Cursor {
  // changed(): called after each change
  constructor(svgs, changed) {
    this.at = null;
    const move = at => {
      this.at = at === null ? null : Math.max(0, Math.min(1, at));
      changed();
    };
    for (const svg of svgs) {
      for (const name of ['pointerdown', 'pointermove']) {
        svg.addEventListener(name, ({clientX}) => {
          const {left, width} = svg.getBoundingClientRect();
          move((clientX - left - MARGIN.left) / (width - MARGIN.left - MARGIN.right));
        });
      }
      for (const name of ['pointerleave', 'blur']) {
        svg.addEventListener(name, () => move(null));
      }
      svg.addEventListener('keydown', event => {
        // while driving by hand is on, drive.js has handled the arrow keys
        if (KEYS[event.key] && !event.defaultPrevented) {
          event.preventDefault();
          move((this.at ?? 1) + KEYS[event.key]);
        }
      });
    }
  }
}

// The value of a speed at a time, interpolated as it is drawn; null where nothing is drawn.
function valueAt(samples, index, time, steps) {
  const next = samples.findIndex(sample => sample[0] > time), last = samples.at(next < 0 ? -1 : next - 1);
  if (!last || next === 0) {
    return null;
  }
  const after = samples[next] || [Math.max(time, last[0]), ...last.slice(1)];
  if (steps || after[0] === last[0]) {
    return last[index];
  }
  return after[0] - last[0] < MISSING
    ? last[index] + (after[index] - last[index]) * (time - last[0]) / (after[0] - last[0]) : null;
}

export class Plot {
  // index: of the value in a sample, 1: forward speed, 2: turn rate; least: smallest range of the vertical axis.
  constructor(svg, title, index, least, cursor) {
    Object.assign(this, {svg, title, index, least, cursor});
    this.grid = element('path', {class: 'grid'}, svg);
    this.axes = element('path', {class: 'axes'}, svg);
    this.labels = element('g', {}, svg);
    this.curves = Object.fromEntries(['true', 'reported', 'commanded'].map(
      name => [name, element('path', {class: `curve ${name}`}, svg)]));
    this.line = element('path', {class: 'cursor'}, svg);
    this.values = element('g', {}, svg);
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
    this.drawCursor(shown, from, end, seconds, x, height);
  }

  // The line at the time of the cursor, and the values beside it.
  drawCursor(shown, from, end, seconds, x, height) {
    const {at} = this.cursor, time = from + (at ?? 0) * seconds;
    this.line.setAttribute('d', at === null ? '' : `M${x(time).toFixed(1)} ${MARGIN.top}V${height - MARGIN.bottom}`);
    const values = at === null || time > end ? [] : SPEEDS.map(
      name => [name, valueAt(shown[name], this.index, time, name === 'commanded')]).filter(([, value]) => value !== null);
    const texts = at === null ? [] : [['', `${fixed(time, 2)} s`],
      ...values.map(([name, value]) => [name, `${WORDS[name]} ${fixed(value, 3)}`])];
    this.values.replaceChildren(...texts.map(([name, text], index) => {
      const left = at < 0.6, made = element('text', {class: `value ${name}`, x: (x(time) + (left ? 6 : -6)).toFixed(1),
        y: MARGIN.top + LINE * (index + 0.8), 'text-anchor': left ? 'start' : 'end'});
      made.textContent = text;
      return made;
    }));
    this.svg.setAttribute('aria-valuenow', Math.round(100 * (at ?? 1)));
    this.svg.setAttribute('aria-valuetext', texts.map(([, text]) => text).join(', '));
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
