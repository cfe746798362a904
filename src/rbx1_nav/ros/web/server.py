"""The HTTP server, which serves the files of the page and the WebSocket. It runs in a separate thread."""
from __future__ import annotations

import asyncio
import logging
import os
from threading import Event, Thread
from typing import Any, Mapping

from tornado.httpserver import HTTPServer
from tornado.ioloop import PeriodicCallback
from tornado.iostream import IOStream
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketHandler

from rbx1_nav.ros.web.checks import HostCheck
from rbx1_nav.ros.web.connections import Connections
from rbx1_nav.ros.web.page_messages import MAX_MESSAGE

FRAME_PERIOD = 50       # ms
MAX_CONNECTIONS = 160   # TCP connections that are not WebSockets yet, including idle ones
IDLE_TIMEOUT = 5.0      # s in which a request must arrive; s after which an unused connection is closed
PING_PERIOD = 10.0      # s: a browser that does not answer three pings is disconnected
MAX_HEADER = 8192       # bytes
TYPES = {'.html': 'text/html; charset=utf-8', '.css': 'text/css; charset=utf-8',
         '.js': 'text/javascript; charset=utf-8'}
HEADERS = {
    # load nothing from other hosts; no other page may embed this one, which prevents clickjacking
    'Content-Security-Policy': "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
                               "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    'X-Frame-Options': 'DENY',
    'X-Content-Type-Options': 'nosniff',
    'Referrer-Policy': 'no-referrer',
    'Cross-Origin-Resource-Policy': 'same-origin',
    'Cross-Origin-Opener-Policy': 'same-origin',
    'Cache-Control': 'no-cache'}

for logger in 'tornado.access', 'tornado.general':
    logging.getLogger(logger).setLevel(logging.CRITICAL)    # otherwise, any client could fill the log


def read_files(folder: str) -> dict[str, tuple[str, bytes]]:
    """Return {path on the server: (content type, content)} for all files of the page. Raises OSError."""
    files = {}
    for name in sorted(os.listdir(folder)):
        kind = TYPES.get(os.path.splitext(name)[1])
        if kind:
            with open(os.path.join(folder, name), 'rb') as file:
                files[f'/{name}'] = kind, file.read()
    files['/'] = files['/index.html']
    return files


class CheckedHandler(RequestHandler):
    """Base class of the handlers: rejects requests with a foreign Host or Origin."""

    def initialize(self, hosts: HostCheck) -> None:
        """Called by tornado."""
        self.hosts = hosts

    def set_default_headers(self) -> None:
        """Called by tornado."""
        self.clear_header('Server')
        for name, value in HEADERS.items():
            self.set_header(name, value)

    def prepare(self) -> None:
        """Called by tornado before the method of each request."""
        headers = self.request.headers
        if len(headers.get_list('Host')) != 1 or len(headers.get_list('Origin')) > 1 or not self.hosts.accepts(
                headers['Host'], headers.get('Origin')):
            raise HTTPError(403)

    def write_error(self, status_code: int, **_: Any) -> None:
        self.set_header('Content-Type', 'text/plain; charset=utf-8')
        self.finish(f'{status_code}\n')


class FileHandler(CheckedHandler):
    """Serves a file of the page from memory. No path from a request is used to open a file."""

    def initialize(self, hosts: HostCheck, files: dict[str, tuple[str, bytes]] = {}) -> None:
        super().initialize(hosts)
        self.files = files

    def get(self) -> None:
        """Called by tornado for GET and HEAD."""
        if self.request.path not in self.files:
            raise HTTPError(404)
        kind, content = self.files[self.request.path]
        self.set_header('Content-Type', kind)
        self.write(content)

    head = get


class SocketHandler(WebSocketHandler, CheckedHandler):
    """The WebSocket of a browser."""

    def initialize(self, hosts: HostCheck, connections: Connections | None = None) -> None:
        super().initialize(hosts)
        assert connections
        self.connections = connections

    def prepare(self) -> None:
        super().prepare()
        if self.connections.full:
            raise HTTPError(503)

    def check_origin(self, origin: str) -> bool:
        """Called by tornado. prepare() has already checked the Origin."""
        return True

    def open(self, *_: str, **__: str) -> None:
        self.set_nodelay(True)
        self.connections.opened(self)

    def on_message(self, message: str | bytes) -> None:
        self.connections.received(self, message)

    def on_close(self) -> None:
        self.connections.closed(self)


class BoundedServer(HTTPServer):
    """An HTTP server with a limited number of connections, of which a new one replaces the oldest. Connections limits
    the WebSockets."""

    def initialize(self, *args: Any, **kwargs: Any) -> None:
        """Called by tornado, instead of __init__()."""
        super().initialize(*args, **kwargs)
        self.streams: dict[IOStream, None] = {}     # oldest first

    def handle_stream(self, stream: IOStream, address: tuple[Any, ...]) -> None:
        """Called by tornado for each connection."""
        if len(self.streams) >= MAX_CONNECTIONS:
            oldest = next(iter(self.streams))
            del self.streams[oldest]
            oldest.close()
        self.streams[stream] = None
        super().handle_stream(stream, address)

    def on_close(self, server_conn: object) -> None:
        """Called by tornado when a connection is closed, or has become a WebSocket."""
        self.streams.pop(server_conn.stream, None)      # type: ignore[attr-defined]
        super().on_close(server_conn)


class PageServer:
    """Serves the page."""

    def __init__(self, folder: str, hosts: HostCheck, connections: Mapping[str, Connections], address: str,
                 port: int) -> None:
        """folder: directory of the page's files; connections: by the path of the socket; port: 0 for any free port.
        Raises OSError."""
        self.connections = set(connections.values())
        self.sockets = bind_sockets(port, address)
        self.port = int(self.sockets[0].getsockname()[1])
        self.application = Application(
            [*((path, SocketHandler, dict(hosts=hosts, connections=each)) for path, each in connections.items()),
             ('.*', FileHandler, dict(hosts=hosts, files=read_files(folder)))],
            websocket_ping_interval=PING_PERIOD, websocket_max_message_size=MAX_MESSAGE,
            log_function=lambda handler: None)
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
        server = BoundedServer(self.application, max_header_size=MAX_HEADER, max_body_size=MAX_HEADER,
                               idle_connection_timeout=IDLE_TIMEOUT, body_timeout=IDLE_TIMEOUT)
        server.add_sockets(self.sockets)
        frames = PeriodicCallback(self._send_frames, FRAME_PERIOD)
        frames.start()
        self.ready.set()
        await self.end.wait()
        frames.stop()
        server.stop()
        for socket in [socket for each in self.connections for socket in each.browsers]:
            socket.close(1001, 'the web view has shut down')
        await asyncio.sleep(0.05)   # until the close frames have been sent

    def _send_frames(self) -> None:
        for each in self.connections:
            each.send_frames()

    def stop(self) -> None:
        """Close the connections and stop the thread; wait for at most 0.5 s."""
        if self.loop:
            self.loop.call_soon_threadsafe(self.end.set)
        self.thread.join(0.5)
