"""The connected browsers: each receives frames as fast as it reads them."""
from __future__ import annotations

from asyncio import Future
from typing import Callable

from tornado.websocket import WebSocketHandler

from rbx1_nav.extras.web.access import Access, without_token
from rbx1_nav.extras.web.controls import Controls
from rbx1_nav.extras.web.page_messages import (
    Hello, InvalidMessage, InviteRequest, StopRequest, encode, kind_of, parse)
from rbx1_nav.extras.web.state import PageState

# Maximum numbers of browsers without the token, in all and from one address, and of those that have not sent hello. A
# browser with the token always has a place.
MAX_WATCHERS, MAX_OF_ADDRESS, MAX_SILENT = 100, 50, 20
FRAME_TIMEOUT = 0.4     # s after which a frame is sent although nothing has changed; see web/connection.js
POLICY, TRY_AGAIN = 1008, 1013      # close codes, RFC 6455 and its registry


class Browser:
    def __init__(self, socket: WebSocketHandler, now: float) -> None:
        """now: s, monotonic clock."""
        self.socket = socket
        self.greeted = self.trusted = False
        self.address = socket.request.remote_ip
        self.sent = now         # s: when the last frame was sent
        self.number, self.epoch = 0, -1     # what this browser has received, see history.py
        self.sending: Future[None] | None = None    # the frame that is being sent

    @property
    def ready(self) -> bool:
        """Whether the last frame has been sent. A browser that does not read is skipped until then."""
        return self.greeted and (self.sending is None or self.sending.done())

    def send(self, message: bytes) -> None:
        try:
            self.sending = self.socket.write_message(message)
            # retrieve the exception: after an error, the connection closes anyway
            self.sending.add_done_callback(lambda future: future.cancelled() or future.exception())
        except Exception:
            pass    # the browser has disconnected; closed() will be called


class Connections:
    """All connected browsers. The methods may only be called from the server thread."""

    def __init__(self, state: PageState, controls: Controls, access: Access, clock: Callable[[], float]) -> None:
        """clock(): returns the monotonic time, s."""
        self.state = state
        self.controls = controls
        self.access = access
        self.clock = clock
        self.browsers: dict[WebSocketHandler, Browser] = {}

    def opened(self, socket: WebSocketHandler) -> None:
        """Add a browser that has connected."""
        self.browsers[socket] = Browser(socket, self.clock())
        silent = [each for each in self.browsers.values() if not each.greeted]
        if len(silent) > MAX_SILENT:
            self._disconnect(silent[0].socket, POLICY, 'expected hello')

    def flooded(self, socket: WebSocketHandler) -> None:
        """Log that a browser is disconnected because it sends too fast."""
        if socket in self.browsers:
            self.controls.log(f'{self.browsers[socket].address} sends too many messages: disconnected')

    def closed(self, socket: WebSocketHandler) -> None:
        """Remove a browser that has disconnected. If its keys were driving the robot, stop the robot."""
        browser = self.browsers.pop(socket, None)
        if browser:
            self.controls.leave(browser)

    def received(self, socket: WebSocketHandler, text: object) -> None:
        """Process a message from a browser."""
        browser = self.browsers.get(socket)
        if browser is None:
            return
        try:
            message = parse(text)
            if browser.greeted == isinstance(message, Hello):
                raise InvalidMessage('expected hello as the first message, and only once')
        except InvalidMessage as error:
            self._disconnect(socket, POLICY, str(error))
            return
        if isinstance(message, Hello):
            self._greet(browser, message)
            return
        if isinstance(message, InviteRequest):
            browser.send(encode('invited', code=self.access.invite()) if browser.trusted else
                         encode('refused', what='invite', reason=without_token(message, False)))
            return
        refused = self.controls.handle(browser, browser.trusted, message)
        if isinstance(message, StopRequest) and not refused:
            browser.send(encode('stopping', number=message.number))
        if refused:
            browser.send(encode('refused', what=kind_of(message), reason=refused))

    def _greet(self, browser: Browser, hello: Hello) -> None:
        token, rejected = self.access.check(hello.token, hello.code)
        browser.greeted, browser.trusted = True, bool(token)
        watchers = [each.address for each in self.browsers.values() if each.greeted and not each.trusted]
        if not browser.trusted and (len(watchers) > MAX_WATCHERS or watchers.count(browser.address) > MAX_OF_ADDRESS):
            self._disconnect(browser.socket, TRY_AGAIN, 'too many pages without the token')
            return
        linear, angular = self.controls.speeds
        browser.send(encode('welcome', trusted=browser.trusted, token=token, rejected=rejected,
                            speeds=[linear, angular]))

    def _disconnect(self, socket: WebSocketHandler, code: int, reason: str) -> None:
        self.closed(socket)
        socket.close(code, reason)

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
        for browser in self.browsers.values():
            if not browser.ready or browser.number == latest and now - browser.sent < FRAME_TIMEOUT:
                continue
            key = browser.number, browser.epoch
            if key not in frames:
                frames[key] = self.state.frame(*key, now)
            browser.number, browser.epoch, message = frames[key]
            browser.send(message)
            browser.sent = now
