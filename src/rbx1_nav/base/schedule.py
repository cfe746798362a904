"""Determines when a periodic task is due, on any clock."""
from __future__ import annotations

from rbx1_nav.base.units import SECOND


class Schedule:
    """Determines when a periodic task is due, even on a clock that jumps."""

    def __init__(self, rate: float) -> None:
        """rate: Hz."""
        self.period = round(SECOND / rate)
        self.last = self.next = 0

    def due(self, now: int) -> bool:
        """Return whether the task is due at `now` (ns). Call this about once per period or more often."""
        jumped_back = now < self.last
        self.last = now
        if now < self.next and not jumped_back:
            return False
        late = jumped_back or now >= self.next + self.period
        self.next = (now if late else self.next) + self.period
        return True
