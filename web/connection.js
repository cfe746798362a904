// The WebSocket to the view's node: says hello with the token, and connects again when the connection is lost.

const RETRY = [500, 1000, 2000, 4000];      // ms

// The token stands behind the # of the printed address, which a browser sends to nobody. It is kept for this tab, and
// removed from the address bar: a projector should not show it.
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
    // an address that is pasted into an open page changes nothing but what is behind the #
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

  // Returns whether the message could be sent.
  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) {
      return false;
    }
    this.socket.send(JSON.stringify(message));
    return true;
  }
}
