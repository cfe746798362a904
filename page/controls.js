// What this page has in addition to the page of the web view: how fast a run is shown, many runs, and the script.

import {Connection} from './connection.js';
import {WORDS} from './words.js';

const MANY = 30;
const PACES = [[1, 'in real time'], [5, '5 times as fast'], [20, '20 times as fast'], [1000, 'at once']];
const connection = Connection.instance;

WORDS.script = 'Script';    // the title of its run

function make(kind, properties, ...children) {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...children);
  return made;
}

function select(id, label, options) {
  return make('select', {id, ariaLabel: label}, ...options.map(([value, text]) => new Option(text, value)));
}

// A button that starts runs; it can be used when those of the methods can.
function button(id, text, runs) {
  return make('button', {type: 'button', id, className: 'starts', onclick() {
    if (rbx1.drive.idle) {
      rbx1.drive.begin();
      connection.run(runs());
    }
  }}, text);
}

function allow() {
  document.querySelectorAll('.starts').forEach(each => { each.disabled = !rbx1.drive.idle; });
}

function build() {
  const pace = select('pace', 'Play', PACES);
  pace.onchange = () => { connection.pace = Number(pace.value); };
  const many = select('many-method', 'Method of the runs',
    Object.entries(connection.page.titles).filter(([name]) => name !== 'script'));
  const text = make('textarea', {id: 'text', spellcheck: false, wrap: 'off', ariaLabel: 'Script, which you can edit'});
  text.oninput = () => { connection.text = text.value; };
  const restore = async () => {
    text.value = connection.text = await (await fetch('script.py')).text();
  };
  const cloud = button('many', `${MANY} runs`, () => Array.from({length: MANY}, (_, index) => (
    {method: many.value, seed: connection.chosen.seed + index, atOnce: true})));
  document.getElementById('drive').append(make('p', {className: 'row'}, make('label', {}, 'Play ', pace),
    make('span', {}, cloud, ' ', many)));
  document.querySelector('main').append(make('section', {id: 'script'}, make('h2', {}, WORDS.script), text,
    make('p', {}, button('run-script', 'Run the script', () => [{method: 'script'}]), ' ',
      make('button', {type: 'button', id: 'restore', onclick: restore}, 'Restore'))));
  new MutationObserver(allow).observe(document.querySelector('.run'), {attributes: true});
  allow();
  restore();
}

connection.addEventListener('welcome', build, {once: true});
navigator.serviceWorker?.register('offline.js');
