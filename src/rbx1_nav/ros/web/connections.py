"""The connected browsers: each receives frames as fast as it reads them, and its rate of messages is limited."""
from __future__ import annotations

from asyncio import Future
from typing import Callable, Protocol

from rbx1_nav.ros.web.checks import RateLimit, same_token
from rbx1_nav.ros.web.controls import Controls
from rbx1_nav.ros.web.page_messages import Hello, InvalidMessage, StopRequest, encode, kind_of, parse
from rbx1_nav.ros.web.state import PageState

MAX_SOCKETS = 100       # maximum number of browsers
MAX_WATCHERS = 60       # maximum without the token, so that browsers with the token can connect
HELLO_TIMEOUT = 5.0     # s within which a browser must send its first message
FRAME_TIMEOUT = 0.4     # s after which a frame is sent although nothing has changed; see web/connection.js
RATE, BURST = 30, 60    # messages per second, and in a burst; held keys are sent 10 times per second
TRY_AGAIN_LATER, POLICY = 1013, 1008    # close codes: RFC 6455 and the IANA registry


class Socket(Protocol):
    """The part of tornado's WebSocketHandler that is used here."""

    def write_message(self, message: bytes, binary: bool = False) -> Future[None]:
        """Send a message. Raises an exception if the socket is closed."""

    def close(self, code: int | None = None, reason: str | None = None) -> None:
        """Close the socket."""


class Browser:
    """A connected browser."""

    def __init__(self, socket: Socket, now: float) -> None:
        """now: s, monotonic clock."""
        self.socket = socket
        self.since = now
        self.greeted = self.trusted = False
        self.limit = RateLimit(RATE, BURST)
        self.address = getattr(getattr(socket, 'request', None), 'remote_ip', 'an unknown address')
        self.sent = now         # s: when the last frame was sent
        self.number, self.epoch = 0, -1     # what this browser has received, see history.py
        self.sending: Future[None] | None = None    # the frame that is being sent

    @property
    def ready(self) -> bool:
        """Whether the last frame has been sent. A browser that does not read is skipped until then."""
        return self.greeted and (self.sending is None or self.sending.done())

    def send(self, message: bytes) -> None:
        """Send a message."""
        try:
            self.sending = self.socket.write_message(message)
            # retrieve the exception: after an error, the connection closes anyway
            self.sending.add_done_callback(lambda future: future.cancelled() or future.exception())
        except Exception:
            pass    # the browser has disconnected; closed() will be called


class Connections:
    """All connected browsers. The methods may only be called from the server thread."""

    def __init__(self, state: PageState, controls: Controls, token: str, clock: Callable[[], float]) -> None:
        """clock(): returns the monotonic time, s."""
        self.state = state
        self.controls = controls
        self.token = token
        self.clock = clock
        self.browsers: dict[Socket, Browser] = {}

    @property
    def full(self) -> bool:
        """Whether no further browser may connect."""
        return sum(each.greeted for each in self.browsers.values()) >= MAX_SOCKETS

    def opened(self, socket: Socket) -> None:
        """Add a browser that has connected. If all places are taken, it replaces the one that has waited longest
        without sending hello."""
        if len(self.browsers) >= MAX_SOCKETS:
            silent = next((each for each in self.browsers.values() if not each.greeted), None)
            if silent:
                self._close(silent, POLICY, 'expected hello')
        self.browsers[socket] = Browser(socket, self.clock())

    def closed(self, socket: Socket) -> None:
        """Remove a browser that has disconnected. If its keys were driving the robot, stop the robot."""
        browser = self.browsers.pop(socket, None)
        if browser:
            self.controls.leave(browser)

    def received(self, socket: Socket, text: object) -> None:
        """Process a message from a browser."""
        browser = self.browsers.get(socket)
        if browser is None:
            return
        try:
            if not browser.limit.allows(self.clock()):
                raise InvalidMessage('too many messages')
            message = parse(text)
            if browser.greeted == isinstance(message, Hello):
                raise InvalidMessage('expected hello as the first message, and only once')
        except InvalidMessage as error:
            self._close(browser, POLICY, str(error))
            return
        if isinstance(message, Hello):
            self._greet(browser, message)
            return
        refused = self.controls.handle(browser, browser.trusted, message)
        if isinstance(message, StopRequest) and not refused:
            browser.send(encode('stopping', number=message.number))
        if refused:
            browser.send(encode('refused', what=kind_of(message), reason=refused))

    def _greet(self, browser: Browser, hello: Hello) -> None:
        browser.trusted = same_token(self.token, hello.token)
        watchers = sum(each.greeted and not each.trusted for each in self.browsers.values())
        if not browser.trusted and watchers >= MAX_WATCHERS:
            self._close(browser, TRY_AGAIN_LATER, 'too many browsers')
            return
        browser.greeted = True
        linear, angular = self.controls.speeds
        browser.send(encode('welcome', trusted=browser.trusted, known_token=browser.trusted or not hello.token,
                            speeds=[linear, angular]))

    def _close(self, browser: Browser, code: int, reason: str) -> None:
        self.closed(browser.socket)
        browser.socket.close(code, reason)

    def send_frames(self) -> None:
        """Send a frame to each browser that is ready. To be called periodically."""
        now = self.clock()
        self.state.tick(now)
        for browser, answer in self.controls.answers().items():
            if self.browsers.get(browser.socket) is browser:
                browser.send(encode('stopped', **answer._asdict()))
        # most browsers have received the same frames, so they need the same next frame
        frames: dict[tuple[int, int], tuple[int, int, bytes]] = {}
        latest = self.state.counter.last
        for browser in list(self.browsers.values()):
            if not browser.greeted and now - browser.since > HELLO_TIMEOUT:
                self._close(browser, POLICY, 'expected hello')
            if not browser.ready or browser.number == latest and now - browser.sent < FRAME_TIMEOUT:
                continue
            key = browser.number, browser.epoch
            if key not in frames:
                frames[key] = self.state.frame(*key, now)
            browser.number, browser.epoch, message = frames[key]
            browser.send(message)
            browser.sent = now
