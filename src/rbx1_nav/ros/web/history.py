"""What the page draws over time: paths, speeds, log lines. All of it is bounded.

Everything that is added gets the next number of one counter. A browser knows the number up to which it has everything,
so one that was asleep gets what it missed with the next frame, as far as it is kept.
"""
from __future__ import annotations

from collections import deque
from math import hypot
from typing import Any

from rbx1_nav.units import wrap_angle

PATH_POINTS, SPEED_POINTS, LOG_LINES = 3000, 3000, 50
# a point for each of these distances; RViz draws an arrow for each 0.1 m or 0.15 rad
STEP, TURN = 0.02, 0.05     # m, rad
HOLD = 1.0      # s: a speed that stays the same gets a sample this often
LOG_TEXT = 300  # characters


class Counter:
    """Numbers all changes. A browser that has received nothing yet has the number 0."""

    def __init__(self) -> None:
        self.last = 0

    def next(self) -> int:
        """The next number."""
        self.last += 1
        return self.last


class Series:
    """The latest items of one kind, numbered by a counter that all series share."""

    def __init__(self, counter: Counter, size: int) -> None:
        """size: how many items are kept."""
        self.counter = counter
        # Any: items are lists of numbers and texts, as JSON has them
        self.items: deque[tuple[int, Any]] = deque(maxlen=size)

    def add(self, item: Any) -> None:
        """Add an item."""
        self.items.append((self.counter.next(), item))

    def since(self, number: int) -> list[Any]:
        """The items that are kept with larger numbers than this one."""
        found = []
        for each, item in reversed(self.items):
            if each <= number:
                break
            found.append(item)
        return found[::-1]

    def clear(self) -> None:
        """Forget all items."""
        self.items.clear()


class Path(Series):
    """Poses [x, y, yaw], m and rad, at some distance from each other."""

    def __init__(self, counter: Counter) -> None:
        super().__init__(counter, PATH_POINTS)

    def move(self, x: float, y: float, yaw: float) -> None:
        """The robot is at this pose now."""
        if self.items:
            last = self.items[-1][1]    # rounded, hence a little less than a step
            if hypot(x - last[0], y - last[1]) < 0.99 * STEP and abs(wrap_angle(yaw - last[2])) < 0.99 * TURN:
                return
        self.add([round(x, 4), round(y, 4), round(yaw, 4)])


class Speeds(Series):
    """Samples [time, linear, angular], s, m/s and rad/s, to be joined by lines. Equal ones are thinned out."""

    def __init__(self, counter: Counter, steps: bool = False) -> None:
        """steps: whether a speed holds until the next sample, as a commanded speed does."""
        super().__init__(counter, SPEED_POINTS)
        self.steps = steps
        self.held: list[float] | None = None    # the last sample, if it is left out so far

    def sample(self, time: float, linear: float, angular: float) -> None:
        """The speed at a time."""
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

    def clear(self) -> None:
        super().clear()
        self.held = None


class Log(Series):
    """Log lines [level, time, node, text]; level: as of rosgraph_msgs/Log, time: s since 1970."""

    def __init__(self, counter: Counter) -> None:
        super().__init__(counter, LOG_LINES)

    def line(self, level: int, time: float, node: str, text: str) -> None:
        """A node has logged a line."""
        text = text if len(text) <= LOG_TEXT else text[:LOG_TEXT - 3] + '...'
        self.add([level, round(time, 3), node[:100], text])
