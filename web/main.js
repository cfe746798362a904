// Connects the parts of the page: frames from the node update the model, and the other parts draw it.

import {Choices} from './choices.js';
import {Connection} from './connection.js';
import {Drive} from './drive.js';
import {Fleet} from './fleet.js';
import {Floor} from './floor.js';
import {LogView} from './log.js';
import {Model, SOURCES} from './model.js';
import {save} from './picture.js';
import {Cursor, Plot} from './plot.js';
import {EarlierRuns, Poses, missed, rowOf, swatch} from './tables.js';
import {connectView} from './view_controls.js';
import {WORDS, fill} from './words.js';

const byId = id => document.getElementById(id);

// Shows a message in place of the last one of this cause (token, stop, refused); without a text, removes it.
function notify(cause, text, alarm = false) {
  let line = byId('notice').querySelector(`[data-cause=${cause}]`);
  if (!text) {
    line?.remove();
    return;
  }
  if (!line) {
    line = document.createElement('p');
    line.dataset.cause = cause;
    byId('notice').append(line);
  }
  line.className = alarm ? 'alarm' : '';
  line.textContent = text;
}

fill();

const model = new Model();
const robot = new URLSearchParams(location.search).get('robot') || '';
const connection = new Connection(robot);
const floor = new Floor(byId('floor'));
const fleet = new Fleet(floor, robot);
const poses = new Poses(byId('tables'));
const earlierRuns = new EarlierRuns(byId('earlier'), () => floor.drawEarlier(model.earlier));
const log = new LogView(byId('lines'));
const drive = new Drive(connection, model, notify);
const choices = new Choices(byId('choices'), connection, () => notify('refused', ''));
const cursor = new Cursor([byId('linear'), byId('angular')], redraw);
const plots = [new Plot(byId('linear'), WORDS.linearAxis, 1, 0.25, cursor),
  new Plot(byId('angular'), WORDS.angularAxis, 2, 1.2, cursor)];
let waiting = false;    // whether a redraw has been requested

function facts() {
  const {status} = model, found = [];
  if (status.base) {
    found.push([WORDS.robot, status.simulated ? WORDS.simulated : WORDS.real]);
  }
  if (status.surface) {
    found.push([WORDS.surface, status.surface]);
  }
  if (status.seed && status.surface !== 'ideal') {
    found.push([WORDS.seed, status.seed]);
  }
  if (status.base) {
    found.push([WORDS.time, status.simulated_time ? WORDS.factor(status.factor) : WORDS.real]);
  }
  return found;
}

function drawFacts() {
  const title = WORDS.said(model.status.title || '');
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
  choices.draw(model.status, drive.idle);
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
  return WORDS.run(name, stopped);
}

// What the exercise is about: how far this method has missed the start.
function drawHeadline() {
  const {run} = model, text = missed(model);
  document.body.classList.toggle('used', Boolean(run || model.earlier.length));
  if (byId('headline').textContent !== text) {
    byId('headline').textContent = text;
  }
}

// The lines of a saved picture: what was run, and the numbers, which are also the legend of the colors.
function caption() {
  const {surface, seed} = model.status;
  const what = [model.run && WORDS.run(model.run),
    surface && surface !== 'ideal' && seed ? WORDS.withSeed(surface, seed) : surface].filter(Boolean).join(', ');
  const shown = model.earlier.filter(run => run.shown);
  const earlier = [...new Set(shown.map(kindOf))].map(kind =>
    ['', WORDS.earlierRuns(kind, shown.filter(run => kindOf(run) === kind).map(run => run.number).join(', '))]);
  const numbers = SOURCES.filter(source => model.poses[source]).map(
    source => [source, WORDS.numbers(WORDS[source], rowOf(model.poses[source]))]);
  return [['', what], ...earlier, ...numbers];
}

function redraw() {
  if (!waiting) {
    waiting = true;
    requestAnimationFrame(draw);
  }
}

function legendItem(name, parent, checkbox) {
  const label = document.createElement(checkbox ? 'label' : 'span');
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
  label.append(swatch(name), ` ${WORDS[name]}`);
  label.title = WORDS.meaning[name] || '';
  parent.append(label);
}

function showConnection() {
  if (drive.connected) {
    byId('connection').className = connection.silent ? 'lost' : 'live';
    byId('connection').textContent = connection.silent ? WORDS.silent : drive.trusted ? WORDS.connected : WORDS.watching;
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
byId('save').onclick = () => save(floor.svg, caption(), model);
byId('window').onchange = redraw;
byId('end').oninput = redraw;
byId('large').onclick = large;
byId('invite').onclick = () => connection.send({type: 'invite'});

connection.addEventListener('welcome', ({detail}) => {
  model.forget();
  drive.trusted = detail.trusted;
  drive.connected = true;
  drive.setHand(false);
  showConnection();
  notify('token', WORDS.rejected[detail.rejected]);
});
connection.addEventListener('frame', ({detail}) => {
  model.add(detail);
  redraw();
});
connection.addEventListener('silent', () => {
  showConnection();
  drive.draw();
});
connection.addEventListener('heard', showConnection);
connection.addEventListener('invited', ({detail}) => notify('refused', WORDS.invited(`${location.origin}/#${detail.code}`)));
connection.addEventListener('refused', ({detail}) => {
  drive.refused(detail);
  redraw();     // a refused choice disappears
});
connection.addEventListener('lost', ({detail}) => {
  drive.connected = false;
  drive.setHand(false);
  redraw();
  byId('connection').className = 'lost';
  byId('connection').textContent = WORDS.lost(detail);
});
window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
// for tests, and for use in the console of the browser
window.rbx1 = {model, floor, drive, caption};
