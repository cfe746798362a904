"""Queries to the robot, and lost replies. All times are in ns.

Both kinds of robot could send a stream instead. But the counts of a Create start at 0 with each frame, and with queries
at most one reply is in transit when the line fails.
"""
from __future__ import annotations

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.replies import Reading, ReplyReader
from rbx1_nav.create.driver.sender import Sender
from rbx1_nav.create.driver.travel import CounterTravel, EncoderTravel
from rbx1_nav.units import SECOND

REPLY_TIMEOUT = SECOND // 5     # time from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # time between two bytes of a reply


class Queries:
    """Sends the queries, and tracks the one that the robot has not answered yet. Call use() before any other method."""

    def __init__(self, sender: Sender) -> None:
        self.sender = sender
        self.byte_time = 0          # time at which the last bytes arrived
        self.missed = 0             # number of lost replies

    def use(self, model: protocol.Model, counter: EncoderTravel | CounterTravel) -> None:
        """Prepare to query a robot of this Model."""
        self.counter = counter
        self.numbers = sequences.queried(model)
        self.reader = ReplyReader(model, *self.numbers)

    def ask(self, now: int, start: bool = False) -> None:
        """Ask for a reading. start: whether to start the robot first."""
        self.give_up()
        commanded = self.sender.commanded
        elapsed = (now - commanded.counted_from) / SECOND
        commanded.ask(now)
        # not every query asks a Create for its angle
        short = (isinstance(self.counter, CounterTravel) and not start
                 and not self.counter.wants_angle(commanded.asked, elapsed))
        numbers = self.numbers[1 if short else 0]
        self.reader.expect(numbers)
        self.sender.send(now, (sequences.STOP + sequences.START if start else b'') + sequences.query(numbers))

    def receive(self, now: int, data: bytes) -> Reading | None:
        """Return the reading that these bytes complete, if any."""
        if data:
            self.byte_time = now
        rejected = self.reader.rejected
        reading = self.reader.feed(data)
        if self.reader.rejected != rejected:
            self.lose_reply(True)
        return reading

    def awaits_reply(self, now: int) -> bool:
        """Return whether the reply to the last query may still arrive."""
        if not self.reader.waiting:
            return False
        return (now - self.byte_time < BYTE_TIMEOUT if self.reader.buffer
                else now - self.sender.commanded.asked_time < REPLY_TIMEOUT)

    def give_up(self) -> None:
        """Stop waiting for a reply. If the query did reach the robot, the travel before it is lost."""
        if self.reader.waiting:
            self.lose_reply(bool(self.reader.buffer))
            self.reader.clear()

    def lose_reply(self, begun: bool) -> None:
        """Record a lost reply. begun: whether a part of the reply arrived."""
        commanded = self.sender.commanded
        self.missed += 1
        self.counter.miss(begun, (commanded.asked_time - commanded.counted_from) / SECOND, commanded.asked)
        commanded.start(commanded.asked_time, commanded.asked)
