// The table that pose.py prints, for this run, and for the end of the previous run.

import {SOURCES} from './model.js';

const HEAD = ['', 'x (m)', 'y (m)', 'heading (°)', 'from start (m)'];
const NAMES = {truth: 'truth', odometry: 'odometry', estimate: 'estimate'};

// A number with this many decimals, and without the sign of -0.000.
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

export function rowOf(pose) {
  if (!pose) {
    return ['', '', '', ''];
  }
  const [x, y, yaw] = pose;
  const heading = Math.atan2(Math.sin(yaw), Math.cos(yaw)) * 180 / Math.PI;
  return [fixed(x, 3), fixed(y, 3), fixed(heading, 1), fixed(Math.hypot(x, y), 3)];
}

class Table {
  constructor(parent, id) {
    this.table = document.createElement('table');
    this.table.id = id;
    this.caption = this.table.createCaption();
    const head = this.table.createTHead().insertRow();
    for (const text of HEAD) {
      const cell = document.createElement(text ? 'th' : 'td');     // an empty header is read aloud
      cell.textContent = text;
      head.append(cell);
    }
    const body = this.table.createTBody();
    this.rows = Object.fromEntries(SOURCES.map(source => {
      const row = body.insertRow(), name = document.createElement('th');
      name.scope = 'row';
      name.className = source;
      const swatch = document.createElement('span');
      swatch.className = 'swatch';
      name.append(swatch, ` ${NAMES[source]}`);
      row.append(name);
      return [source, [0, 1, 2, 3].map(() => row.insertCell())];
    }));
    parent.append(this.table);
  }

  fill(caption, poses, note) {
    this.caption.textContent = caption;
    for (const source of SOURCES) {
      const texts = rowOf(poses[source]);
      if (!poses[source]) {
        texts[0] = note;
      }
      this.rows[source].forEach((cell, index) => {
        if (cell.textContent !== texts[index]) {
          cell.textContent = texts[index];
        }
      });
    }
  }
}

export class Tables {
  constructor(parent) {
    this.now = new Table(parent, 'table-now');
    this.before = new Table(parent, 'table-before');
  }

  draw(model) {
    this.now.fill(`This run${model.run ? `: ${model.run}` : ''}`, model.poses, '–');
    const before = model.status.before || {};
    this.before.table.hidden = !Object.keys(before).length;
    this.before.fill(`Previous run${model.status.before_name ? `: ${model.status.before_name}` : ''}`, before, '–');
  }
}
