"""The wheel travel expected from the commands that were sent, for when the robot cannot be reached."""
from __future__ import annotations

from rbx1_nav.create.driver.travel import STILL, Expected
from rbx1_nav.units import SECOND


def _plus(one: Expected, other: tuple[float, float], factor: float) -> Expected:
    return Expected(*(value + factor * more for value, more in zip(one, other)))


class Commanded:
    """Integrates the speeds that were sent over time (ns). The robot always keeps executing the last command."""

    def __init__(self) -> None:
        self.speeds = (0, 0)        # left, right: mm/s
        self.since_reading = STILL  # travel since the last good reading
        self.counted = STILL        # travel since the robot last started to count
        self.counted_from = 0       # ns, when the robot last started to count
        self.asked = STILL          # the part of `counted` before the last query
        self.asked_time = 0         # ns, time of the last query
        self._time = 0              # ns, end of the integration so far

    @property
    def moving(self) -> bool:
        """Whether the robot was commanded to move."""
        return any(self.speeds)

    def advance(self, now: int) -> None:
        """Integrate up to `now`."""
        metres = max(0, now - self._time) / SECOND / 1000
        self._time = now
        self.since_reading = _plus(self.since_reading, self.speeds, metres)
        self.counted = _plus(self.counted, self.speeds, metres)

    def send(self, now: int, speeds: tuple[int, int]) -> None:
        """Record that new speeds are sent."""
        self.advance(now)
        self.speeds = speeds

    def ask(self, now: int) -> None:
        """Record that a query is sent. When it arrives, the robot starts to count from 0."""
        self.advance(now)
        self.asked, self.asked_time = self.counted, now

    def start(self, time: int, part: Expected) -> None:
        """Record that the robot started to count from 0 at `time`. part: the part of `counted` before `time`."""
        self.counted, self.counted_from = _plus(self.counted, part, -1), time

    def read(self) -> None:
        """Record that a good reading has arrived."""
        self.since_reading = STILL
