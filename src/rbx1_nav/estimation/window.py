"""The window in which the turns of wheels and gyro are compared."""
from __future__ import annotations

from operator import add
from typing import NamedTuple

WINDOW_TURN, WINDOW_TIME = 2.0, 9.9     # rad, s: turn or time after which a window is complete
BLOCK = 0.99    # s: part of a window; both times are a little less than 10 and 1 s, because stamps are rounded


class Sums(NamedTuple):
    """Sums of what wheels and gyro measured in a number of steps."""

    time: float = 0.0       # s
    wheels: float = 0.0     # rad: the turn that the wheels report
    expected: float = 0.0   # rad: this turn on the assumed floor
    gyro: float = 0.0       # rad: the turn, corrected by the bias
    forward: float = 0.0    # m
    variance: float = 0.0   # rad^2: of the turn that the wheels report
    turned: float = 0.0     # rad: the larger one of the turns, both directions counted positive
    scatter: float = 0.0    # rad^2: variance of the difference of the turns, from the scatter of its blocks

    def plus(self, other: Sums) -> Sums:
        """Return the sum."""
        return Sums(*map(add, self, other))


class Window:
    """Sums up the steps. Their noise is measured by the scatter of blocks of 1 s."""

    def __init__(self) -> None:
        self.sums = Sums()
        self.block = Sums()     # the latest block
        self.last = 0.0         # rad: the difference of the turns in the block before

    def add(self, step: Sums) -> None:
        """Add a step."""
        self.block = self.block.plus(step)

    def complete(self) -> Sums | None:
        """Return the Sums if the window is complete."""
        block = self.block
        if block.time < BLOCK:
            return None
        last, self.last = self.last, block.gyro - block.expected
        self.sums = self.sums.plus(block._replace(
            turned=max(abs(block.wheels), abs(block.gyro)), scatter=(self.last - last) ** 2 / 2))
        self.block = Sums()
        return self.sums if self.sums.time > WINDOW_TIME or self.sums.turned > WINDOW_TURN else None
