// What this page has in addition to the page of the web view: floor, seed, speeds, many runs, and the script.

import {Connection} from './connection.js';

const MANY = 30;
const connection = Connection.instance, {settings} = connection;

function make(kind, properties = {}, ...children) {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...children);
  return made;
}

// A labeled field that changes the settings.
function field(text, element, change) {
  element.oninput = () => element.checkValidity() && change(element.value);
  change(element.value);
  return make('label', {}, text, element);
}

function number(name, text, value, min, max, step) {
  return field(text, make('input', {type: 'number', id: name, value, min, max, step, required: true}), found => {
    settings.parameters[name] = Number(found);
  });
}

function select(id, options, value) {
  const made = make('select', {id}, ...options.map(([each, text]) => make('option', {value: each}, text)));
  made.value = value;
  return made;
}

function idle() {
  return !document.querySelector('.run').disabled;
}

function button(id, text, action) {
  const properties = {type: 'button', id, className: 'local', disabled: true, onclick: () => idle() && action()};
  return make('button', properties, text);
}

const script = make('textarea', {id: 'text', spellcheck: false, autocapitalize: 'off', wrap: 'off'});
script.setAttribute('aria-label', 'The script, which you can edit');
script.oninput = () => { settings.text = script.value; };

async function restore() {
  script.value = settings.text = await (await fetch('script.py')).text();
}

function build(surfaces) {
  const seed = make('input', {type: 'number', id: 'seed', value: settings.seed, min: 0, max: 2 ** 31 - MANY,
    required: true});
  const methods = Object.entries(connection.titles).filter(([name]) => name !== 'script');
  const many = select('many-method', methods, 'timed');
  const setup = make('div', {id: 'setup'},
    make('p', {className: 'fields'},
      field('Surface ', select('surface', surfaces.map(name => [name, name]), 'low_ply_carpet'),
        value => { settings.surface = value; }),
      field('Seed ', seed, value => { settings.seed = Number(value); }),
      number('linear_speed', 'Speed (m/s) ', 0.2, 0.05, 0.5, 0.01),
      number('goal_distance', 'Distance (m) ', 1, 0.1, 5, 0.1),
      field('Play ', select('pace', [[1, 'in real time'], [5, '5 times as fast'], [20, '20 times as fast'],
        [1000, 'at once']], 1),
      value => { settings.pace = Number(value); })),
    make('p', {className: 'fields'},
      button('many', `${MANY} runs`, () => connection.run(Array.from({length: MANY},
        (_, index) => ({method: many.value, seed: settings.seed + index, atOnce: true})))), many));
  const lesson = make('section', {id: 'script'}, make('h2', {}, 'Script'), script,
    make('p', {className: 'fields'},
      button('run-script', 'Run the script', () => connection.run([{method: 'script'}])),
      make('button', {type: 'button', id: 'restore', onclick: restore}, 'Restore')));
  document.getElementById('drive').append(setup);
  document.querySelector('main').append(lesson);
  connection.begin();
}

// The buttons of this page can be used when those of the methods can.
new MutationObserver(() => document.querySelectorAll('.local').forEach(each => { each.disabled = !idle(); }))
  .observe(document.querySelector('.run'), {attributes: true, attributeFilter: ['disabled']});

connection.addEventListener('welcome', () => {
  if (!document.getElementById('setup')) {
    build(connection.surfaces);
    restore();
  }
});
if ('serviceWorker' in navigator) {
  navigator.serviceWorker.register('offline.js');
}
