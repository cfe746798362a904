"""Stores the filter's past yaws, for odometry that is behind the gyro."""
from __future__ import annotations

from collections import deque
from typing import Deque


class PastYaws:
    """Past yaws (rad) of the filter, with their times (ns)."""

    def __init__(self) -> None:
        self.yaws: Deque[tuple[int, float]] = deque()

    def add(self, time: int, yaw: float) -> None:
        """Add the latest yaw, if there is none for its time."""
        if not self.yaws or self.yaws[-1][0] < time:
            self.yaws.append((time, yaw))

    def turn(self, angle: float) -> None:
        """Add an angle (rad) to all yaws."""
        self.yaws = deque((time, yaw + angle) for time, yaw in self.yaws)

    def at(self, time: int) -> float:
        """Return the yaw at a time between the first and the last yaw, and discard the yaws before it."""
        yaws = self.yaws
        while yaws[1][0] < time:
            yaws.popleft()
        (start, before), (end, after) = yaws[0], yaws[1]
        return before + (after - before) * (time - start) / (end - start)
