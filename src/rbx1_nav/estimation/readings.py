"""Stores gyro readings until the odometry arrives, and integrates them into a turn."""
from __future__ import annotations

from collections import deque
from typing import Deque, NamedTuple

from rbx1_nav.estimation.inputs import Imu
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.model import Measurement
from rbx1_nav.units import SECOND

SHORT = SECOND // 20    # ns between two readings in which the rate hardly changes
LOST = 1.5              # times the usual time between two readings: in a longer gap, readings were lost


class Reading(NamedTuple):
    """An Imu, and the period to which its rate applies."""

    start: int          # ns; the period extends from here to the stamp
    imu: Imu
    changed: float      # variance of the rate because it changes in this period, rad^2/s^2
    lost: float         # variance of the rate because readings were lost, rad^2/s^2


class Readings:
    """Readings in the order of their stamps."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.last: Imu | None = None        # the latest one
        self.period = 0                     # ns, usual time between two readings; 0: not known
        self.waiting: Deque[Reading] = deque()

    def add(self, imu: Imu) -> None:
        """Store a reading that follows the last one. Its rate applies to the time between them, if that is short.

        In a longer time the rate may have been anywhere between the two readings. If readings were also lost in
        between, a rate that changes by at most A per second makes the turn in a time T wrong by at most A T^2 / 4. Both
        errors are assumed to be uniformly distributed. The second error is stored separately, because the wheels may
        have measured the gap.
        """
        last = self.last
        assert last is not None
        lost = changed = 0.0
        duration = imu.stamp - last.stamp
        usual = self.period or duration
        self.period = usual + (duration - usual) // 16      # a running mean
        if duration > SHORT:
            rate = imu.rate if imu.is_mean else (last.rate + imu.rate) / 2
            changed = (imu.rate - last.rate) ** 2 / 12
            if duration > LOST * usual:
                limits = self.limits
                lost = min(limits.max_angular_acceleration * duration / SECOND / 4, limits.max_turn_rate) ** 2 / 3
            imu = imu._replace(rate=rate)
        self.waiting.append(Reading(last.stamp, imu, changed, lost))

    def turn(self, start: int, end: int, max_rate: float, max_density: float) -> tuple[Measurement | None, float]:
        """Return the turn from `start` to `end` (ns), and the additional variance because readings were lost.

        The turn is None if the readings do not cover the whole time. The additional variance is returned if the whole
        gap is within this time. The readings are removed. max_rate: largest rate that the gyro can measure, rad/s;
        max_density: largest noise density of the gyro, rad^2/s.
        """
        angle = variance = missing = 0.0
        time, good = start, True
        while self.waiting and time < end:
            begin, imu, changed, lost = self.waiting[0]
            if imu.stamp > time:
                good = good and begin <= time and abs(imu.rate) < max_rate
                stop = min(imu.stamp, end)
                part = (stop - time) / SECOND
                angle += imu.rate * part
                whole = (imu.stamp - begin) / SECOND
                square = part * whole
                variance += (min(imu.variance, max_density / whole) + changed) * square
                if begin == time and stop == imu.stamp:
                    missing += lost * square
                else:
                    variance += lost * square
                time = stop
            if imu.stamp <= end:
                self.waiting.popleft()
        return ((angle, variance), missing) if good and time == end and variance else (None, 0.0)
