// The table that pose.py prints, and the list of earlier runs.

import {SOURCES, endOf} from './model.js';
import {WORDS} from './words.js';

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

// The method of the run and, when it has finished, by how much it has missed the start.
export function missed({status, run, poses}) {
  const end = endOf(poses);
  return !run || status.started !== run ? '' : !end || status.outcome !== 'finished' ? WORDS.method(run) : WORDS.outcome(
    WORDS.method(run), WORDS.missed(fixed(Math.hypot(end[0], end[1]), 2), fixed(Math.abs(Number(rowOf(end)[2])), 0),
      'truth' in poses));
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

// A short line in the color and the line style of a path or a curve.
export function swatch(name) {
  const made = document.createElement('span');
  made.className = `swatch ${name}`;
  return made;
}

export class Poses {
  constructor(parent) {
    const table = makeTable(parent, 'table-now', WORDS.poseHead), body = table.createTBody();
    this.caption = table.createCaption();
    this.rows = Object.fromEntries(SOURCES.map(source => {
      const row = body.insertRow(), name = document.createElement('th');
      name.scope = 'row';
      name.append(swatch(source), ` ${WORDS[source]}`);
      row.append(name);
      return [source, [0, 1, 2, 3].map(() => row.insertCell())];
    }));
  }

  draw({run, poses}) {
    this.caption.textContent = WORDS.thisRun(run);
    for (const source of SOURCES) {
      const texts = rowOf(poses[source]);
      if (!poses[source]) {
        texts[0] = WORDS.none;
      }
      this.rows[source].forEach((cell, index) => {
        if (cell.textContent !== texts[index]) {
          cell.textContent = texts[index];
        }
      });
    }
  }
}

// For each method and surface with more than one complete run: [name, number of runs, surface, mean distance from the start
// (m), mean size of the heading (degrees)].
function meansOf(runs) {
  const groups = new Map();
  for (const {name, surface, end} of runs.filter(run => run.end && !run.stopped)) {
    const key = JSON.stringify([name, surface]);
    groups.set(key, [...groups.get(key) || [], rowOf(end)]);
  }
  const mean = (rows, index) => rows.reduce((sum, row) => sum + Math.abs(row[index]), 0) / rows.length;
  return [...groups].filter(([, rows]) => rows.length > 1).map(([key, rows]) => {
    const [name, surface] = JSON.parse(key);
    return [name, rows.length, surface, mean(rows, 3), mean(rows, 2)];
  });
}

// A row of the list of runs: its first cell, its header, and the texts of the further cells. name: of the run, for its color.
function makeRow(name, first, title, texts, kind = '') {
  const row = document.createElement('tr'), header = document.createElement('th');
  row.dataset.run = name;
  row.className = kind;
  row.insertCell().append(first);
  header.scope = 'row';
  header.textContent = title;
  row.append(header);
  for (const text of texts) {
    row.insertCell().textContent = text;
  }
  return row;
}

// The earlier runs, each with a check box, and where it ended.
export class EarlierRuns {
  // changed(): called when a run is shown or hidden
  constructor(parent, changed) {
    Object.assign(this, {parent, changed});
    this.body = makeTable(parent, 'runs', WORDS.runHead).createTBody();
  }

  draw(runs) {
    if (runs === this.drawn) {
      return;
    }
    this.drawn = runs;
    this.parent.hidden = !runs.length;
    const means = meansOf(runs).map(([name, number, surface, distance, angle]) => makeRow(
      name, swatch(''), WORDS.mean(WORDS.run(name), number), [surface, fixed(distance, 3), fixed(angle, 1)], 'mean'));
    this.body.replaceChildren(...means, ...runs.map(run => {
      const box = document.createElement('input'), label = document.createElement('label');
      const [, , heading, distance] = rowOf(run.end);
      box.type = 'checkbox';
      box.checked = run.shown;
      box.ariaLabel = WORDS.showRun(run.number);
      box.onchange = () => {
        run.shown = box.checked;
        this.changed();
      };
      label.append(box, swatch(''));
      const floor = run.surface && run.surface !== 'ideal' ? WORDS.withSeed(run.surface, run.seed) : run.surface || '';
      return makeRow(run.name, label, `${run.number} ${WORDS.run(run.name, run.stopped)}`, [floor, distance, heading]);
    }));
  }
}
