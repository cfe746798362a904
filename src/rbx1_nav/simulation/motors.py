"""The motors of a base: how and when their speeds follow a command."""
from __future__ import annotations

from collections import deque
from math import copysign, exp, log
from typing import Deque, Iterator


class Motor:
    """A speed that follows a command with a lag and a limited acceleration, and stays below it because of drag.

    The acceleration is (command - speed -+ drag) / lag, limited to accel_limit. Drag always opposes the motion: it
    slows the start, shortens the stop, and holds a stationary wheel while the command does not exceed it. The equation
    is solved in closed form, so the result does not depend on the number of steps.
    """

    def __init__(self, lag: float, accel_limit: float, drag: float) -> None:
        """lag: s; accel_limit: m/s^2; drag: m/s. All are above 0."""
        self.lag = lag
        self.accel_limit = accel_limit
        self.drag = drag
        self.limited_gap = accel_limit * lag    # m/s: if the command differs by more, the acceleration is limited
        self.speed = 0.0        # m/s

    def travel(self, command: float, duration: float) -> float:
        """Return the travel (m) while a speed (m/s) is commanded for `duration` (s)."""
        speed, travel = self.speed, 0.0
        if not (speed or command):      # usual for one of the two motors
            return travel
        while duration > 0:
            target = command - copysign(self.drag, speed or command)
            if not speed and target * command <= 0:
                break       # drag holds it
            gap = target - speed
            beyond = abs(gap) - self.limited_gap
            if beyond > 0 and abs(gap) > self.limited_gap + 1e-12 * (abs(speed) + abs(target)):     # not by rounding
                acceleration = copysign(self.accel_limit, gap)
                time = beyond / self.accel_limit
                if speed and (speed > 0) != (gap > 0):
                    stop = -speed / acceleration
                    if stop <= min(time, duration):
                        travel += speed * stop / 2
                        speed = 0.0
                        duration -= stop
                        continue
                time = min(time, duration)
                travel += (speed + acceleration * time / 2) * time
                speed += acceleration * time
            else:
                time = duration
                if speed and target and (speed > 0) != (target > 0):
                    time = min(time, self.lag * log(1 - speed / target))
                closed = gap * (1 - exp(-time / self.lag))
                travel += target * time - closed * self.lag
                # a wheel that stops before the duration is over stops exactly
                speed = speed + closed if time == duration else 0.0
            duration -= time
        self.speed = speed
        return travel


class Delay:
    """Delays commands by a fixed time."""

    def __init__(self, delay: float) -> None:
        """delay: s, above 0."""
        self.delay = delay
        self.clear()

    def clear(self) -> None:
        # linear (m/s), angular (rad/s), duration (s)
        self.parts: Deque[list[float]] = deque([[0.0, 0.0, self.delay]])

    @property
    def is_empty(self) -> bool:
        return not any(linear or angular for linear, angular, _ in self.parts)

    def over(self, linear: float, angular: float, duration: float) -> Iterator[tuple[float, float, float]]:
        """Yield (linear, angular, duration) of the delayed commands while a command is in force for `duration` (s)."""
        parts = self.parts
        last = parts[-1]
        if last[0] == linear and last[1] == angular:
            last[2] += duration
        else:
            parts.append([linear, angular, duration])
        while duration > 0:
            linear, angular, left = parts[0]
            if left > duration or len(parts) == 1:
                parts[0][2] -= duration
                yield linear, angular, duration
                return
            parts.popleft()
            yield linear, angular, left
            duration -= left
