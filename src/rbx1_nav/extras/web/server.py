"""The HTTP server, which serves the files of the page and the WebSocket. It runs in a separate thread."""
from __future__ import annotations

import asyncio
import logging
from threading import Event, Thread
import time
from typing import Any, Iterable, Mapping, Protocol, Sequence, cast

from tornado.httpserver import HTTPServer
from tornado.ioloop import PeriodicCallback
from tornado.netutil import bind_sockets
from tornado.web import Application, StaticFileHandler
from tornado.websocket import WebSocketHandler

from rbx1_nav.extras.web.access import accepted_hosts
from rbx1_nav.extras.web.page_messages import MAX_MESSAGE

FRAME_PERIOD, UNSEEN_PERIOD = 50, 100       # ms: with and without a browser
IDLE_TIMEOUT = 5.0      # s in which a request must arrive; s after which an unused connection is closed
PING_PERIOD = 10.0      # s: a browser that does not answer three pings is disconnected
MAX_HEADER = 8192       # bytes
# Reads from a WebSocket; a message takes three or four. The page sends 10 messages/s while a key is held.
READ_RATE = 300.0       # 1/s
READ_BURST = 200.0
READS_AT_ONCE = 20      # of one browser, before the others are served
# load nothing from other hosts; no other page may embed this one, which prevents clickjacking
POLICY = ("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; base-uri 'none'; "
          "form-action 'none'; frame-ancestors 'none'; connect-src 'self'")
HEADERS = {
    'X-Frame-Options': 'DENY',
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Cross-Origin-Resource-Policy': 'same-origin',
    'Cross-Origin-Opener-Policy': 'same-origin',
    'Cache-Control': 'no-cache'}

for logger in 'tornado.access', 'tornado.general':
    logging.getLogger(logger).setLevel(logging.CRITICAL)    # otherwise, any client could fill the log


class PageConnections(Protocol):
    """The browsers at a WebSocket; see Connections and SeatList."""

    @property
    def browsers(self) -> Iterable[WebSocketHandler]: ...

    def opened(self, socket: WebSocketHandler) -> None: ...

    def received(self, socket: WebSocketHandler, text: object) -> None: ...

    def closed(self, socket: WebSocketHandler) -> None: ...

    def flooded(self, socket: WebSocketHandler) -> None: ...


class FileHandler(StaticFileHandler):
    def set_default_headers(self) -> None:
        for name, value in HEADERS.items():
            self.set_header(name, value)
        seats = (f' ws://{self.request.host_name}:{port}' for port in self.settings['seat_ports'])
        self.set_header('Content-Security-Policy', POLICY + ''.join(seats))


class SocketHandler(WebSocketHandler):
    """The WebSocket of a browser."""

    def initialize(self, connections: PageConnections) -> None:
        self.connections = connections

    def check_origin(self, origin: str) -> bool:
        """Return whether the page of this Origin may connect: the one of this server, or the teacher's."""
        teacher = f"http://{self.request.host_name}:{self.settings['teacher_port']}"
        return super().check_origin(origin) or origin == teacher

    def open(self, *_: str, **__: str) -> None:
        self.set_nodelay(True)
        self._limit_reads()
        self.connections.opened(self)

    def _limit_reads(self) -> None:
        """Disconnect a client that sends too fast. tornado reads on as long as there is data, and serves nobody else
        meanwhile. It calls no function of a handler for the parts of a message, so the reads are counted."""
        stream = cast(Any, self.ws_connection).stream
        read, left, last, count = stream.read_bytes, READ_BURST, time.monotonic(), 0

        async def read_bytes(*args: Any, **options: Any) -> Any:
            nonlocal left, last, count
            now, count = time.monotonic(), count + 1
            left, last = min(READ_BURST, left + READ_RATE * (now - last)) - 1, now
            if left < 0 and not stream.closed():
                self.connections.flooded(self)
                stream.close()
            if count % READS_AT_ONCE == 0:
                await asyncio.sleep(0)
            return await read(*args, **options)
        stream.read_bytes = read_bytes

    def on_message(self, message: str | bytes) -> None:
        self.connections.received(self, message)

    def on_close(self) -> None:
        self.connections.closed(self)


class PageServer:
    """Serves the page."""

    def __init__(self, folder: str, connections: Mapping[str, PageConnections], address: str, port: int,
                 page: str = 'index.html', seat_ports: Sequence[int] = (), teacher_port: int = 0) -> None:
        """folder: directory of the page's files; connections: by the path of the socket; address: where the server
        listens; port: 0 for any free port; page: its file; seat_ports: servers on this machine to which the page
        connects; teacher_port: server on this machine whose page may connect, 0: none. Raises OSError."""
        # Any: SeatList sends no frames
        self.connections: set[Any] = set(connections.values())
        self.sockets = bind_sockets(port, address)
        self.port = int(self.sockets[0].getsockname()[1])
        self.application = Application(
            websocket_ping_interval=PING_PERIOD, websocket_max_message_size=MAX_MESSAGE,
            log_function=lambda handler: None, seat_ports=seat_ports, teacher_port=teacher_port)
        self.application.add_handlers(accepted_hosts(address), [
            *((path, SocketHandler, dict(connections=each)) for path, each in connections.items()),
            ('/(.*)', FileHandler, dict(path=folder, default_filename=page))])
        self.loop: asyncio.AbstractEventLoop | None = None
        self.ready = Event()
        self.thread = Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Start the thread, and wait until it accepts connections."""
        self.thread.start()
        self.ready.wait()

    def _run(self) -> None:
        asyncio.run(self._serve())

    async def _serve(self) -> None:
        self.loop, self.end = asyncio.get_running_loop(), asyncio.Event()
        server = HTTPServer(self.application, max_header_size=MAX_HEADER, max_body_size=MAX_HEADER,
                            idle_connection_timeout=IDLE_TIMEOUT, body_timeout=IDLE_TIMEOUT)
        server.add_sockets(self.sockets)
        self.ready.set()
        # unlike a task, it continues after an error
        self.frames = PeriodicCallback(self._send_frames, FRAME_PERIOD)
        if not self.application.settings['seat_ports']:     # otherwise, the page gets its frames from the seats
            self.frames.start()
        await self.end.wait()
        self.frames.stop()
        server.stop()
        for socket in [socket for each in self.connections for socket in each.browsers]:
            socket.close(1001, 'the web view has shut down')
        await asyncio.sleep(0.05)   # until the close frames have been sent

    def _send_frames(self) -> None:
        self.frames.callback_time = FRAME_PERIOD if any(each.browsers for each in self.connections) else UNSEEN_PERIOD
        for each in self.connections:
            each.send_frames()

    def stop(self) -> None:
        """Close the connections and stop the thread; wait for at most 0.5 s."""
        if self.loop:
            self.loop.call_soon_threadsafe(self.end.set)
        self.thread.join(0.5)
