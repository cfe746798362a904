"""Standstill: learns the gyro's bias while the wheels are at rest, and detects a robot that is carried.

The wheels are at rest if the odometry pose has not changed for REST. The variances of the odometry are not used,
because many drivers publish constants. The gyro's turns are then summed in parts of PART. There are two cases:

- standstill: the rate of a part is the known bias, or the robot has just been switched on and the rate is steady and
  within the limit. This rate is the bias.
- carried: any other rate. Someone turns the robot by hand: it turns as the gyro measures, and its pose is uncertain.
  A rate that is steady for longer than a hand can hold it is a bias that has changed. If it was steady for a shorter
  time when the robot drives off, the bias is uncertain.
"""
from __future__ import annotations

from math import inf, radians, sqrt
from typing import NamedTuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND, wrap_angle
from rbx1_nav.filter.filter import BIAS, Filter

STANDSTILL, CARRIED = 'standstill', 'carried'

REST = SECOND // 2          # ns for which the pose has not changed
ROUNDING = 1e-6             # s
SAME = 1e-4                 # m and rad: a smaller change is rounding
PART = 0.1                  # s over which the gyro's rate is averaged
STEADY = radians(1)         # rad/s: a bias changes by less than this from one standstill to the next
FIRST_STEADY = 0.2          # s for which a rate must be steady to be the first bias
BIAS_DEVIATIONS = 2.0       # standard deviations by which the bias may have changed
STEADY_DOUBT = 1.0          # s for which another rate must be steady to make the bias uncertain
STEADY_AGAIN = 10.0         # s for which another rate must be steady to be a bias that has changed
DEVIATIONS = 5.0            # standard deviations of the gyro's noise beyond which a difference is not due to chance
MIN_SAMPLES = 10            # differences of rates from which the noise is measured
NOISE_FACTOR = 2.0          # reported / measured noise variance, above which the reported variance is too large
MIN_DENSITY = radians(0.005) ** 2   # rad^2/s: square of the noise density of a quiet MEMS gyro


class Part(NamedTuple):
    """A measurement of the gyro over a period: s, rad, rad^2."""

    time: float = 0.0
    angle: float = 0.0
    variance: float = 0.0

    def plus(self, other: Part) -> Part:
        return Part(self.time + other.time, self.angle + other.angle, self.variance + other.variance)


class Standstill:
    """Watches the odometry and the gyro, and updates the filter while the wheels are at rest."""

    def __init__(self, max_bias: float) -> None:
        """max_bias: rad/s, the largest bias of a gyro."""
        self.max_bias = max_bias
        self.density = 0.0          # rad^2/s, measured noise of the gyro
        self.samples = 0            # number of samples of this noise
        self.max_density = inf      # rad^2/s: the noise of a reading is limited to this value
        self.restart()

    def restart(self) -> None:
        """Wait for the next standstill."""
        self.pose: Pose | None = None       # the pose that does not change
        self._clear()

    def _clear(self) -> None:
        self.case: str | None = None        # STANDSTILL or CARRIED while the wheels are at rest
        self.part = Part()          # the current part
        self.complete: Part | None = None   # the previous part, used if the wheels are still at rest after it
        self.undecided = Part()     # parts with a steady rate that is not known to be the bias
        self.last: Part | None = None       # the last Part that was used

    def follow(self, stamp: int, pose: Pose) -> bool:
        """Store the Pose with this stamp (ns), and return whether the wheels are at rest there."""
        last = self.pose
        if (last is None or abs(pose.x - last.x) > SAME or abs(pose.y - last.y) > SAME
                or abs(wrap_angle(pose.yaw - last.yaw)) > SAME):
            self.pose, self.since = pose, stamp     # since: of the first message with this pose
        return stamp - self.since >= REST

    def leave(self, ekf: Filter) -> Part:
        """Return the Part in which the robot may have begun to move, because the wheels are no longer at rest.

        The Filter has not used this Part.
        """
        unused = self.part.plus(self.complete or Part())
        if ekf.rested and self.undecided.time > STEADY_DOUBT - ROUNDING:
            ekf.doubt_bias(self.undecided.angle / self.undecided.time)
        self._clear()
        return unused

    def add(self, step: Part, ekf: Filter) -> None:
        """Add a step (Part) at rest, and update the Filter with the parts before it."""
        self.case = self.case or STANDSTILL
        if self.complete:
            self._use(self.complete, ekf)
            self.complete = None
        self.part = self.part.plus(step)
        if self.part.time > PART - ROUNDING:
            self.complete, self.part = self.part, Part()

    def _use(self, part: Part, ekf: Filter) -> None:
        """Update the Filter with a Part."""
        rate = part.angle / part.time
        margin = STEADY + DEVIATIONS * sqrt(part.variance) / part.time
        possible = abs(rate) <= self.max_bias
        if ekf.rested and possible and abs(rate - ekf.bias) <= margin + BIAS_DEVIATIONS * ekf.sigma(BIAS):
            self._measure_noise(part, rate)
            self._learn(part, ekf)
            return
        self.last = None
        before, self.undecided = self.undecided, part
        if before.time and abs(rate - before.angle / before.time) <= margin:
            self.undecided = before.plus(part)
        elif before.time and not ekf.rested:
            self._carry(before, ekf)
        if ekf.rested or not possible:
            self._carry(part, ekf)
        if not possible:
            self.undecided = Part()
        elif self.undecided.time >= (STEADY_AGAIN if ekf.rested else FIRST_STEADY) - ROUNDING:
            if ekf.rested:      # no hand has turned the robot
                ekf.carry(ekf.bias * self.undecided.time - self.undecided.angle, 0.0)
                ekf.doubt_bias(self.undecided.angle / self.undecided.time)
            self._learn(self.undecided, ekf)

    def _measure_noise(self, part: Part, rate: float) -> None:
        """Measure the noise from the differences of successive rates, whose variances are angle variance / time^2."""
        if self.last:
            sample = (rate - self.last.angle / self.last.time) ** 2 / (1 / part.time + 1 / self.last.time)
            self.samples += 1
            self.density += (sample - self.density) / min(self.samples, 100)
            if self.samples >= MIN_SAMPLES:
                self.max_density = NOISE_FACTOR * max(self.density, MIN_DENSITY)
        self.last = part

    def _learn(self, part: Part, ekf: Filter) -> None:
        ekf.learn_bias(part.angle / part.time, part.variance / part.time ** 2)
        self.undecided = Part()
        self.case = STANDSTILL

    def _carry(self, part: Part, ekf: Filter) -> None:
        ekf.carry(part.angle - ekf.bias * part.time, part.time)
        self.case = CARRIED
