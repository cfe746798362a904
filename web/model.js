// The state that the page draws, assembled from the frames of the node. A frame contains only what has changed.

export const SOURCES = ['truth', 'odometry', 'estimate'];
export const SPEEDS = ['commanded', 'reported', 'true'];
const MAX_POINTS = 6000, MAX_LINES = 50, MAX_EARLIER = 100;
const MOVED = 0.02;         // m: a run that never left its start is not kept

function lists(names) {
  return Object.fromEntries(names.map(name => [name, []]));
}

// Where the robot is, as far as it is known: the true pose, or the odometry.
export function endOf(poses) {
  return poses.truth || poses.odometry;
}

// Who drives the robot, or ''.
export function drivenBy({driver, started, outcome}) {
  return driver || !outcome && started || '';
}

export class Model {
  constructor() {
    this.earlier = [];      // runs of this page that are over, see keep()
    this.forget();
  }

  // Removes everything, because the node sends the whole state again over a new connection.
  forget() {
    this.epoch = -1;
    this.log = [];
    this.status = {before: {}};
    this.poses = {};
    this.time = null;
    this.run = '';
    this.clear();
    this.speeds = lists(SPEEDS);
  }

  clear() {
    this.paths = lists(SOURCES);
    this.cleared = (this.cleared || 0) + 1;     // a counter, so that the floor detects the change
  }

  // Keeps the run that is over: its path, the true one if it is known; floor and seed; and its end pose. before: the end
  // poses that the node has sent, because this page may have been asleep at the end of the run.
  keep(before) {
    const source = this.paths.truth.length ? 'truth' : 'odometry', points = this.paths[source];
    if (points.some(([x, y]) => Math.hypot(x, y) > MOVED)) {
      const number = (this.earlier[this.earlier.length - 1]?.number || 0) + 1;
      const {surface, seed} = this.status, end = endOf(before);
      const run = {number, name: this.run, stopped: this.stopped, source, points, surface, seed, end, shown: true};
      this.earlier = [...this.earlier, run].slice(-MAX_EARLIER);
    }
  }

  add(frame) {
    if (frame.epoch !== this.epoch) {   // a new run
      this.keep(frame.status.before);
      this.epoch = frame.epoch;
      this.stopped = false;
      this.clear();
      this.speeds = lists(SPEEDS);
    }
    this.time = frame.time;
    this.poses = frame.poses;
    this.run = frame.run;
    for (const [source, points] of Object.entries(frame.paths || {})) {
      this.paths[source].push(...points);
      if (this.paths[source].length > MAX_POINTS) {
        this.paths[source].splice(0, MAX_POINTS / 2);
        this.cleared += 1;
      }
    }
    for (const [name, samples] of Object.entries(frame.speeds || {})) {
      const all = this.speeds[name];
      all.push(...samples);
      if (all.length > MAX_POINTS) {
        all.splice(0, MAX_POINTS / 2);
      }
    }
    if (frame.log) {
      this.log = this.log.concat(frame.log).slice(-MAX_LINES);
    }
    if (frame.status) {
      this.status = frame.status;
      const {started, outcome} = frame.status;
      this.stopped = started === this.run ? outcome === 'stopped' : this.stopped;
    }
  }
}
