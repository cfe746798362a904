// The WebSocket to the node: sends hello with the token, and reconnects when the connection is lost.

const SILENCE = 1000;                       // ms: the node sends a frame at least every 400 ms
const DEAD = 2000;                          // ms of silence after which the connection is replaced: it may be dead, as after
                                            // a restart of a router, and the browser would notice this only after minutes
const RETRY = [500, 1000, 2000, 4000];      // ms

// The part of the printed address after #, which a browser does not send to the server: a code, which the node exchanges
// once for the token. The browser keeps the token; the code is removed from the address bar.
function readCode() {
  const code = location.hash.slice(1);
  if (code) {
    history.replaceState(null, '', location.pathname + location.search);
  }
  return code;
}

export class Connection extends EventTarget {
  // Events: welcome, frame, refused, invited, stopping, stopped (detail: the message), lost, silent (no frame for a while), heard.
  // robot: its name in a fleet, '' for the only robot. host, token: of a seat, for the page of the teacher.
  constructor(robot = '', host = location.host, token = '') {
    super();
    Object.assign(this, {host, token});
    this.path = robot ? `/socket/${robot}` : '/socket';
    this.code = token ? '' : readCode();
    this.failures = 0;
    this.heard = 0;         // ms: when the last message arrived
    this.clock = 0;         // s, clock of the node in the last frame: a request carries it, and so its age
    this.silent = false;
    this.timer = setInterval(() => this.checkSilence(), 100);
    // pasting another printed address into an open page changes only the part after #, and does not reload the page
    window.addEventListener('hashchange', () => {
      this.code = readCode();
      if (this.code && !token) {
        this.replace();
      }
    });
    this.connect();
  }

  connect() {
    const protocol = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(`${protocol}://${this.host}${this.path}`);
    this.socket = socket;
    this.begun = performance.now();
    socket.onopen = () => this.send({
      type: 'hello', token: this.token || localStorage.getItem('token') || '', code: this.code});
    socket.onmessage = event => {
      const message = JSON.parse(event.data);
      if (message.type === 'welcome') {
        this.failures = 0;
        this.code = '';
        if (!this.token) {
          localStorage.setItem('token', message.token);
        }
      }
      this.heard = performance.now();
      this.clock = message.clock ?? this.clock;
      if (this.silent) {
        this.checkSilence();
      }
      this.dispatchEvent(new CustomEvent(message.type, {detail: message}));
    };
    socket.onclose = event => {
      this.dispatchEvent(new CustomEvent('lost', {detail: event.reason}));
      this.retry = setTimeout(() => this.connect(), RETRY[Math.min(this.failures++, RETRY.length - 1)]);
    };
  }

  // Abandons the connection without waiting for its end, which may never come.
  abandon() {
    clearTimeout(this.retry);
    this.socket.onopen = this.socket.onmessage = this.socket.onclose = null;
    this.socket.close();
  }

  // Closes the connection until another address is pasted.
  end() {
    clearInterval(this.timer);
    this.abandon();
  }

  replace() {
    this.abandon();
    this.dispatchEvent(new CustomEvent('lost', {detail: ''}));
    this.connect();
  }

  checkSilence() {
    const now = performance.now(), silent = now - this.heard > SILENCE;
    if (now - Math.max(this.heard, this.begun) > DEAD && this.socket.readyState !== WebSocket.CLOSED) {
      this.replace();
    }
    if (silent !== this.silent) {
      this.silent = silent;
      this.dispatchEvent(new CustomEvent(silent ? 'silent' : 'heard'));
    }
  }

  // Sends a message with the clock of the last frame; returns false if there is no connection.
  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      return false;
    }
    this.socket.send(JSON.stringify({clock: this.clock, ...message}));
    return true;
  }
}
