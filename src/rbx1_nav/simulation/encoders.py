"""The wheel encoders of a base."""
from __future__ import annotations

from math import floor


class Encoder:
    """Counts whole ticks, rounded to the nearest tick."""

    def __init__(self, ticks_meter: float) -> None:
        """ticks_meter: ticks per meter."""
        self.ticks_meter = ticks_meter
        self.total = 0.0    # m, total travel of the wheel
        self.ticks = 0

    def count(self, travel: float) -> float:
        """Return the travel (m) that is counted while the wheel travels `travel` (m)."""
        self.total += travel
        before, self.ticks = self.ticks, floor(self.total * self.ticks_meter + 0.5)
        return (self.ticks - before) / self.ticks_meter
