"""Converts a velocity to wheel speeds that the robot accepts: whole mm/s, at most 500."""
from __future__ import annotations

from math import ceil, floor

from rbx1_nav.create.protocol import MAX_SPEED


def is_too_fast(linear: float, angular: float, width: float) -> bool:
    """Return whether a velocity in m/s and rad/s exceeds the speed limit of a wheel."""
    return 1000 * (abs(linear) + abs(angular) * width / 2) > MAX_SPEED


def wheel_speeds(linear: float, angular: float, width: float) -> tuple[float, float]:
    """Return (left, right) in mm/s for m/s and rad/s. Above the limit, both are reduced by one factor, which preserves
    the curvature."""
    difference = angular * width / 2
    left, right = 1000 * (linear - difference), 1000 * (linear + difference)
    excess = max(abs(left), abs(right)) / MAX_SPEED
    return (left / excess, right / excess) if excess > 1 else (left, right)


class Rounding:
    """Rounds the speed of a wheel so that the mean over time is the requested speed."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Set the wheel to rest, without a rounding error to make up for."""
        self.asked = 0.0    # mm/s
        self.sent = 0       # mm/s
        self.debt = 0.0     # mm that the wheel is behind

    def next(self, asked: float, elapsed: float) -> int:
        """Return the whole mm/s to send for a speed (mm/s), `elapsed` seconds after the previous call."""
        if asked == 0:
            self.reset()
            return 0
        # a command is in force for less than a second, or else the robot has stopped
        self.debt += (self.asked - self.sent) * min(elapsed, 1.0)
        self.asked = asked
        self.sent = ceil(asked) if self.debt > 0 else floor(asked)
        return self.sent
