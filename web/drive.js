// Controls that move the robot (runs, reset, arrow keys), and Stop.

import {drivenBy} from './model.js';
import {Stop} from './stop.js';
import {WORDS} from './words.js';

const HELD = 300;       // ms: after a longer pause, as of a frozen browser, a key must be pressed again
const REPEAT = 100;     // ms: the node stops the robot if held keys are not repeated within 300 ms
const KEYS = {ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, 1], ArrowRight: [0, -1]};    // forward, left

export class Drive {
  // notify(cause, text, alarm): shows a message to the user, in red if alarm is true, in place of the last one of this
  // cause; '' removes it.
  constructor(connection, model, notify) {
    Object.assign(this, {connection, model, notify});
    this.trusted = false;
    this.connected = false;
    this.stopping = new Stop(connection, text => notify('stop', text, true), () => this.answered());
    this.hand = false;
    this.pressed = true;    // whether Stop was pressed here since the last run began; before the first one, this is not known
    this.held = new Set();
    this.timer = null;
    this.stop = document.getElementById('stop');
    this.toggle = document.getElementById('hand');
    this.pad = [...document.querySelectorAll('.pad button')];
    this.runs = [...document.querySelectorAll('.run')];
    this.dialog = document.getElementById('confirm');

    this.stop.onclick = () => this.stopRobot();
    // capture: before any other handler of this key
    window.addEventListener('keydown', event => event.key === 'Escape' && this.stopRobot(), {capture: true});
    for (const run of this.runs) {
      run.textContent = WORDS.method(run.dataset.name);
      run.onclick = () => this.startRun(run);
    }
    document.getElementById('reset').onclick = () => {
      this.begin();
      this.setHand(false);
      connection.send({type: 'reset'});
    };
    this.toggle.onclick = () => this.switchHand(!this.hand);
    this.connectKeys();
  }

  connectKeys() {
    document.addEventListener('keydown', event => {
      if (this.hand && KEYS[event.key] && !event.ctrlKey && !event.altKey && !event.metaKey &&
          !event.target.closest('dialog')) {
        event.preventDefault();
        if (!event.repeat) {    // a key that has been released here, for example by Stop, must be pressed again
          this.hold(event.key);
        }
      }
    }, {capture: true});
    document.addEventListener('keyup', event => this.release(event.key));
    for (const button of this.pad) {
      button.addEventListener('pointerdown', event => {
        button.setPointerCapture(event.pointerId);
        this.hold(button.dataset.key);
      });
      for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) {
        button.addEventListener(name, () => this.release(button.dataset.key));
      }
      button.addEventListener('keydown', event => {
        if (event.key === ' ' || event.key === 'Enter') {
          event.preventDefault();
          if (!event.repeat) {
            this.hold(button.dataset.key);
          }
        }
      });
      for (const name of ['keyup', 'blur']) {
        button.addEventListener(name, () => this.release(button.dataset.key));
      }
      button.addEventListener('contextmenu', event => event.preventDefault());
    }
    // the page does not receive the release of a key while another window or tab has the focus
    window.addEventListener('blur', () => this.releaseAll());
    document.addEventListener('visibilitychange', () => document.hidden && this.releaseAll());
    window.addEventListener('pagehide', () => this.releaseAll());
  }

  hold(key) {
    if (this.hand && !this.held.has(key)) {
      this.repeated = this.held.size ? this.repeated : performance.now();
      this.held.add(key);
      this.sendKeys();
      this.timer = this.timer || setInterval(() => this.sendKeys(), REPEAT);
    }
  }

  release(key) {
    if (this.held.delete(key)) {
      this.sendKeys();
    }
  }

  releaseAll() {
    if (this.held.size) {
      this.held.clear();
      this.sendKeys();
    }
  }

  sendKeys() {
    const now = performance.now();
    if (now - this.repeated > HELD || this.connection.silent) {
      this.held.clear();
    }
    this.repeated = now;
    let forward = 0, left = 0;
    for (const key of this.held) {
      forward += KEYS[key][0];
      left += KEYS[key][1];
    }
    if (!this.connection.send({type: 'drive', forward, left})) {
      this.held.clear();
    }
    this.showHeld();
  }

  // Highlights the held keys; without any, nothing is repeated.
  showHeld() {
    if (!this.held.size) {
      clearInterval(this.timer);
      this.timer = null;
    }
    for (const button of this.pad) {
      button.classList.toggle('held', this.held.has(button.dataset.key));
    }
  }

  stopRobot() {
    this.held.clear();
    this.showHeld();
    this.setHand(false);
    if (this.dialog.open) {
      this.dialog.close('cancel');
    }
    this.begin();
    this.pressed = true;
    this.stopping.press();
  }

  answered() {
    this.notify('refused', '');
    this.draw();
  }

  // Ends the previous action, and removes its messages.
  begin() {
    this.stopping.end();
    this.notify('refused', '');
  }

  // Asks the user whether a real robot may move. Resolves to true if so, or if the robot is simulated.
  async confirm(text) {
    if (this.model.status.simulated) {
      return true;
    }
    document.getElementById('confirm-text').textContent = text;
    this.dialog.returnValue = 'cancel';
    this.dialog.showModal();
    await new Promise(resolve => this.dialog.addEventListener('close', resolve, {once: true}));
    return this.dialog.returnValue === 'move';
  }

  async startRun(button) {
    if (await this.confirm(WORDS.confirmRun)) {
      this.begin();
      this.setHand(false);
      const reset = Boolean(this.model.status.can_reset && document.getElementById('reset-first').checked);
      this.connection.send({type: 'run', method: button.dataset.method, reset, confirmed: !this.model.status.simulated});
    }
  }

  async switchHand(on) {
    if (on && !await this.confirm(WORDS.confirmHand)) {
      return;
    }
    this.begin();
    this.connection.send({type: 'hand', on, confirmed: !this.model.status.simulated});
    this.setHand(on);
  }

  setHand(on) {
    this.hand = on;
    if (!on) {
      this.releaseAll();
    }
    this.toggle.setAttribute('aria-pressed', on);
    this.pad.forEach(button => { button.disabled = !on; });
  }

  refused(message) {
    if (message.what === 'stop') {
      this.begin();
    }
    if (message.what === 'hand') {
      this.setHand(false);
    }
    if (message.what === 'drive') {     // report this only once, although held keys are repeated
      this.setHand(false);
    }
    this.notify('refused', WORDS.refused(WORDS.said(message.reason)));
  }

  // Enables the buttons that can be used now, and shows what is running.
  draw() {
    const {status} = this.model, {answer, timer} = this.stopping, driver = drivenBy(status), running = Boolean(driver);
    const ready = this.connected && !this.connection.silent && this.trusted && !status.master && Boolean(status.base) &&
      'odometry' in this.model.poses;
    if (running && !this.running) {
      this.pressed = false;
    }
    this.running = running;
    if (running && this.hand) {     // another browser has started a run
      this.setHand(false);
    }
    const unfiltered = this.runs.filter(run => run.dataset.pose === 'estimate' && !('estimate' in this.model.poses));
    for (const run of this.runs) {
      if (running && run === document.activeElement) {
        this.stop.focus();      // a button that is disabled loses the focus
      }
      run.disabled = !ready || running || unfiltered.includes(run);
    }
    document.getElementById('reset').disabled = !ready || running || !status.can_reset;
    document.getElementById('reset-first').disabled = !status.can_reset;
    this.idle = ready && !running;      // whether a run could be started
    this.toggle.disabled = !this.idle;
    document.getElementById('invite').disabled = !this.connected || !this.trusted;
    const answered = answer && this.connected && !running && !this.hand && !status.master;
    const text = timer || answered ? answer : !this.connected ? '' : status.master === 'silent' ? WORDS.masterSilent
      : status.master === 'restarted' ? WORDS.masterRestarted
      : !status.base ? WORDS.noBase
      : !this.trusted ? WORDS.noToken
      : running ? WORDS.running(driver)
      : this.hand ? WORDS.keysDrive
      : !status.started ? ''
      : WORDS.outcome(WORDS.method(status.started),
        status.outcome === 'stopped' && !this.pressed ? WORDS.stoppedElsewhere : WORDS.said(status.outcome));
    const why = !ready || running ? [] : [
      ...unfiltered.map(run => WORDS.needsFilter(run.textContent)),
      !status.can_reset && WORDS.noReset];
    for (const [id, shown] of Object.entries({'run-state': text, why: why.filter(Boolean).join(' ')})) {
      const line = document.getElementById(id);
      if (line.textContent !== shown) {
        line.textContent = shown;
      }
    }
  }
}
