"""Sends queries to the robot, and decodes the replies, which may be late, lost or corrupted. All times are in ns.

There is one query at a time. If its reply is overdue, the robot is asked something else: a probe, whose answer contains
the number of the probe. Whatever has arrived before this answer is the reply to the query, and if nothing has, the
reply is lost. So a late reply is not taken for the reply to another query.

Both kinds of robot could send a stream instead. But the counts of a Create start at 0 with each frame, and with queries
at most one reply is in transit when the line fails.
"""
from __future__ import annotations

from operator import le
from typing import Dict, NamedTuple

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.odometry import STILL, Counter, Expected
from rbx1_nav.extras.create.sender import Kind, Sender

REPLY_TIMEOUT = SECOND // 5     # time from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # time between two bytes of a reply
MODE, ZERO = 35, 16             # packets of a probe: one is never 0, the other always
PROBE_SIZE, NUMBERS = 8, 64     # bytes of an answer; probes with different numbers
MAX_BUFFER = 4096               # bytes
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


def probe(number: int) -> tuple[int, ...]:
    """Return the packets of the probe with this number."""
    return MODE, MODE, *(MODE if number % NUMBERS >> bit & 1 else ZERO for bit in range(PROBE_SIZE - 2))


def is_answer(data: bytes, number: int) -> bool:
    """Return whether bytes are the answer to the probe with this number."""
    return (len(data) == PROBE_SIZE and protocol.PASSIVE <= data[0] <= protocol.FULL + 1
            and data == bytes(data[0] if packet == MODE else 0 for packet in probe(number)))


class Queries:
    """Sends the queries, and decodes the replies, which have neither header nor checksum. Call use() before any other
    method."""

    def __init__(self, sender: Sender) -> None:
        self.sender = sender
        self.asked = Mark(0, STILL)         # of the last query, when the robot senses what it replies
        self.read: Mark | None = None       # of the query with the last good reading
        self.heard: int | None = None   # time at which it arrived
        self.waiting = False        # whether a reply is expected
        self.probes = 0             # number of probes that were sent because the reply is overdue
        self.buffer = bytearray()   # the bytes that have arrived since the query
        self.began = False          # whether bytes have arrived since the last query or probe
        self.byte_time = 0          # time of the last query, probe or byte
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
        """Send a query; or a probe, if the reply to the last query may still arrive."""
        if not self.sender.may_send(Kind.QUERY):
            return
        if self.began and not self.probes and not self.counter.resets:
            self.give_up()      # the rest of the reply contains nothing that the next one does not
        self.byte_time, self.began = now, False
        if self.waiting:
            self.probes += 1
            self.sender.send(now, Kind.QUERY, sequences.query(probe(self.probes)))
            return
        self.buffer.clear()
        self.asked = Mark(now, self.sender.travel(now))
        # not every query asks a Create for its angle
        self.layout = self.layouts[0 if self.counter.wants_angle(*self.since_reading()) else 1]
        self.waiting, self.probes = True, 0
        self.sender.send(now, Kind.QUERY, self.layout.query)

    @property
    def missing(self) -> int:
        """The number of bytes that complete the reply."""
        size = self.layout.format.size + self.probes * PROBE_SIZE if self.waiting else 0
        return max(0, size - len(self.buffer))

    def receive(self, now: int, data: bytes) -> Values | None:
        """Return the reading that these bytes complete, if any. Call accept() or lose_reply() then."""
        if not self.waiting:
            return None
        if data:
            self.byte_time, self.began = now, True
            self.buffer += data
            del self.buffer[:-MAX_BUFFER]
        reply = self._reply()
        if reply is None:
            return None
        self.waiting = False
        reading = self.layout.decode(reply)
        if reading is None:
            self.rejected += bool(reply)
            self.lose_reply()
        return reading

    def _reply(self) -> bytes | None:
        """Return the reply to the query; None while it may be incomplete."""
        if not self.probes:
            return None if self.missing else bytes(self.buffer)
        reply = bytes(self.buffer)
        if not is_answer(reply[-PROBE_SIZE:], self.probes):
            return None
        for number in range(self.probes, 0, -1):
            if is_answer(reply[-PROBE_SIZE:], number):      # not all of them have been answered
                reply = reply[:-PROBE_SIZE]
        return reply

    def sensed_at(self, now: int) -> None:
        """Correct the time of the last query: the robot has answered it later, when it executed a late query."""
        self.asked = Mark(now, self.sender.travel(now))

    def accept(self, now: int) -> None:
        """Record that the reading is good."""
        self.read, self.heard = self.asked, now
        self.lost_share *= 1 - MEMORY

    def awaits_reply(self, now: int) -> bool:
        """Return whether the reply to the last query or probe may still arrive without another probe."""
        return self.waiting and now - self.byte_time < (BYTE_TIMEOUT if self.began else REPLY_TIMEOUT)

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
