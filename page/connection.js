// In place of the WebSocket to the node: runs that Python computes in a worker, played as if a robot drove now.

import {Python} from './python.js';
import {WORDS} from './words.js';

export const AT_ONCE = 1000;    // times real time
const PERIOD = 20;          // ms between two frames, about
const LIMIT = 60000;        // ms for the computation of a run; Python itself ends a script that does not sleep for 2 s
const IDLE = 10000;         // ms after which a second worker is loaded: it takes over when the first one is ended
const ERROR = 8;            // level of rosgraph_msgs/Log

export class Connection extends EventTarget {
  // Events: welcome, frame, refused, stopping, stopped, lost, as of the WebSocket. The page has one: `instance`.
  constructor() {
    super();
    Connection.instance = this;
    this.silent = false;
    this.chosen = {surface: 'low_ply_carpet', seed: 7};     // for the next run, by the names of the choices
    this.pace = 1;          // of the display, in times of real time
    this.text = '';         // of the script
    this.epoch = 0;
    this.poses = this.before = {};      // in the last frame, and at the end of the run before
    this.status = {};
    this.time = 0;          // s, of the last frame
    this.turn = 0;          // number of the last action of the user: what an earlier one still does is dropped
    this.request = null;    // of the run that is played
    this.python = new Python();
    this.start();
  }

  async start() {
    try {
      this.page = await this.python.ready;
    } catch (error) {
      this.emit('lost', WORDS.noPython(error.message));
      return;
    }
    Object.assign(this.chosen, this.page.defaults);
    this.emit('welcome', {trusted: true});
    this.begin();
    setTimeout(() => this.prepare(), IDLE);
  }

  emit(type, detail) {
    this.dispatchEvent(new CustomEvent(type, {detail}));
  }

  send(message) {
    if (message.type === 'run') {
      this.run([{method: message.method}]);
    } else if (message.type === 'reset') {
      this.cancel();
      this.begin();
    } else if (message.type === 'stop') {
      this.emit('stopping', message);
      this.stop(message.number);
    } else if (message.type === 'choose') {
      this.choose(message.name, message.value);
    } else if (message.type === 'hand') {
      this.emit('refused', {what: 'hand', reason: WORDS.onlyScripts});
    }
    return true;
  }

  async choose(name, text) {
    try {
      this.chosen[name] = await this.python.choose(name, text);
      this.cancel();
      this.begin();
    } catch (error) {
      this.emit('refused', {what: 'choose', reason: `${name}: ${error.message}`});
    }
  }

  // Ends the last action of the user, and returns the number of this one.
  cancel() {
    clearInterval(this.timer);
    this.request = null;
    return ++this.turn;
  }

  // Puts the robot at its start. request: of the run that begins, if one does.
  begin(request) {
    const {surface, seed} = request || this.chosen, origin = [0, 0, 0];
    this.epoch += 1;
    this.begun = Date.now() / 1000;
    this.before = this.poses;
    this.show({time: 0, run: '', poses: {truth: origin, odometry: origin, estimate: origin}, status: {
      base: 'simulated', simulated: true, simulated_time: true, can_reset: true, driver: '', surface,
      seed: String(seed), started: request ? this.page.titles[request.method] : '', outcome: ''}});
  }

  show(frame) {
    this.poses = frame.poses;
    this.time = frame.time;
    if (frame.status) {
      const {choices, surfaces} = this.page, {distance, speed} = this.chosen;
      this.status = frame.status = {...frame.status, choices, surfaces, distance, speed, before: this.before,
        factor: this.pace === AT_ONCE ? '' : this.pace};
    }
    for (const line of frame.log || []) {
      line[1] += this.begun;      // the log shows the time of day
    }
    this.emit('frame', {...frame, epoch: this.epoch});
  }

  // Shows how the run ended, although Python has not said so. text: for the log, '' for none.
  conclude(outcome, text) {
    this.show({time: this.time, run: this.status.started, poses: this.poses, status: {...this.status, outcome},
      ...text && {log: [[ERROR, this.time, '/page', text]]}});
  }

  // Runs one after another. Of each: method; seed, unless it is the chosen one; whether to show only its end.
  async run(runs) {
    const turn = this.cancel(), {scripts, defaults} = this.page, {chosen, text} = this;
    // a default is not passed on, so that it can be changed in the script
    const parameters = Object.fromEntries(Object.keys(scripts).filter(name => chosen[name] !== defaults[name]).map(
      name => [scripts[name], chosen[name]]));
    for (const {method, seed = chosen.seed, atOnce = false} of runs) {
      const request = {method, surface: chosen.surface, seed, parameters, text, stop: null, as_one_frame: atOnce};
      this.begin(request);
      try {
        const frames = await this.compute(request);
        if (turn === this.turn) {
          this.request = request;
          await this.play(frames, atOnce);
        }
      } catch (error) {
        if (turn === this.turn) {
          this.conclude('failed; see the log', error.message);
        }
        return;
      }
      if (turn !== this.turn) {
        return;
      }
    }
    this.request = null;
    if (runs.length > 1) {
      this.begin();     // the last run joins the others, and the seed is the chosen one again
    }
  }

  async compute(request) {
    const python = this.python, limit = setTimeout(
      () => this.replace(WORDS.tooLong(LIMIT / 1000)), LIMIT);
    this.computing = true;
    try {
      return await python.run(request);
    } finally {
      clearTimeout(limit);
      this.computing = false;
    }
  }

  // Ends the worker that computes, and takes the spare one.
  replace(reason) {
    this.python.end(reason);
    this.python = this.spare || new Python();
    this.prepare();
  }

  prepare() {
    this.spare = new Python();
    this.spare.ready.catch(() => { this.spare = null; });
  }

  // Shows frames when it is their time. Resolves after the last one.
  play(frames, atOnce) {
    const {pace} = this, begun = performance.now(), from = this.time;
    return new Promise(resolve => {
      const step = () => {
        const time = from + (performance.now() - begun) / 1000 * pace;
        while (frames.length && (atOnce || frames[0].time <= time)) {
          this.show(frames.shift());
        }
        if (!frames.length) {
          clearInterval(timer);
          resolve();
        }
      };
      const timer = this.timer = setInterval(step, PERIOD);
      step();
    });
  }

  // The run up to now is computed again, and then stopped: the script sees this as it sees Ctrl-C.
  async stop(number) {
    if (number === this.stopped) {      // repeated until it is answered
      return;
    }
    this.stopped = number;
    const request = this.request, {time} = this, computing = this.computing, turn = this.cancel();
    if (computing) {
      this.replace('stopped');
      this.conclude('stopped', '');
    } else if (request) {
      const frames = await this.compute({...request, stop: time});
      if (turn === this.turn) {
        await this.play(frames.filter(frame => frame.time > time || frame === frames[frames.length - 1]), false);
      }
    }
    this.emit('stopped', {number, stationary: true, silent: [], text: 'The robot is stationary.'});
  }
}
