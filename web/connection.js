// The WebSocket to the node: sends hello with the token, and reconnects when the connection is lost.

const RETRY = [500, 1000, 2000, 4000];      // ms

// The token is the part of the printed address after #, which a browser does not send to the server. It is stored for
// this tab, and removed from the address bar, so that nobody can read it on a projector.
function readToken() {
  const given = location.hash.slice(1);
  if (given) {
    sessionStorage.setItem('token', given);
    history.replaceState(null, '', location.pathname);
  }
  return sessionStorage.getItem('token') || '';
}

export class Connection extends EventTarget {
  // Events: welcome, frame, refused (detail: the message), lost.
  constructor() {
    super();
    this.token = readToken();
    this.failures = 0;
    // pasting another printed address into an open page changes only the part after #, and does not reload the page
    window.addEventListener('hashchange', () => {
      this.token = readToken();
      this.socket.close();
    });
    this.connect();
  }

  connect() {
    const protocol = location.protocol === 'https:' ? 'wss' : 'ws';
    this.socket = new WebSocket(`${protocol}://${location.host}/socket`);
    this.socket.onopen = () => this.send({type: 'hello', token: this.token});
    this.socket.onmessage = event => {
      const message = JSON.parse(event.data);
      if (message.type === 'welcome') {
        this.failures = 0;
      }
      this.dispatchEvent(new CustomEvent(message.type, {detail: message}));
    };
    this.socket.onclose = event => {
      this.dispatchEvent(new CustomEvent('lost', {detail: event.reason}));
      setTimeout(() => this.connect(), RETRY[Math.min(this.failures++, RETRY.length - 1)]);
    };
  }

  // Sends a message; returns false if there is no connection.
  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      return false;
    }
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
