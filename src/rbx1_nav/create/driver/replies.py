"""Decodes the replies of the robot to readings."""
from __future__ import annotations

from operator import le
from typing import Dict, Tuple

from rbx1_nav.create import protocol

Reading = Dict[str, int]        # values by the name of the packet
Numbers = Tuple[int, ...]       # of packets and groups


class Layout:
    """The layout of the reply to a query, and the ranges of its values."""

    def __init__(self, model: protocol.Model, numbers: Numbers) -> None:
        packets = protocol.single_packets(model, numbers)
        self.names = [packet.name for packet in packets]
        self.low = [packet.low for packet in packets]
        self.high = [packet.high for packet in packets]
        self.format = protocol.packets_format(packets)

    def decode(self, data: bytes) -> Reading | None:
        """Return the reading in a reply; None if its length or a value is not possible."""
        if len(data) != self.format.size:
            return None
        values = self.format.unpack(data)
        reading = dict(zip(self.names, values))
        if all(map(le, self.low, values)) and all(map(le, values, self.high)) and (
                protocol.MIN_VOLTAGE <= reading['voltage'] <= protocol.MAX_VOLTAGE):
            return reading
        return None


class ReplyReader:
    """Decodes the reply to a query.

    A reply has neither header nor checksum. It is checked only by its length and the ranges of its values.
    """

    def __init__(self, model: protocol.Model, *queries: Numbers) -> None:
        """queries: the packets and groups of each possible query."""
        self.layouts = {numbers: Layout(model, numbers) for numbers in queries}
        self.layout = self.layouts[queries[0]]  # layout of the expected reply
        self.buffer = bytearray()
        self.waiting = False    # whether a reply is expected
        self.rejected = 0       # number of rejected replies
        self.skipped = 0        # number of bytes outside replies

    def clear(self) -> None:
        """Discard an incomplete reply, and stop expecting one."""
        self.skipped += len(self.buffer)
        self.buffer.clear()
        self.waiting = False

    def expect(self, numbers: Numbers) -> None:
        """Expect the reply to a query that was sent: the next bytes. numbers: one of `queries`."""
        self.clear()
        self.layout = self.layouts[numbers]
        self.waiting = True

    @property
    def missing(self) -> int:
        """The number of bytes that complete the reply."""
        return self.layout.format.size - len(self.buffer) if self.waiting else 0

    def feed(self, data: bytes) -> Reading | None:
        """Return the reading that these bytes complete, if any."""
        self.buffer += data
        if not self.waiting or self.missing > 0:
            return None
        reading = self.layout.decode(bytes(self.buffer))
        if reading:
            self.buffer.clear()
            self.waiting = False
        else:
            self.rejected += 1
            self.clear()
        return reading
