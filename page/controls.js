// What this page has in addition to the page of the web view: how fast a run is shown, many runs, and the script.

import {AT_ONCE, Connection} from './connection.js';
import {WORDS} from './words.js';

const MANY = 30;
const PACES = [1, 5, 20, AT_ONCE];
const connection = Connection.instance;

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
  const pace = select('pace', WORDS.play, PACES.map((pace, index) => [pace, WORDS.paces[index]]));
  pace.onchange = () => { connection.pace = Number(pace.value); };
  const many = select('many-method', WORDS.manyHelp,
    Object.entries(connection.page.titles).filter(([name]) => name !== 'script').map(
      ([name, title]) => [name, WORDS.run(title)]));
  const text = make('textarea', {id: 'text', spellcheck: false, wrap: 'off', ariaLabel: WORDS.scriptHelp});
  // the browser keeps the script when the page is loaded again
  const edit = script => { text.value = connection.text = sessionStorage.script = script; };
  text.oninput = () => edit(text.value);
  const restore = async () => edit(await (await fetch('script.py')).text());
  const cloud = button('many', WORDS.manyRuns(MANY), () => Array.from({length: MANY}, (_, index) => (
    {method: many.value, seed: connection.chosen.seed + index, atOnce: true})));
  document.getElementById('drive').append(make('p', {className: 'row'}, make('label', {}, WORDS.play, ' ', pace),
    make('span', {}, cloud, ' ', many)));
  document.querySelector('main').append(make('section', {id: 'script'}, make('h2', {}, WORDS.script), text,
    make('p', {}, button('run-script', WORDS.runScript, () => [{method: 'script'}]), ' ',
      make('button', {type: 'button', id: 'restore', onclick: restore}, WORDS.restore))));
  new MutationObserver(allow).observe(document.querySelector('.run'), {attributes: true});
  allow();
  if (sessionStorage.script) {
    edit(sessionStorage.script);
  } else {
    restore();
  }
}

connection.addEventListener('welcome', build, {once: true});
navigator.serviceWorker?.register('offline.js');
