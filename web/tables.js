// The table that pose.py prints, and the list of earlier runs.

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

// Makes a table with these headers.
function makeTable(parent, id, headers) {
  const table = document.createElement('table'), head = table.createTHead().insertRow();
  table.id = id;
  for (const text of headers) {
    const cell = document.createElement(text ? 'th' : 'td');     // an empty header is read aloud
    cell.textContent = text;
    head.append(cell);
  }
  parent.append(table);
  return table;
}

function swatch() {
  const made = document.createElement('span');
  made.className = 'swatch';
  return made;
}

export class Poses {
  constructor(parent) {
    const table = makeTable(parent, 'table-now', HEAD), body = table.createTBody();
    this.caption = table.createCaption();
    this.rows = Object.fromEntries(SOURCES.map(source => {
      const row = body.insertRow(), name = document.createElement('th');
      name.scope = 'row';
      name.className = source;
      name.append(swatch(), ` ${NAMES[source]}`);
      row.append(name);
      return [source, [0, 1, 2, 3].map(() => row.insertCell())];
    }));
  }

  draw({run, poses}) {
    this.caption.textContent = `This run${run ? `: ${run}` : ''}`;
    for (const source of SOURCES) {
      const texts = rowOf(poses[source]);
      if (!poses[source]) {
        texts[0] = '–';
      }
      this.rows[source].forEach((cell, index) => {
        if (cell.textContent !== texts[index]) {
          cell.textContent = texts[index];
        }
      });
    }
  }
}

// The earlier runs, each with a check box, and where it ended.
export class EarlierRuns {
  // changed(): called when a run is shown or hidden
  constructor(parent, changed) {
    Object.assign(this, {parent, changed});
    this.body = makeTable(parent, 'runs', ['', 'run', 'floor', 'from start (m)', 'heading (°)']).createTBody();
  }

  draw(runs) {
    if (runs === this.drawn) {
      return;
    }
    this.drawn = runs;
    this.parent.hidden = !runs.length;
    this.body.replaceChildren(...runs.map(run => {
      const row = document.createElement('tr'), box = document.createElement('input'), label = document.createElement('label');
      const [, , heading, distance] = rowOf(run.end), name = document.createElement('th');
      row.dataset.run = run.name;
      box.type = 'checkbox';
      box.checked = run.shown;
      box.ariaLabel = `Show run ${run.number}`;
      box.onchange = () => {
        run.shown = box.checked;
        this.changed();
      };
      label.append(box, swatch());
      row.insertCell().append(label);
      name.scope = 'row';
      name.textContent = `${run.number} ${run.name}${run.stopped ? ', stopped' : ''}`;
      row.append(name);
      const floor = run.surface && run.surface !== 'ideal' ? `${run.surface}, seed ${run.seed}` : run.surface || '';
      for (const text of [floor, distance, heading]) {
        row.insertCell().textContent = text;
      }
      return row;
    }));
  }
}
