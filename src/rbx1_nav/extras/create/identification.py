"""Finds the robot on a line: its model and its baud rate.

Until a robot has answered, its rate is unknown, and at a wrong rate almost any command may be read as another command:
a stop sent at 57600 baud is read at 115200 as 0x86, which starts spot cleaning. So the search sends only bytes that no
receiver can mistake for another command: Start, and a battery query. At the right rate, Start stops every motion.
"""
from __future__ import annotations

from typing import Callable, NamedTuple, Optional, Sequence

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.queries import Layout
from rbx1_nav.extras.create.sender import Kind, Sender
from rbx1_nav.extras.create.serial_port import Link

RATES = (57600, 115200, 19200)      # of a Create, of a Create 2, and of either after its buttons were held
REPLY_TIME = SECOND * 12 // 100     # ns after the last byte of a query within which the reply arrives
QUIET_TIME = SECOND // 20           # ns within which a paused stream stops
SETTLE_TIME = SECOND // 50          # ns without another byte that confirm a complete reply
AGREEING = 2                        # consecutive plausible replies that are required
TRIES = 4                           # number of queries for the model
STARTS, MANY_STARTS = 8, 64         # Start bytes before a query; many soon complete a command begun by garbage
FEW_ROUNDS = 2                      # number of rounds with few Start bytes
SIZES = 1, 3                        # bytes: replies to the query for the model without and with encoders
MAX_BUFFER = 4096                   # bytes
WAKE_TIME = SECOND * 3 // 4         # ns at each level: 0.5 s wakes a robot, three shorter pulses change its rate

_BATTERY = Layout(protocol.CREATE, (sequences.BATTERY,))    # the same for all models


class Found(NamedTuple):
    """A robot that answers."""

    model: protocol.Model
    baud: int       # bits per second


def is_battery(data: bytes) -> bool:
    """Return whether bytes are the reply to a battery query: the right number of bytes, with plausible values."""
    values = _BATTERY.decode(data)
    return bool(values and -40 <= values['temperature'] <= 100)


def has_frames(data: bytes) -> bool:
    """Return whether bytes contain two consecutive frames of a stream, which an earlier driver left on."""
    def end_of_frame(start: int) -> int | None:
        if start + 1 >= len(data) or data[start] != protocol.FRAME_HEADER:
            return None
        end = start + 3 + data[start + 1]
        return end if end <= len(data) and not sum(data[start:end]) & 0xff else None
    ends = map(end_of_frame, range(len(data)))
    return any(end_of_frame(end) for end in ends if end)


# the action due at a time (ns); returns the robot once it is known
Step = Callable[[int], Optional[Found]]


class Search:
    """Queries one rate after another. All times are in ns."""

    def __init__(self, sender: Sender, rates: Sequence[int], wake: bool = False) -> None:
        """rates: rates to try in bits per second, most likely first; wake: whether to wake a sleeping robot."""
        self.sender = sender
        self.rates = rates
        self.wake = wake
        self.rounds = 0         # completed rounds without an answer
        self.battery_rates: list[int] = []  # rates at which a robot answered nothing but the query of its battery
        self.baud = rates[0]    # rate being tried
        self._line: Link
        self._order: list[int] = []         # rates still to be tried in this round
        self._buffer = bytearray()
        self._sizes: Sequence[int] = ()     # possible sizes of the reply in bytes, the largest last
        self._then: Step        # action at the deadline
        self._deadline = 0
        self._agreed = 0        # consecutive plausible replies
        self._replies: list[int] = []       # sizes of the replies to the query for the model
        self._expected: protocol.Model | None = None

    def begin(self, now: int, line: Link, baud: int | None = None, expected: protocol.Model | None = None) -> None:
        """Begin to search on a line. baud: the rate to try first, one of `rates`; expected: the model that is meant if
        several have the same answer."""
        self._line, self._expected = line, expected
        self.rates = tuple(sorted(self.rates, key=lambda rate: rate != baud))
        self.rounds, self.battery_rates, self._order = 0, [], list(self.rates)
        self._next_rate(now)

    @property
    def missing(self) -> int:
        """The number of bytes that complete the reply."""
        return max(0, self._sizes[-1] - len(self._buffer)) if self._sizes else 0

    def receive(self, now: int, data: bytes) -> None:
        self._buffer += data
        del self._buffer[:-MAX_BUFFER]
        if self._then == self._judge_battery and has_frames(self._buffer):
            self._pause_stream(now)
        elif len(self._buffer) in self._sizes:
            self._deadline = min(self._deadline, now + SETTLE_TIME)

    def tick(self, now: int) -> Found | None:
        """Do what is due. Returns Found once the robot is known, else None."""
        return self._then(now) if now >= self._deadline else None

    def _plan(self, deadline: int, then: Step, sizes: Sequence[int] = ()) -> None:
        self._buffer.clear()
        self._deadline, self._then, self._sizes = deadline, then, sizes

    def _next_rate(self, now: int) -> None:
        self._agreed = 0
        if not self._order:
            self.rounds += 1
            self._order = list(self.rates)
            self.wake = self.wake and self._line.set_wake_lines(False)
            if self.wake:
                self._plan(now + WAKE_TIME, self._end_wake)
                return
        self.baud = self._order.pop(0)
        self._line.set_rate(self.baud)
        self._ask_battery(now)

    def _end_wake(self, now: int) -> None:
        self._line.set_wake_lines(True)
        self._plan(now + WAKE_TIME, self._next_rate)

    def _send(self, now: int, data: bytes, then: Step, *sizes: int) -> None:
        """Send a query whose reply has one of these sizes."""
        self._plan(now + (len(data) + max(sizes, default=0)) * 10 * SECOND // self.baud + REPLY_TIME, then, sizes)
        self.sender.send(now, Kind.SEARCH, data)

    def _ask_battery(self, now: int) -> None:
        count = STARTS if self.rounds < FEW_ROUNDS else MANY_STARTS
        self.sender.send(now, Kind.SEARCH, sequences.START * count, self._line.write_apart)
        self._send(now + count * sequences.PAUSE, sequences.ASK_BATTERY, self._judge_battery, _BATTERY.format.size)

    def _judge_battery(self, now: int) -> None:
        if not is_battery(bytes(self._buffer)):
            self._next_rate(now)
            return
        self._agreed += 1
        if self._agreed < AGREEING:
            self._ask_battery(now)
        else:
            self._pause_stream(now)

    # from here on the rate is right, so the robot reads each command correctly

    def _pause_stream(self, now: int) -> None:
        self._replies = []
        self._send(now, sequences.PAUSE_STREAM, self._ask_model)
        self._deadline = now + QUIET_TIME

    def _ask_model(self, now: int) -> None:
        # a robot without encoders answers only the second query
        self._send(now, sequences.ASK_ENCODER + sequences.ASK_WALL, self._identify, *SIZES)

    def _identify(self, now: int) -> Found | None:
        size = len(self._buffer)
        if size in SIZES and size in self._replies:
            has_encoders = size == max(SIZES)
            models = [each for each in protocol.MODELS.values() if bool(each.counts_per_metre) == has_encoders]
            return Found(self._expected if self._expected in models else self._at_rate(models), self.baud)
        self._replies.append(size)
        if len(self._replies) < TRIES:
            self._ask_model(now)
        elif set(SIZES) & set(self._replies):
            return Found(self._at_rate(list(protocol.MODELS.values())), self.baud)
        else:
            self._send(now, sequences.ASK_BATTERY, self._judge_silence, _BATTERY.format.size)
        return None

    def _at_rate(self, models: Sequence[protocol.Model]) -> protocol.Model:
        """Return the first of these models that has this rate, or else the first."""
        return next((each for each in models if each.baud == self.baud), models[0])

    def _judge_silence(self, now: int) -> None:
        """Judge a robot that has answered the battery query, and no query of its model: it may have fallen silent."""
        self.battery_rates = self.battery_rates + [self.baud] if is_battery(bytes(self._buffer)) else []
        self._next_rate(now)
