"""Sends queries to the robot, and decodes the replies, which may be lost or corrupted. All times are in ns.

Both kinds of robot could send a stream instead. But the counts of a Create start at 0 with each frame, and with queries
at most one reply is in transit when the line fails.
"""
from __future__ import annotations

from operator import le
from typing import Dict, NamedTuple

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create import sequences
from rbx1_nav.extras.create.motion import STILL, Counter, Expected
from rbx1_nav.extras.create.sender import Sender

REPLY_TIMEOUT = SECOND // 5     # time from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # time between two bytes of a reply
MEMORY = 0.02                   # weight of the last reply in the share of lost replies, which covers about 50 replies

Values = Dict[str, int]        # values by the name of the packet


class Layout:
    """A query, the layout of its reply, and the ranges of the values."""

    def __init__(self, model: protocol.Model, numbers: tuple[int, ...]) -> None:
        """numbers: packets and groups."""
        packets = protocol.single_packets(model, numbers)
        self.query = sequences.query(numbers)
        self.names, self.low, self.high = zip(*((packet.name, packet.low, packet.high) for packet in packets))
        self.format = protocol.packets_format(packets)

    def decode(self, data: bytes) -> Values | None:
        """Return the reading in a reply; None if its length or a value is not possible."""
        if len(data) != self.format.size:
            return None
        values = self.format.unpack(data)
        reading = dict(zip(self.names, values))
        if all(map(le, self.low, values)) and all(map(le, values, self.high)) and (
                protocol.MIN_VOLTAGE <= reading['voltage'] <= protocol.MAX_VOLTAGE):
            return reading
        return None


class Mark(NamedTuple):
    """A time, and the total commanded travel up to then."""

    time: int
    travel: Expected


class Queries:
    """Sends the queries, and decodes the replies, which have neither header nor checksum. Call use() before any other
    method."""

    def __init__(self, sender: Sender) -> None:
        self.sender = sender
        self.asked = Mark(0, STILL)         # of the last query, when the robot senses what it replies
        self.read: Mark | None = None       # of the query with the last good reading
        self.waiting = False        # whether a reply is expected
        self.buffer = bytearray()   # the bytes of the reply that have arrived
        self.byte_time = 0          # time at which the last bytes arrived
        self.missed = self.rejected = 0     # number of lost replies, and of corrupted replies among them
        self.lost_share = 0.0       # share of the last replies that were lost

    def use(self, model: protocol.Model, counter: Counter) -> None:
        """Prepare to query a robot of this Model."""
        self.counter = counter
        self.layouts = [Layout(model, numbers) for numbers in sequences.queried(model)]
        self.layout = self.layouts[0]

    def since_reading(self) -> tuple[float, Expected]:
        """Return the time (s) from the last good reading to the last query, and the commanded travel in this time."""
        if self.read is None:
            return 0.0, STILL
        return (self.asked.time - self.read.time) / SECOND, self.asked.travel.plus(self.read.travel, -1)

    def ask(self, now: int) -> None:
        self.give_up()
        self.buffer.clear()
        self.asked = Mark(now, self.sender.travel(now))
        # not every query asks a Create for its angle
        self.layout = self.layouts[0 if self.counter.wants_angle(*self.since_reading()) else 1]
        self.waiting = True
        self.sender.send(now, self.layout.query)

    @property
    def missing(self) -> int:
        """The number of bytes that complete the reply."""
        return self.layout.format.size - len(self.buffer) if self.waiting else 0

    def receive(self, now: int, data: bytes) -> Values | None:
        """Return the reading that these bytes complete, if any. Call accept() or lose_reply() then."""
        if not (data and self.waiting):
            return None
        self.byte_time = now
        self.buffer += data
        if self.missing > 0:
            return None
        self.waiting = False
        reading = self.layout.decode(bytes(self.buffer))
        if reading is None:
            self.rejected += 1
            self.lose_reply()
        return reading

    def accept(self) -> None:
        """Record that the reading is good."""
        self.read = self.asked
        self.lost_share *= 1 - MEMORY

    def awaits_reply(self, now: int) -> bool:
        """Return whether the reply to the last query may still arrive."""
        return self.waiting and (now - self.byte_time < BYTE_TIMEOUT if self.buffer
                                 else now - self.asked.time < REPLY_TIMEOUT)

    def give_up(self) -> None:
        """Stop waiting for a reply. If the query did reach the robot, the travel before it is lost."""
        if self.waiting:
            self.waiting = False
            self.lose_reply()

    def lose_reply(self) -> None:
        """Record a lost reply."""
        self.missed += 1
        self.lost_share += (1 - self.lost_share) * MEMORY
        self.counter.miss(*self.since_reading())
