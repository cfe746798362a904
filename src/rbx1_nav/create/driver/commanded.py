"""How far the wheels should have travelled by the commands on the line: all that is known of a robot out of reach."""
from __future__ import annotations

from rbx1_nav.create.driver.travel import STILL, Expected
from rbx1_nav.units import SECOND


def _plus(one: Expected, other: tuple[float, float], factor: float) -> Expected:
    return Expected(*(value + factor * more for value, more in zip(one, other)))


class Commanded:
    """The speeds that were sent, added up over time (ns). The robot goes on with the last ones, whatever happens."""

    def __init__(self) -> None:
        self.speeds = (0, 0)        # left, right: mm/s
        self.since_reading = STILL  # since the last good reading
        self.counted = STILL        # and since the robot last started to count
        self.counted_from = 0       # ns, when that was
        self.asked = STILL          # the part of `counted` before the last query
        self.asked_time = 0         # ns, of the last query
        self._time = 0              # ns, up to where all of these go

    @property
    def moving(self) -> bool:
        """Whether the robot was sent to move."""
        return any(self.speeds)

    def advance(self, now: int) -> None:
        """Add up to `now`."""
        metres = max(0, now - self._time) / SECOND / 1000
        self._time = now
        self.since_reading = _plus(self.since_reading, self.speeds, metres)
        self.counted = _plus(self.counted, self.speeds, metres)

    def send(self, now: int, speeds: tuple[int, int]) -> None:
        """Other speeds are sent."""
        self.advance(now)
        self.speeds = speeds

    def ask(self, now: int) -> None:
        """A query is sent: when it arrives, the robot starts to count from 0."""
        self.advance(now)
        self.asked, self.asked_time = self.counted, now

    def start(self, time: int, part: Expected) -> None:
        """The robot started to count from 0 at `time`. part: of `counted`, before that."""
        self.counted, self.counted_from = _plus(self.counted, part, -1), time

    def read(self) -> None:
        """A good reading has arrived."""
        self.since_reading = STILL
