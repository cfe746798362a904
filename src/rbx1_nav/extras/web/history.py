"""Histories for the page: paths, speeds and log messages, each of limited length.

One counter numbers all items. For each browser, the server stores the number of the last item that it has received. The
next frame contains all later items that are still stored, so a browser that was asleep receives what it missed.
"""
from __future__ import annotations

from collections import deque
from math import hypot
from typing import Any

from rbx1_nav.base.units import wrap_angle

PATH_POINTS, SPEED_POINTS, LOG_LINES = 3000, 3000, 50
# distances between the points of a path; an arrow is drawn for every 0.1 m or 0.5 rad
STEP, TURN = 0.02, 0.05     # m, rad
HOLD = 1.0      # s: period of the samples while a speed is constant


class Counter:
    """Numbers all changes. The number of a browser that has received nothing is 0."""

    def __init__(self) -> None:
        self.last = 0

    def next(self) -> int:
        self.last += 1
        return self.last


class Series:
    """The latest items of one kind. All series share one counter for the numbers of their items."""

    def __init__(self, counter: Counter, size: int) -> None:
        """size: maximum number of items."""
        self.counter = counter
        # Any: items are JSON lists of numbers and strings
        self.items: deque[tuple[int, Any]] = deque(maxlen=size)

    def add(self, item: Any) -> None:
        self.items.append((self.counter.next(), item))

    def since(self, number: int) -> list[Any]:
        """Return the stored items with a number greater than this."""
        found = []
        for each, item in reversed(self.items):
            if each <= number:
                break
            found.append(item)
        return found[::-1]


class Path(Series):
    """Poses [x, y, yaw] (m, rad), spaced by at least STEP or TURN."""

    def __init__(self, counter: Counter) -> None:
        super().__init__(counter, PATH_POINTS)

    def move(self, x: float, y: float, yaw: float) -> None:
        """Add the current pose, if the robot has moved far enough."""
        if self.items:
            last = self.items[-1][1]    # 0.99: this pose is rounded
            if hypot(x - last[0], y - last[1]) < 0.99 * STEP and abs(wrap_angle(yaw - last[2])) < 0.99 * TURN:
                return
        self.add([round(x, 4), round(y, 4), round(yaw, 4)])


class Speeds(Series):
    """Samples [time, linear, angular] (s, m/s, rad/s), to be joined by lines. Repeated speeds are thinned out."""

    def __init__(self, counter: Counter, steps: bool = False) -> None:
        """steps: whether a speed is constant until the next sample, as a commanded speed is."""
        super().__init__(counter, SPEED_POINTS)
        self.steps = steps
        self.held: list[float] | None = None    # the last sample, if it has not been added

    def sample(self, time: float, linear: float, angular: float) -> None:
        """Add the speed at a time."""
        item = [round(time, 3), round(linear, 4), round(angular, 4)]
        last = self.items[-1][1] if self.items else None
        if last is not None and item[1:] == last[1:] and time - last[0] < HOLD:
            self.held = item
            return
        if last is not None and item[1:] != last[1:]:
            if self.steps:
                self.add([item[0], *last[1:]])
            elif self.held:
                self.add(self.held)
        self.held = None
        self.add(item)
