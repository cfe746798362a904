"""The arithmetic of the combined odometry: a planar extended Kalman filter of wheel odometry and a gyro.

The gyro measures how the robot turns, and the wheels measure how far it moves. The wheels measure the turn only if the
gyro cannot (gyro_readings.py).

- The state is the pose x, y (m), yaw (rad), the bias of the gyro (rad/s), and the curvature that unequal wheels drive
  (rad/m). The bias is learned at rest (standstill.py). Until the first rest it is 0, with the uncertainty of any gyro.
- Three more errors are considered, but not estimated: the gyro's scale error, and the slip of the wheels in turns and
  in straight motion (fractions of the travel). They have the mean and the spread of the floor (priors.py), and widen
  the covariance of the state (Schmidt, Application of state-space methods to navigation problems, 1966; Brown and
  Hwang, Introduction to Random Signals and Applied Kalman Filtering, section 5.9).
- The turns of wheels and gyro are compared in windows (a chi-square test). After a rest, their difference in straight
  motion, where slip hardly matters, is a measurement of curvature and bias.
- When they differ by more than all of these errors allow, the slip of the wheels has grown, if that is possible; or the
  bias has drifted, if the motion was straight. Otherwise, the heading is in doubt until both agree again.

The covariance P, the derivatives F of the errors after a step, a square root G of its noise, the variance S of a
difference and the gain K have their usual letters.
"""
from __future__ import annotations

from math import cos, exp, hypot, pi, radians, sin, sqrt
from typing import NamedTuple, Tuple

import numpy

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import Array
from rbx1_nav.filter.gyro_readings import WINDOW_TIME, WINDOW_TURN, Measurement, Sums, Window
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Priors, Bounds

# indices of P; the state has the first five. WINDOW: the difference of both turns in the window
X, Y, YAW, BIAS, CURVATURE, SCALE, SLIP_TURNING, SLIP_STRAIGHT, WINDOW = range(9)
IDENTITY = numpy.eye(9)

START_VARIANCE = 1e-9       # variance of the first pose, m^2 and rad^2: the frame begins at this pose
FIRST_BIAS = 0.1            # 1 sigma of the bias before the first rest / its limit
BIAS_WALK = radians(0.001)  # rad/s after 1 s: random walk of the bias; 0.06 degrees/s in an hour
CARRY_SPEED = 0.5           # m/s: possible speed of the robot (1 sigma) while it is carried
ROUNDING = 0.005            # rad: 1 sigma of a turn in odometry that is rounded to whole degrees
MAX_DRIFT = radians(1)      # rad/s: a larger difference in a window is no drift of the bias
RARE, IMPROBABLE = 3.0 ** 2, 5.0 ** 2       # chi-square, one degree of freedom: 1 of 370, and 1 of 1.7 million
POSSIBLE_SLIP = -0.3, 0.7   # a skid-steer that turns three times as far as its wheels report, or less
FADE = 0.85                 # fraction of a doubt, or of too large a slip, that remains when wheels and gyro agree
LEAST_SLIP = 0.05           # 1 sigma of the slip in turns, however well wheels and gyro agree
HALF_TRACK = 0.2            # m: half the distance of the wheels of a robot of medium size

Verdict = Tuple[Sums, str]  # 'imu_data', 'wheels' or 'both' (one of them) is doubted, or '' if they agree


class Yaw(NamedTuple):
    """The turn of a step, and its derivatives with respect to BIAS, CURVATURE, SCALE and SLIP_TURNING."""

    angle: float        # rad
    variance: float     # rad^2
    by_errors: tuple[float, float, float, float]
    compared: Sums | None = None    # with the turn of the wheels, if this is the gyro's turn


class Filter:
    """The state and its covariance. Time stamps, dropouts and invalid messages are handled elsewhere."""

    def __init__(self, prior: Priors, pose: Pose, max_bias: float = Bounds().gyro_bias) -> None:
        """pose: initial pose; max_bias: the largest bias of a gyro, rad/s."""
        self.prior = prior
        # variances per unit of travel on the assumed floor, and on any floor
        self.noises = [(each.heading_noise_turning ** 2, each.heading_noise_straight ** 2, each.distance_noise ** 2)
                       for each in (prior, UNKNOWN_FLOOR)]
        self.state = [*pose, 0.0, prior.curvature]
        self.P: Array = numpy.diag([START_VARIANCE] * 3 + [
            (FIRST_BIAS * max_bias) ** 2, prior.curvature_spread ** 2, prior.gyro_scale_error ** 2,
            prior.slip_turning_spread ** 2, prior.slip_straight_spread ** 2, 0.0])
        # the errors that a bias would have caused if it had drifted by 1 rad/s^2 since the last rest
        self.drift = numpy.zeros(9)
        self.rested = False     # whether the bias was learned at rest
        self.moving = 0.0       # s since the last rest
        self.walk = BIAS_WALK ** 2      # rad^2/s^3: variance of the bias per s of motion
        self._start_window()
        self.place(pose)

    @property
    def covariance(self) -> Array:
        """The covariance of x, y (m) and yaw (rad), 3x3."""
        x, y, yaw = self.doubt
        (xx, xy, x_yaw, *_), (_, yy, y_yaw, *_), (_, _, yaw_yaw, *_) = self.P[:3].tolist()
        yaw_yaw += yaw * yaw
        # the derivatives hold for small errors of the heading: with a large one, the path has turned about its start
        turned = ((1 - exp(-yaw_yaw)) * self.reach) ** 2
        known = min(1.0, pi / sqrt(yaw_yaw))    # an unknown heading is no more than half a turn off
        xy, x_yaw, y_yaw = xy + x * y, known * (x_yaw + x * yaw), known * (y_yaw + y * yaw)
        return numpy.array([[xx + x * x + turned, xy, x_yaw], [xy, yy + y * y + turned, y_yaw],
                            [x_yaw, y_yaw, known ** 2 * yaw_yaw]])

    @property
    def bias(self) -> float:
        """The bias of the gyro, rad/s."""
        return self.state[BIAS]

    def sigma(self, index: int) -> float:
        """Return 1 sigma of an error."""
        return sqrt(max(0.0, float(self.P[index, index])))

    def place(self, pose: Pose, covariance: Array = numpy.zeros((3, 3))) -> None:
        """Set the robot's Pose, with its covariance (3x3; m and rad). What is known of the sensors remains."""
        self.state[:3] = pose
        self.start, self.reach = pose, 0.0      # the last known pose, and the largest distance from it, m
        self.carried = 0.0      # m: how far the robot may have been carried
        self.doubt = [0.0, 0.0, 0.0]    # error of x, y (m) and yaw (rad) if the gyro was wrong
        self.P[:3] = self.P[:, :3] = 0.0
        values, vectors = numpy.linalg.eigh(covariance)
        self.P[:3, :3] = vectors * numpy.maximum(values, START_VARIANCE) @ vectors.T
        self.drift[:3] = 0.0

    # steps

    def wheel_variance(self, wheels: Measurement, forward: float) -> float:
        """Return the variance (rad^2) of a turn that the wheels measured over a distance (m): at least the noise of the
        assumed floor, and at most the noise of any floor, because many drivers report constants."""
        (turning, straight, _), (most_turning, most_straight, _) = self.noises
        turned, path = abs(wheels[0]), abs(forward)
        return max(turning * turned + straight * path, min(wheels[1], most_turning * turned + most_straight * path))

    def turn(self, duration: float, wheels: Measurement | None, gyro: Measurement | None, forward: float = 0.0) -> Yaw:
        """Return the Yaw of a step of `duration` (s): as measured by the gyro, or by the wheels if the gyro has not
        measured it, or so many of its readings are missing that the wheels are more certain."""
        compared = by_wheels = None
        if wheels:
            angle = wheels[0] * (1 - self.prior.slip_turning) + self.state[CURVATURE] * forward
            by_wheels = Yaw(angle, self.wheel_variance(wheels, forward), (0.0, forward, 0.0, -wheels[0]))
        if gyro:
            angle = gyro[0] - self.bias * duration
            if by_wheels and wheels:
                if gyro[1] > max(ROUNDING ** 2, by_wheels.variance + (self.sigma(SLIP_TURNING) * wheels[0]) ** 2):
                    return by_wheels
                if duration < WINDOW_TIME:      # a longer step is no part of a window
                    compared = Sums(duration, wheels[0], by_wheels.angle, angle, forward, by_wheels.variance)
            return Yaw(angle, gyro[1], (-duration, 0.0, -angle, 0.0), compared)
        return by_wheels or Yaw(0.0, 0.0, (0.0, 0.0, 0.0, 0.0))

    def step(self, duration: float, turn: Yaw, direction: float = 0.0, forward: float = 0.0, left: float = 0.0,
             reported: float = 0.0) -> None:
        """Make a step of `duration` (s) with a Yaw and a displacement.

        forward, left: displacement (m) measured by the wheels, in a frame that is rotated by `direction` (rad) relative
        to the robot's own frame halfway through the turn; reported: its variance, m^2.
        """
        x, y, yaw = self.state[:3]
        middle = yaw + turn.angle / 2 + direction
        c, s = cos(middle), sin(middle)
        grip = 1 - self.prior.slip_straight
        along, across = forward * c - left * s, forward * s + left * c
        self.state[:3] = x + grip * along, y + grip * across, yaw + turn.angle
        # the derivatives with respect to the heading halfway, which depends on half of the turn
        by_x, by_y = -grip * across, grip * along
        half_x, half_y = by_x / 2, by_y / 2
        by_bias, by_curvature, by_scale, by_slip = turn.by_errors
        F = IDENTITY.copy()
        F[X, YAW:WINDOW] = by_x, half_x * by_bias, half_x * by_curvature, half_x * by_scale, half_x * by_slip, -along
        F[Y, YAW:WINDOW] = by_y, half_y * by_bias, half_y * by_curvature, half_y * by_scale, half_y * by_slip, -across
        F[YAW, BIAS:SLIP_STRAIGHT] = turn.by_errors
        if turn.compared:
            F[WINDOW, BIAS:SLIP_STRAIGHT] = duration, forward, turn.angle, -turn.compared.wheels
            self.window.add(turn.compared)
        self.drift = F.dot(self.drift)      # dot() takes half as long as @ for matrices this small
        self.drift[BIAS] += duration
        # the noise of the turn, and of the distance, with the same limits as in wheel_variance()
        path, ((*_, least), (*_, most)) = abs(forward) + abs(left), self.noises
        noise, length = sqrt(turn.variance), grip * sqrt(max(least * path, min(reported, most * path)))
        G = numpy.array([[half_x * noise, half_y * noise, noise, 0.0, 0.0, 0.0, 0.0, 0.0,
                          -noise if turn.compared else 0.0],
                         [length * c, length * s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
        self.P = F.dot(self.P).dot(F.T) + G.T.dot(G)
        self.P[BIAS, BIAS] += self.walk * duration
        x, y, doubt = self.doubt
        self.doubt = [x + by_x * doubt, y + by_y * doubt, doubt]
        self.moving += duration
        self.reach = max(self.reach, hypot(self.state[X] - self.start.x, self.state[Y] - self.start.y))

    def _scale(self, index: int, factor: float) -> None:
        """Multiply the deviation of one error by a factor."""
        self.P[index] *= factor
        self.P[:, index] *= factor

    # measurements

    def learn_bias(self, rate: float, variance: float) -> None:
        """Learn the bias from the gyro's mean rate (rad/s) and its variance, because the robot is at rest; correct the
        heading and the position by what the bias has caused."""
        innovation = rate - self.bias
        if self.rested and self.moving:
            self.walk = max(BIAS_WALK ** 2, self.walk / 2)      # a drift goes on, but not for ever
            if innovation ** 2 > RARE * (self.P[BIAS, BIAS] + variance):
                self._doubt_drift(innovation / self.moving)
        self._update(BIAS, innovation, variance, self.P[BIAS])
        if not self.rested:     # the window has begun with another bias
            self._start_window()
        self.rested, self.moving = True, 0.0
        self.drift = numpy.zeros(9)

    def _update(self, index: int, innovation: float, variance: float, correlated: Array) -> None:
        """Update the state with a measured error (its index in P), the variance of the measurement, and the covariances
        of all errors with it."""
        K = correlated / (self.P[index, index] + variance)
        K[SCALE:] = 0.0     # these are considered only
        self.state = [old + gain * innovation for old, gain in zip(self.state, K.tolist())]
        A = numpy.eye(9)
        A[:, index] -= K    # Joseph's form holds for any gain
        self.P = A @ self.P @ A.T + variance * K[:, None] * K
        self.drift = A @ self.drift

    def doubt_bias(self, rate: float) -> None:
        """Make the bias uncertain: the wheels were at rest, and a steady rate (rad/s) of the gyro may be the bias."""
        self.P[BIAS, BIAS] += (rate - self.bias) ** 2

    def _doubt_drift(self, rate: float) -> None:
        """Allow for a bias that has drifted at a rate (rad/s^2) since the last rest, and still may."""
        self.P += rate ** 2 * self.drift[:, None] * self.drift
        self.walk = max(self.walk, rate ** 2 * self.moving)

    def carry(self, angle: float, duration: float) -> None:
        """Turn the robot by an angle (rad), measured in `duration` (s) with the wheels at rest; it may have moved."""
        self.state[YAW] += angle
        before, self.carried = self.carried, self.carried + CARRY_SPEED * duration
        self._move_by(self.carried ** 2 - before ** 2)

    def _move_by(self, variance: float) -> None:
        """Make the position uncertain by a variance, m^2."""
        self.P[X, X] += variance
        self.P[Y, Y] += variance

    def _start_window(self) -> None:
        self.window = Window()
        self.P[WINDOW] = self.P[:, WINDOW] = self.drift[WINDOW] = 0.0

    def close_window(self) -> Verdict | None:
        """If the window is complete, compare the turns of wheels and gyro, change the errors that may explain a
        difference, and return the Verdict."""
        sums = self.window.close()
        if not sums:
            return None
        doubted = self._judge(sums)
        self._start_window()
        return sums, doubted

    def _learn_difference(self, sums: Sums, variance: float, drift: float = 0.0) -> None:
        """Learn the curvature from straight motion; if the bias drifts, also the bias, and correct the pose by what it
        has caused. drift: rate at which the bias may have drifted since the last rest, rad/s^2.
        """
        # slip and scale matter little here, and would move the pose by what wheels have caused that replaced the gyro
        correlated = self.P[WINDOW] + sums.wheels * self.P[SLIP_TURNING] - sums.gyro * self.P[SCALE]
        correlated[:3] -= sums.forward * self.P[:3, CURVATURE]
        if self.walk <= BIAS_WALK ** 2:
            correlated[:CURVATURE] = 0.0    # the last rest shows the bias better
        correlated += drift ** 2 * self.drift[WINDOW] * self.drift
        self._doubt_drift(drift)
        self._update(WINDOW, sums.gyro - sums.expected, variance, correlated)

    def _judge(self, sums: Sums) -> str:
        """Let the error grow that may be the reason for a difference, or shrink; return which sensor is doubted."""
        difference = sums.gyro - sums.expected
        # in straight motion, the slip matters less than the curvature; both can be told from a known bias
        straight = self.rested and (
            self.prior.slip_turning_spread * sums.turned < self.prior.curvature_spread * abs(sums.forward))
        # the scatter of slip in turns is no noise
        variance = min(sums.scatter, sums.variance) if straight else sums.variance + ROUNDING ** 2
        S = float(self.P[WINDOW, WINDOW]) + variance
        without_slip = max(variance, S - (self.sigma(SLIP_TURNING) * sums.wheels) ** 2)
        # the turns that are possible with any slip
        low, high = sorted(sums.expected - sums.wheels * slip for slip in POSSIBLE_SLIP)
        beyond = max(low - sums.gyro, sums.gyro - high, 0.0)
        limit = IMPROBABLE if straight else RARE    # because a drift is corrected
        if beyond ** 2 > limit * without_slip:
            # whether a drift since the rest has little effect: the window began before it, or the speed has changed
            small = self.drift[WINDOW] < sums.time ** 2 / 4
            if not straight or small or abs(difference) > MAX_DRIFT * sums.time:
                self.doubt[YAW] += abs(difference)
                return 'both'
            before = self.state[CURVATURE]
            self._learn_difference(sums, variance, difference / self.drift[WINDOW])
            # at a constant speed, no more drift and as much more curvature would have been the same
            error = numpy.zeros(9)
            error[CURVATURE] = (self.state[CURVATURE] - before) / 2
            error[BIAS] = -error[CURVATURE] * sums.forward / sums.time
            self.P += error[:, None] * error
            return 'imu_data'
        if straight:
            self._learn_difference(sums, variance)
        measured = abs(sums.wheels) > WINDOW_TURN / 2
        slip = max(LEAST_SLIP, abs(difference / sums.wheels)) if measured else self.prior.slip_turning_spread
        if difference ** 2 > IMPROBABLE * S:
            self._scale(SLIP_TURNING, max(1.0, slip / self.sigma(SLIP_TURNING)))
            self._move_by((HALF_TRACK * difference) ** 2)   # as if only one of the wheels slipped
            self._scale(SLIP_STRAIGHT, max(1.0, UNKNOWN_FLOOR.slip_straight_spread / self.sigma(SLIP_STRAIGHT)))
            return 'wheels'
        self.doubt = [FADE * each for each in self.doubt]
        if measured:
            self._scale(SLIP_TURNING, min(1.0, max(FADE, slip / self.sigma(SLIP_TURNING))))
        return ''
