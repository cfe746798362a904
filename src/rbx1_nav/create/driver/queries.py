"""The queries to a robot that sends no stream, and the replies that are lost on the line. All times are in ns."""
from __future__ import annotations

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.sender import Sender
from rbx1_nav.create.driver.stream import ReplyReader
from rbx1_nav.create.driver.travel import CounterTravel, EncoderTravel
from rbx1_nav.units import SECOND

REPLY_TIMEOUT = SECOND // 5     # from a query to the first byte of its reply
BYTE_TIMEOUT = SECOND // 20     # between two bytes of a reply


class Queries:
    """What was asked of the robot, and is not answered yet. use() comes before all else."""

    def __init__(self, sender: Sender) -> None:
        self.commanded = sender.commanded
        self.byte_time = 0          # when the last bytes arrived
        self.missed = 0             # replies

    def use(self, model: protocol.Model, counter: EncoderTravel | CounterTravel) -> ReplyReader:
        """Ask a robot of this Model. Returns the reader of its replies."""
        self.counter = counter
        self.numbers = sequences.queried(model)
        self.reader = ReplyReader(model, *self.numbers)
        return self.reader

    def begin(self, now: int, start: bool) -> bytes:
        """The bytes of the next query. start: of a robot that is started first."""
        self.give_up()
        self.commanded.ask(now)
        # the angle of a Create is not always asked for
        short = (isinstance(self.counter, CounterTravel) and not start
                 and not self.counter.wants_angle(self.commanded.asked))
        numbers = self.numbers[1 if short else 0]
        self.reader.expect(numbers)
        return sequences.query(numbers)

    def awaits_reply(self, now: int) -> bool:
        """Whether the reply to the last query may still arrive."""
        if not self.reader.waiting:
            return False
        return (now - self.byte_time < BYTE_TIMEOUT if self.reader.buffer
                else now - self.commanded.asked_time < REPLY_TIMEOUT)

    def give_up(self) -> None:
        """A query that is not answered costs the travel before it, if it arrived."""
        if self.reader.waiting:
            self.lose_reply(bool(self.reader.buffer))
            self.reader.clear()

    def lose_reply(self, begun: bool) -> None:
        """begun: whether a part of the reply arrived."""
        commanded = self.commanded
        self.missed += 1
        self.counter.miss(begun, (commanded.asked_time - commanded.counted_from) / SECOND, commanded.asked)
        commanded.start(commanded.asked_time, commanded.asked)
