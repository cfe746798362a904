// The page of the teacher: all seats of seats.py, each over a connection of its own, and Stop for one or for all of them.

import {Connection} from './connection.js';
import {Floor} from './floor.js';
import {Model, drivenBy} from './model.js';
import {Stop} from './stop.js';
import {missed} from './tables.js';
import {WORDS, fill} from './words.js';

const PERIOD = 250;         // ms between two drawings of all seats
const WIDE = 1.2;           // times as many columns as rows, about

const byId = id => document.getElementById(id);

// Shows a message for the teacher; '' removes it.
function notify(text) {
  const line = document.createElement('p');
  line.textContent = text;
  byId('notice').replaceChildren(...text ? [line] : []);
}

class Seat {
  constructor({number, port, token}) {
    const host = `${location.hostname}:${port}`, name = WORDS.seat(number);
    this.model = new Model();
    this.connected = false;
    this.section = byId('seat').content.firstElementChild.cloneNode(true);
    byId('seats').append(this.section);
    const [link, button, invite, svg] = ['a', '.stop', '.invite', 'svg'].map(each => this.section.querySelector(each));
    [this.state, this.answer] = this.section.querySelectorAll('p');
    this.section.ariaLabel = link.textContent = name;
    link.href = `${location.protocol}//${host}/`;
    button.textContent = WORDS.stop;
    button.ariaLabel = WORDS.stopOne(name);
    invite.title = invite.ariaLabel = `${name}: ${WORDS.inviteHelp}`;
    invite.onclick = () => this.connection.send({type: 'invite'});
    svg.ariaLabel = WORDS.floorOf(name);
    this.floor = new Floor(svg);
    this.connection = new Connection('', host, token);
    this.stop = new Stop(this.connection, text => this.alarm(text), () => this.changed());
    button.onclick = () => this.press();
    for (const [event, react] of Object.entries({
      welcome: ({trusted}) => {
        this.model.forget();
        this.connected = true;
        notify(trusted ? '' : WORDS.teacherAddress);
      },
      frame: frame => this.model.add(frame),
      invited: ({code}) => notify(`${name}: ${WORDS.invited(`${link.href}#${code}`)}`),
      refused: ({reason}) => {
        this.stop.end();
        this.alarm(WORDS.refused(WORDS.said(reason)));
      },
      lost: () => { this.connected = false; },
      silent: () => {}, heard: () => {}})) {
      this.connection.addEventListener(event, ({detail}) => {
        react(detail);
        this.changed();
      });
    }
    this.changed();
  }

  press() {
    this.stop.press();
    this.changed();
  }

  // Shows in red what may still move; '' removes it.
  alarm(text) {
    this.alarmed = text;
    this.changed();
  }

  changed() {
    this.outdated = true;
  }

  draw() {
    if (!this.outdated) {
      return;
    }
    this.outdated = false;
    const {model, connected, connection} = this, [, ...commanded] = model.speeds.commanded.at(-1) || [];
    const driver = drivenBy(model.status) || commanded.some(Boolean) && model.run;
    if (driver && !this.driver && !this.stop.timer) {       // the answer is about an earlier run
      this.stop.answer = '';
    }
    this.driver = driver;
    const state = !connected ? WORDS.lost('') : connection.silent ? WORDS.silent : driver ? WORDS.driving(driver)
      : missed(model) || WORDS.idle;
    this.section.classList.toggle('lost', !connected || connection.silent);
    this.section.classList.toggle('driving', Boolean(driver));
    this.answer.classList.toggle('alarm', Boolean(this.alarmed));
    for (const [line, text] of [[this.state, state], [this.answer, this.alarmed || this.stop.answer]]) {
      if (line.textContent !== text) {
        line.textContent = text;
      }
    }
    this.floor.draw(model);
  }
}

let seats = [];

function stopAll() {
  seats.forEach(seat => seat.press());
}

function draw() {
  seats.forEach(seat => seat.draw());
  const number = seats.filter(({connected}) => connected).length, text = WORDS.seatsConnected(number, seats.length);
  if (seats.length && byId('connection').textContent !== text) {
    byId('connection').textContent = text;
    byId('connection').className = number === seats.length ? 'live' : 'lost';
  }
}

fill();
document.title = WORDS.seats;
byId('stop').onclick = stopAll;
window.addEventListener('keydown', event => event.key === 'Escape' && stopAll(), {capture: true});
setInterval(draw, PERIOD);

const list = new Connection();
list.addEventListener('welcome', ({detail}) => {
  list.end();
  if (seats.length) {         // another address was pasted: its token is stored
    location.reload();
    return;
  }
  notify(detail.token ? '' : WORDS.teacherAddress);
  byId('connection').textContent = '';
  byId('seats').style.setProperty('--columns', Math.ceil(Math.sqrt(WIDE * detail.seats.length)));
  seats = detail.seats.map(each => new Seat(each));
});
list.addEventListener('lost', () => { byId('connection').textContent = WORDS.lost(''); });
// for tests, and for use in the console of the browser
window.rbx1 = {seats: () => seats};
