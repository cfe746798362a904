// Sends Stop to a robot until it is answered.

import {WORDS} from './words.js';

const ANSWER = 900, STOP_AGAIN = 450;      // ms: time for an answer to Stop; Stop is repeated until it is answered

export class Stop {
  // alarm(text): shows what may still move, until Stop has an answer, or removes it if '' is given; changed(): is called
  // after each answer.
  constructor(connection, alarm, changed) {
    Object.assign(this, {connection, alarm, changed});
    this.number = 0;        // of the last Stop
    this.timer = null;      // repeats Stop until it is answered
    this.answer = '';       // to the last Stop
    connection.addEventListener('stopping', ({detail}) => this.received(detail));
    connection.addEventListener('stopped', ({detail}) => this.answered(detail));
  }

  press() {
    this.end();
    this.answer = WORDS.stopping;
    this.number += 1;
    this.heard = performance.now();
    this.timer = setInterval(() => this.send(), STOP_AGAIN);
    this.send();
  }

  // Ends the last Stop, and forgets its answer. What may still move stays in red until a Stop has an answer.
  end() {
    clearInterval(this.timer);
    this.timer = null;
    this.answer = '';
  }

  send() {
    if (!this.connection.send({type: 'stop', number: this.number})) {
      this.alarm(WORDS.notReached);
    } else if (performance.now() - this.heard >= ANSWER) {
      this.alarm(WORDS.noAnswer);
    }
  }

  // The node has received Stop, and waits until the robot is stationary.
  received({number}) {
    if (this.timer && number === this.number) {
      this.heard = performance.now();
      this.alarm('');
    }
  }

  answered({number, stationary, silent, text}) {
    if (this.timer && number === this.number) {
      this.end();
      this.answer = WORDS.said(text);
      this.alarm(stationary && !silent.length ? '' : this.answer);
      this.changed();
    }
  }
}
