"""The arithmetic of the combined odometry: a Kalman filter of the errors of wheels and gyro, which only looks forward.

The pose turns as the gyro measures, less its bias, and moves as far as the wheels measure. What the filter learns later
never moves the pose. It changes what is applied from then on, the bias, and how uncertain the pose is.

Two measurements show the errors: the gyro's rate at rest, which is the bias, and the difference of both turns over
PERIOD, which depends on bias, slip and curvature. Before the first rest, the bias applies once it is known better than
at the start. The estimated error of the pose is not corrected: its square is part of the covariance.

The covariance P, the variance S of a difference, its derivatives H and the gain K have their usual letters.
"""
from __future__ import annotations

from math import pi, radians, sqrt
from typing import Tuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.filter.gyro_readings import Measurement
from rbx1_nav.filter.pose_errors import BIAS, BIAS_WALK, CURVATURE, INSTABILITY, PERIOD, SLIP, YAW, PoseErrors, Yaw
from rbx1_nav.filter.priors import Bounds, Priors

FIRST_BIAS = 0.05       # 1 sigma of the bias before the first rest / its limit: 0.5 degrees/s, as gyros have after a
#                         calibration at another temperature (surface files: gyro_bias)
KNOWN_BIAS = 0.65       # of FIRST_BIAS: the wheels have shown the bias if it is less uncertain. At a constant speed,
#                         bias and curvature are confused: without this limit, a Husky is 8 m off instead of 3
SKEW = 0.1              # s by which stamps of wheels and gyro may be apart. Without it, a TurtleBot3 in its simulator
#                         is off by 6 degrees instead of 1 (fuse, turtlebot3.bag)
LEAST_MOTION = 0.02     # m and rad in a PERIOD: in a smaller one, the robot is stationary, or somebody carries it.
#                         Without it, the heading of a Jackal is uncertain by 91 degrees instead of 31
ENOUGH_TURN = 0.1       # rad that show whether a gyro turns
TICK = 0.004            # rad: a tick of 1 mm, with a track of 0.25 m, until the odometry reports a smaller turn
ROUNDING = TICK / 4     # rad: 1 sigma of a turn of the odometry; a number that is rounded to ticks has TICK / sqrt(12)
RARE, CLEAR = 3.0, 5.0  # standard deviations of a rare difference, and of a contradiction: 1 of 370, and of 1.7 million
MAX_SLIP = 0.95         # beyond it, the gyro fails. The wheels of a Jackal, a skid-steer, report 7.4 times its turn
#                         (robot_localization, test2.bag: a slip of 0.865)
FIRST_NOISE = 0.25      # weight of the noise of any floor, in measurements of the noise
SMOOTH = 0.1            # noise of the wheels / noise of any floor, below which a steady difference is no slip; 0.05 and
#                         0.2 change none of the tables
MAX_SCALE = 0.1         # a larger error of the scale is none: data sheets of MEMS gyros have 3 % (ADXRS613)
STEADY = radians(1)     # rad/s: a bias changes by less than this from one rest to the next

NOTHING: Tuple[float, ...] = (0.0,) * 5     # s, turn of the wheels and of the gyro with its bias (rad), m, rad^2


class Filter(PoseErrors):
    """What is learned of the errors. Time stamps, dropouts and invalid messages are handled elsewhere."""

    def __init__(self, prior: Priors, pose: Pose, max_bias: float = Bounds().gyro_bias) -> None:
        """pose: initial pose; max_bias: the largest bias of a gyro, rad/s."""
        self.first_bias = FIRST_BIAS * max_bias
        super().__init__(prior, pose, self.first_bias)
        self.rested = False     # whether the bias was learned at rest
        self.gyro_left = False  # whether the gyro is not used, because it does not turn with the wheels
        self.contradicts = False        # whether wheels and gyro differ clearly in the last PERIOD
        self.last_turn = 0.0    # rad, of the wheels in the PERIOD before
        self.noise = FIRST_NOISE, FIRST_NOISE       # of the wheels: sum of measurements / noise of any floor, number
        self._forget()

    def _forget(self) -> None:
        """Begin to compare wheels and gyro, at a start or at a rest."""
        self.doubted = 'gyro' if self.gyro_left else 'nothing'      # what compare() has found last
        self.compared = NOTHING         # in this PERIOD
        self.deviations = 0.0, 0        # sum of the differences since then (standard deviations), and their number
        self.turned = self.lost = 0.0   # rad: turn of the gyro, and how much farther the wheels have turned

    def turn(self, duration: float, wheels: Measurement, gyro: Measurement | None, forward: float = 0.0) -> Yaw:
        """Return the Yaw of a step of `duration` (s): as measured by the gyro, or by the wheels if the gyro has not
        measured it, or so many of its readings are missing that the wheels are more certain."""
        by_gyro = gyro is not None and not self.gyro_left
        if gyro and by_gyro and gyro[1] > ROUNDING ** 2:
            by_gyro = gyro[1] <= self.wheel_variance(wheels, forward) + self.P[SLIP][SLIP] * wheels[0] ** 2
        if gyro and by_gyro:
            return Yaw(gyro[0] - self.bias * duration, gyro[1], True)
        return Yaw(wheels[0] * (1 - self.error[SLIP]) + self.error[CURVATURE] * forward,
                   self.wheel_variance(wheels, forward), False)

    def learn_bias(self, rate: float, variance: float) -> float:
        """Learn the bias from the gyro's mean rate (rad/s) and its variance, because the robot is at rest. Return by
        how much it has changed (rad/s) if it has drifted since the last rest, otherwise 0."""
        self.rest()
        change = rate - self.bias
        drifted = self.rested and change ** 2 > RARE ** 2 * (self.P[BIAS][BIAS] + INSTABILITY ** 2 + variance)
        if self.rested and self.moving > PERIOD:
            # a drift goes on, but not for ever
            self.walk = max(BIAS_WALK ** 2, change ** 2 / self.moving if drifted else self.walk / 2)
        self.update((1.0, 0.0, 0.0), rate - self.error[BIAS], variance)
        self.bias, self.rested, self.moving = self.error[BIAS], True, 0.0
        self._forget()
        return change if drifted else 0.0

    def compare(self, duration: float, wheels: float, gyro: Measurement | None, forward: float) -> str | None:
        """Compare the turns of wheels and gyro after a step, if the gyro has measured all of this PERIOD. Return what
        a complete PERIOD shows: 'gyro', 'bias', 'scale', or '' for nothing; None before its end, or if the robot has
        hardly moved in it. The pose does not change."""
        if not gyro:
            self.compared = NOTHING
            return None
        time, turn, measured, path, variance = self.compared
        self.compared = time + duration, turn + wheels, measured + gyro[0], path + forward, variance + gyro[1]
        if self.compared[0] < PERIOD - 1e-6:
            return None
        (time, wheels, measured, forward, variance), self.compared = self.compared, NOTHING
        change, self.last_turn, self.contradicts = wheels - self.last_turn, wheels, False
        if abs(wheels) + abs(forward) < LEAST_MOTION:
            return None
        turned = measured - self.bias * time
        self.turned += turned
        self.lost += wheels * (1 - self.prior.slip_turning) - turned
        if self.gyro_left and not (abs(wheels) > ENOUGH_TURN and 0.5 < turned / wheels < 2):
            return 'gyro'
        if self.gyro_left:
            self.gyro_left, self.doubted = False, 'nothing'
        self.flush()
        bias, slip, curvature = self.error[3:]
        H = time, -wheels, forward
        difference = measured - bias * time - wheels * (1 - slip) - curvature * forward
        known = 0.0     # not by sum(), which rounds differently from Python 3.12 on
        for row, h in zip(self.P[3:], H):
            for p, other in zip(row[3:], H):
                known += p * h * other
        least = variance + ROUNDING ** 2 + (SKEW / PERIOD * change) ** 2
        turning, straight, _ = self.noises[1]
        floor = turning * abs(wheels) + straight * abs(forward)
        noise = floor * self.noise[0] / self.noise[1] + least
        self.noise = (self.noise[0] + min(RARE ** 2, difference ** 2 / (known + floor + least)), self.noise[1] + 1)
        deviation = difference / sqrt(known + noise)
        self.update(H, difference, noise * max(1.0, (deviation / RARE) ** 2))
        if self.rested or self.P[BIAS][BIAS] < (KNOWN_BIAS * self.first_bias) ** 2:
            self.bias = self.error[BIAS]
        if self.error[SLIP] - MAX_SLIP > sqrt(self.P[SLIP][SLIP]):      # wheels cannot slip so much
            self.leave_gyro()
            return 'gyro'
        self.contradicts = abs(deviation) > CLEAR
        if self.contradicts:    # wheels that spin, or are blocked
            return ''
        return self._test_drift(deviation) or self._test_scale()

    def _test_drift(self, deviation: float) -> str:
        """Test whether the differences since the last rest have one sign. If they do, return 'bias': it has
        drifted steadily, as far as the wheels show if they are right. Slip and curvature are unknown again, and the
        error that the drift has caused is part of the covariance. A difference of more than STEADY is no drift."""
        total, count = self.deviations = self.deviations[0] + deviation, self.deviations[1] + 1
        if not self.rested or total ** 2 < CLEAR ** 2 * count:
            return ''
        self.deviations = 0.0, 0
        self.P[YAW][YAW] += self.lost ** 2
        drift = 2 * self.lost / self.moving    # rad/s: twice the mean
        if abs(drift) < STEADY:
            self.P[BIAS][BIAS] += drift ** 2
            self.walk = max(self.walk, drift ** 2 / self.moving)
            self.forget_wheels()
        return 'bias'

    def _test_scale(self) -> str:
        """Return 'scale' if the gyro's scale, or the track width, is wrong, and widen the scale error."""
        lost, turned = abs(self.lost), abs(self.turned)
        if self.noise[0] > SMOOTH * self.noise[1] or turned < 2 * pi or not (
                RARE * self.scale_error * turned < lost < MAX_SCALE * turned):
            return ''
        self.scale_error = lost / turned
        return 'scale'

    def leave_gyro(self) -> None:
        """Do not use the gyro until it turns with the wheels. What it has shown of the wheels is not known any more."""
        if not self.gyro_left:
            self.gyro_left, self.doubted = True, 'gyro'
            self.doubt_turn(self.lost)
            self.forget_wheels()
