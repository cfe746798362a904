"""Turns from gyro readings: readings wait here until the odometry arrives, and yaws if the gyro is ahead of it."""
from __future__ import annotations

from collections import deque
from typing import Deque, NamedTuple

from rbx1_nav.estimation.filter import Measurement
from rbx1_nav.estimation.inputs import Imu
from rbx1_nav.estimation.priors import Limits
from rbx1_nav.units import SECOND

SHORT = SECOND // 20    # ns between two readings in which the rate hardly changes
ENOUGH = 20             # readings at rest, as a multiple of those that were equal, that show the noise of the gyro
MORE = 2                # readings that must be equal, in addition to twice those at rest, if they are not measured
LOST = 1.5              # times the usual time between two readings: in a longer gap, readings were lost


class Reading(NamedTuple):
    """An Imu, and the period to which its rate applies."""

    start: int          # ns; the period extends from here to the stamp
    imu: Imu
    stuck: bool         # whether the gyro does not measure
    changed: float      # variance of the rate because it may change in this period, rad^2/s^2


class Readings:
    """Readings in the order of their stamps."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.last: Imu | None = None        # the latest one
        self.period = 0                     # ns, usual time between two readings; 0: not known
        self.waiting: Deque[Reading] = deque()
        self.equal = 0                      # number of latest readings that are equal to the one before
        self.usually_equal = 0              # the largest such number at rest, where noise makes readings differ
        self.at_rest = 0                    # number of readings at rest

    def add(self, imu: Imu, at_rest: bool = False) -> None:
        """Store a reading that follows the last one. Its rate applies to the time between them, if that is short.

        Readings of a robot in motion that are equal more often than at rest are not measured: the gyro is at its limit,
        or it has failed.

        In a longer time the rate may have been anywhere between the two readings. If readings were also lost in
        between, a rate that changes by at most A per second makes the turn in a time T wrong by at most A T^2 / 4. Both
        errors are assumed to be uniformly distributed.
        """
        last = self.last
        assert last is not None
        changed = 0.0
        self.equal = self.equal + 1 if imu.rate == last.rate else 0
        if at_rest:
            self.at_rest += 1
            self.usually_equal = max(self.usually_equal, self.equal)
        seen = self.at_rest >= ENOUGH * (1 + self.usually_equal)
        stuck = seen and not at_rest and self.equal > 2 * self.usually_equal + MORE
        duration = imu.stamp - last.stamp
        usual = self.period or duration
        self.period = usual + (duration - usual) // 16      # a running mean
        if duration > SHORT and not imu.is_mean:
            rate = (last.rate + imu.rate) / 2
            changed = (imu.rate - last.rate) ** 2 / 12
            if duration > LOST * usual:
                limits = self.limits
                changed += min(limits.max_angular_acceleration * duration / SECOND / 4, limits.max_turn_rate) ** 2 / 3
            imu = imu._replace(rate=rate)
        self.waiting.append(Reading(last.stamp, imu, stuck, changed))

    def turn(self, start: int, end: int, max_rate: float, max_density: float) -> Measurement | None:
        """Return the turn from `start` to `end` (ns), or None if the readings do not cover the whole time.

        The readings are removed. max_rate: largest rate that the gyro can measure, rad/s; max_density: largest noise
        density of the gyro, rad^2/s.
        """
        angle = variance = 0.0
        time, good = start, True
        while self.waiting and time < end:
            begin, imu, stuck, changed = self.waiting[0]
            if imu.stamp > time:
                good = good and begin <= time and abs(imu.rate) < max_rate and not stuck
                stop = min(imu.stamp, end)
                part = (stop - time) / SECOND
                angle += imu.rate * part
                whole = (imu.stamp - begin) / SECOND
                variance += (min(imu.variance, max_density / whole) + changed) * part * whole
                time = stop
            if imu.stamp <= end:
                self.waiting.popleft()
        return (angle, variance) if good and time == end and variance else None


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
