"""The readings of the gyro that wait for the odometry, and the turn that they measure."""
from __future__ import annotations

from collections import deque
from typing import Deque, NamedTuple

from rbx1_nav.estimation.inputs import Imu
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.model import Measurement
from rbx1_nav.units import SECOND

SHORT = SECOND // 20    # ns between two readings in which the rate hardly changes
LOST = 1.5              # times the usual time between two readings: others between them were lost


class Reading(NamedTuple):
    """An Imu, and the time for which its rate stands."""

    start: int          # ns; the end is its stamp
    imu: Imu
    changed: float      # variance of the rate because it changes in that time, rad^2/s^2
    lost: float         # the same because readings were lost


class Readings:
    """Readings in the order of their stamps."""

    def __init__(self, limits: Limits) -> None:
        self.limits = limits
        self.last: Imu | None = None        # the latest one
        self.period = 0                     # ns, usual time between two of them; 0: not known
        self.waiting: Deque[Reading] = deque()

    def add(self, imu: Imu) -> None:
        """Store a reading that follows the last one. Its rate stands for the time since then, if that is short.

        In a longer time the rate may have been anything between the two. And if readings in between were lost, one that
        changes by at most A in a second makes the turn in a time T wrong by at most A T^2 / 4. Both errors are taken as
        uniformly distributed. The second one is kept apart, because the wheels may have measured the gap.
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
        """The turn in the time from `start` to `end` (ns), None if the readings do not cover all of it; and the
        additional variance because readings were lost, if the whole gap is within that time. The readings are used up.

        max_rate: rad/s, which the gyro can measure; max_density: rad^2/s, a noise density that it does not exceed.
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
