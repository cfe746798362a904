"""Turns of the robot from gyro readings, which wait here until the odometry arrives."""
from __future__ import annotations

from collections import deque
from math import inf
from typing import Deque, NamedTuple, Tuple

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import Imu
from rbx1_nav.filter.priors import Bounds

SHORT = SECOND // 20    # ns between two readings in which the rate hardly changes
ENOUGH = 20             # readings at rest, as a multiple of those that were equal, that show the noise of the gyro
MORE = 2                # readings that must be equal, in addition to twice those at rest, if they are not measured
LOST = 1.5              # times the usual time between two readings: in a longer gap, readings were lost
NOISE_FACTOR = 2.0      # reported / measured noise variance, above which the reported variance is too large
MIN_DENSITY = 7.6e-9    # rad^2/s: 0.005 degrees/s per square root Hz, the noise of a quiet gyro (MPU-6050 data sheet)
MOST = 30000    # readings that wait at most, if there is no odometry: older ones are discarded

Measurement = Tuple[float, float]   # a turn (rad) and its variance (rad^2)


class WaitingReading(NamedTuple):
    """An Imu, and the period to which its rate applies."""

    start: int          # ns; the period extends from here to the stamp
    imu: Imu
    stuck: bool         # whether the gyro does not measure
    changed: float      # variance of the rate because it may change in this period, rad^2/s^2


class Readings:
    """Readings in the order of their stamps."""

    def __init__(self, limits: Bounds) -> None:
        self.limits = limits
        self.last: Imu | None = None        # the latest one
        self.period = 0                     # ns, usual time between two readings; 0: not known
        self.waiting: Deque[WaitingReading] = deque(maxlen=MOST)
        self.equal = 0                      # number of latest readings that are equal to the one before
        self.usually_equal = 0              # the largest such number at rest, where noise makes readings differ
        self.at_rest = 0                    # number of readings at rest
        self.density = 0.0                  # rad^2/s: their noise
        self.dead = True                    # whether all readings were equal

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
        self.dead = self.dead and imu.rate == last.rate
        duration = imu.stamp - last.stamp
        if at_rest:
            self.at_rest += 1
            self.usually_equal = max(self.usually_equal, self.equal)
            sample = (imu.rate - last.rate) ** 2 / 2 * duration / SECOND
            self.density += (sample - self.density) / min(self.at_rest, 1000)
        stuck = (not at_rest and self.equal > 2 * self.usually_equal + MORE
                 and self.at_rest >= ENOUGH * (1 + self.usually_equal))
        usual = self.period or duration
        self.period = usual + (duration - usual) // 16      # a running mean
        if duration > SHORT and not imu.is_mean:
            rate = (last.rate + imu.rate) / 2
            changed = (imu.rate - last.rate) ** 2 / 12
            if duration > LOST * usual:
                limits = self.limits
                changed += min(limits.max_angular_acceleration * duration / SECOND / 4, limits.max_turn_rate) ** 2 / 3
            imu = imu._replace(rate=rate)
        self.waiting.append(WaitingReading(last.stamp, imu, stuck, changed))

    def turn(self, start: int, end: int, max_rate: float) -> Measurement | None:
        """Return the turn from `start` to `end` (ns), or None if the readings do not cover the whole time.

        The readings are removed. max_rate: largest rate that the gyro can measure, rad/s.
        """
        # a reported noise that is far larger than at rest is not believed
        max_density = NOISE_FACTOR * max(self.density, MIN_DENSITY) if self.at_rest >= ENOUGH else inf
        angle = variance = 0.0
        time, good, waiting = start, True, self.waiting
        while waiting and time < end:
            begin, (stamp, rate, reported, _), stuck, changed = waiting[0]
            if stamp > time:
                good = good and begin <= time and abs(rate) < max_rate and not stuck
                stop = min(stamp, end)
                part, whole = (stop - time) / SECOND, (stamp - begin) / SECOND
                angle += rate * part
                variance += (min(reported, max_density / whole) + changed) * part * whole
                time = stop
            if stamp <= end:
                waiting.popleft()
        return (angle, variance) if good and time == end and variance else None
