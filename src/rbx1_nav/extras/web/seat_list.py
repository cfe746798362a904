"""The teacher's page of seats.py: exchanges its code for the list of seats. The page then connects to each seat."""
from __future__ import annotations

from typing import Sequence

from tornado.websocket import WebSocketHandler

from rbx1_nav.extras.web.access import Access
from rbx1_nav.extras.web.page_messages import Hello, InvalidMessage, encode, parse
from rbx1_nav.extras.web.seat import Seat

MAX_SILENT = 20     # browsers that have not sent hello


class SeatList:
    """Takes the place of Connections for a PageServer. Each browser is disconnected when it has its answer."""

    def __init__(self, access: Access, seats: Sequence[Seat]) -> None:
        """access: who may stop the seats."""
        self.access = access
        self.seats = [{'number': each.number, 'port': each.web_port, 'token': each.token} for each in seats]
        self.browsers: list[WebSocketHandler] = []

    def opened(self, socket: WebSocketHandler) -> None:
        """Add a browser that has connected."""
        self.browsers.append(socket)
        if len(self.browsers) > MAX_SILENT:
            self.browsers.pop(0).close()

    def received(self, socket: WebSocketHandler, text: object) -> None:
        """Answer hello, with the list of seats if its token or code is valid."""
        try:
            hello = parse(text)
        except InvalidMessage:
            hello = None
        if isinstance(hello, Hello):
            token, _ = self.access.check(hello.token, hello.code)
            socket.write_message(encode('welcome', token=token, seats=self.seats if token else []))
        socket.close()

    def closed(self, socket: WebSocketHandler) -> None:
        """Remove a browser that has disconnected."""
        if socket in self.browsers:
            self.browsers.remove(socket)

    def flooded(self, socket: WebSocketHandler) -> None:
        """A browser that sends too fast is disconnected anyway."""
