"""The pose of a robot that reckons its path from turns and distances, and the errors of that pose.

The error of a turn rotates the whole later path about the place of the turn. So the errors of a pose are stored as the
errors of turns about the start: an error d of a turn at (x, y) adds d (y, -x, 1) to them, wherever the robot drives
later. For white noise, bias, slip and curvature these are sums, and a step needs no matrix.

The error vector and its covariance P also contain the bias of the gyro (rad/s), the slip of the wheels in turns (a
fraction of the turn), and the curvature that unequal wheels drive (rad/m), which cause the errors of the pose. Two more
errors are not estimated, and have the spread of the floor: the gyro's scale error, and the slip in straight motion.
"""
from __future__ import annotations

from math import cos, exp, hypot, pi, sin, sqrt
from typing import List, NamedTuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import Covariance
from rbx1_nav.filter.gyro_readings import Measurement
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Priors

X, Y, YAW, BIAS, SLIP, CURVATURE = range(6)     # indices of P

START_VARIANCE = 1e-9   # variance of the first pose, m^2 and rad^2: the frame begins at this pose
INSTABILITY = 3.5e-4    # rad/s: how far the bias is soon from its mean at a rest. 72 degrees/h; gyros of tactical grade
#                         have up to 10, of commercial grade 360 (El-Sheimy and Youssef 2020, table 1)
BIAS_WALK = 1.94e-5     # rad/s after 1 s: random walk of the bias (ADIS16448, in the EuRoC MAV dataset)
PERIOD = 0.5            # s over which the turns of wheels and gyro are compared, and errors of the pose are added up
CARRY_SPEED = 0.5       # m/s: possible speed of the robot (1 sigma) while it is carried


class Yaw(NamedTuple):
    """The turn of a step."""

    angle: float        # rad
    variance: float     # rad^2
    by_gyro: bool       # whether the gyro measured it, or the wheels


class PoseErrors:
    """A pose, its errors, and their covariance."""

    def __init__(self, prior: Priors, pose: Pose, first_bias: float) -> None:
        """pose: initial pose; first_bias: 1 sigma of the bias, rad/s."""
        self.prior = prior
        self.grip = 1 - prior.slip_straight     # distance of the robot / distance of the wheels
        # variances per unit of travel on the assumed floor, and on any floor
        self.noises = [(each.heading_noise_turning ** 2, each.heading_noise_straight ** 2, each.distance_noise ** 2)
                       for each in (prior, UNKNOWN_FLOOR)]
        self.bias = 0.0         # rad/s, applied to the gyro
        self.walk = BIAS_WALK ** 2
        self.scale_error = prior.gyro_scale_error       # 1 sigma
        self.moving = 0.0       # s since the last rest
        self.error = [0.0] * 6
        self.P = [[0.0] * 6 for _ in range(6)]
        self.P[BIAS][BIAS] = first_bias ** 2
        self.place(pose)
        self.forget_wheels()

    def place(self, pose: Pose, covariance: Covariance | None = None) -> None:
        """Set the robot's Pose, with its covariance (m and rad). What is known of the sensors remains."""
        self.start, self.state = pose, pose
        self.reach = 0.0        # m: the largest distance from the start
        self.carried = 0.0      # m: how far the robot may have been carried
        self.doubt = [0.0, 0.0, 0.0]    # errors of the pose if the gyro, or the bias, is not what it seems to be
        # derivatives of the pose with respect to the scale error, and to the bias since the last rest
        self.by_scale, self.by_rest = [0.0] * 3, [0.0] * 3
        self._begin()
        self.error[:3] = 0.0, 0.0, 0.0
        for index in range(3):
            for other in range(6):
                known = covariance[index][other] if covariance is not None and other < 3 else 0.0
                self.P[index][other] = self.P[other][index] = known
            self.P[index][index] += START_VARIANCE

    def _begin(self) -> None:
        """Begin to add up what bias, slip and curvature cause."""
        self.unused = 0.0       # s
        self.by_bias, self.by_slip, self.by_curvature = [0.0] * 3, [0.0] * 3, [0.0] * 3      # derivatives of the pose

    @property
    def covariance(self) -> Covariance:
        """The covariance of x, y (m) and yaw (rad), 3x3."""
        self.flush()
        x, y = self.state.x - self.start.x, self.state.y - self.start.y
        slip = self.prior.slip_straight_spread / self.grip
        (xx, xy, start_x_yaw, *_), (_, yy, start_y_yaw, *_), (_, _, yaw, *_) = self.P[:3]
        for factor, (by_x, by_y, by_yaw) in ((1.0, self.error[:3]), (self.scale_error, self.by_scale),
                                             (INSTABILITY, self.by_rest), (slip, (x, y, 0.0)), (1.0, self.doubt)):
            by_x, by_y, by_yaw = factor * by_x, factor * by_y, factor * by_yaw
            xx, xy, yy = xx + by_x * by_x, xy + by_x * by_y, yy + by_y * by_y
            start_x_yaw, start_y_yaw, yaw = start_x_yaw + by_x * by_yaw, start_y_yaw + by_y * by_yaw, yaw + by_yaw ** 2
        # from errors of a turn about the start to errors at the pose
        x_yaw, y_yaw = start_x_yaw - y * yaw, start_y_yaw + x * yaw
        xx -= y * (start_x_yaw + x_yaw)
        yy += x * (start_y_yaw + y_yaw)
        xy += x * start_x_yaw - y * y_yaw
        # this holds for small errors of the heading: with a large one, the path has turned about its start
        turned = ((1 - exp(-yaw)) * self.reach) ** 2
        known = min(1.0, pi / sqrt(max(yaw, START_VARIANCE)))  # an unknown heading is no more than half a turn off
        x_yaw, y_yaw = known * x_yaw, known * y_yaw
        return ((xx + turned, xy, x_yaw), (xy, yy + turned, y_yaw), (x_yaw, y_yaw, known ** 2 * yaw))

    def sigma(self, index: int) -> float:
        """Return 1 sigma of an error."""
        self.flush()
        unused = self.error[BIAS] - self.bias if index == BIAS else 0.0
        return hypot(sqrt(self.P[index][index]), unused)

    def wheel_variance(self, wheels: Measurement, forward: float) -> float:
        """Return the variance (rad^2) of a turn that the wheels measured over a distance (m): at least the noise of the
        assumed floor, and at most the noise of any floor, because many drivers report constants."""
        (turning, straight, _), (most_turning, most_straight, _) = self.noises
        turned, path = abs(wheels[0]), abs(forward)
        return max(turning * turned + straight * path, min(wheels[1], most_turning * turned + most_straight * path))

    def step(self, duration: float, turn: Yaw, wheels: float = 0.0, forward: float = 0.0, left: float = 0.0,
             reported: float = 0.0) -> None:
        """Make a step of `duration` (s) with a Yaw and a displacement.

        wheels: the turn (rad) that the wheels report; forward, left: displacement (m) in the robot's frame halfway
        through the turn; reported: its variance, m^2.
        """
        (x, y, yaw), (start_x, start_y, _), grip = self.state, self.start, self.grip
        angle, variance, by_gyro = turn
        middle = yaw + angle / 2
        c, s = cos(middle), sin(middle)
        dx, dy = forward * c - left * s, forward * s + left * c
        self.state = Pose(x + grip * dx, y + grip * dy, yaw + angle)
        # the place of the turn, relative to the start
        px, py = x + grip * dx / 2 - start_x, y + grip * dy / 2 - start_y
        if px * px + py * py > self.reach * self.reach:
            self.reach = hypot(px, py)
        if by_gyro:
            _add(self.by_bias, -duration, px, py)
            _add(self.by_scale, angle, px, py)
        else:
            _add(self.by_slip, -wheels, px, py)
            _add(self.by_curvature, forward, px, py)
        x_row, y_row, yaw_row, bias_row, _, _ = self.P      # only the upper triangle
        if forward or left:
            path, ((*_, least), (*_, most)) = abs(forward) + abs(left), self.noises
            length = grip ** 2 * max(least * path, min(reported, most * path))
            x_row[X] += length * c * c
            x_row[Y] += length * c * s
            y_row[Y] += length * s * s
        if variance:
            by_x, by_y = variance * py, -variance * px
            x_row[X] += by_x * py
            x_row[Y] -= by_x * px
            y_row[Y] -= by_y * px
            x_row[YAW] += by_x
            y_row[YAW] += by_y
            yaw_row[YAW] += variance
        bias_row[BIAS] += self.walk * duration
        self.moving += duration
        self.unused += duration
        if self.unused > PERIOD:    # before the bias has walked far
            self.flush()

    def flush(self) -> None:
        """Add to the errors of the pose what bias, slip and curvature have caused since the last time."""
        P, error = self.P, self.error
        P[Y][X], P[YAW][X], P[YAW][Y] = P[X][Y], P[X][YAW], P[Y][YAW]
        if not self.unused:
            return
        for i, part in enumerate(self.by_bias):
            self.by_rest[i] += part
            error[i] += part * (error[BIAS] - self.bias)
        for cause, parts in (BIAS, self.by_bias), (SLIP, self.by_slip), (CURVATURE, self.by_curvature):
            if any(parts):
                by_x, by_y, by_yaw = parts
                for i, part in enumerate(parts):        # P = F P F', first the rows, then the columns
                    P[i] = [value + part * other for value, other in zip(P[i], P[cause])]
                for row in P:
                    by_cause = row[cause]
                    row[X] += by_x * by_cause
                    row[Y] += by_y * by_cause
                    row[YAW] += by_yaw * by_cause
        self._begin()

    def doubt_bias(self, rate: float) -> None:
        """Make the bias uncertain: the wheels were at rest, and a steady rate (rad/s) of the gyro may be the bias."""
        self.P[BIAS][BIAS] += (rate - self.bias) ** 2

    def rest(self) -> None:
        """Begin a rest: at the next one, the bias will be another, by INSTABILITY."""
        self.flush()
        for row, one in zip(self.P, self.by_rest):
            for j, other in enumerate(self.by_rest):
                row[j] += INSTABILITY ** 2 * one * other
        self.by_rest = [0.0, 0.0, 0.0]

    def forget_wheels(self) -> None:
        """Begin to learn slip and curvature again."""
        self.flush()
        prior = self.prior
        for index, value, spread in ((SLIP, prior.slip_turning, prior.slip_turning_spread),
                                     (CURVATURE, prior.curvature, prior.curvature_spread)):
            self.error[index] = value
            for other in range(6):
                self.P[index][other] = self.P[other][index] = 0.0
            self.P[index][index] = spread ** 2

    def doubt_turn(self, angle: float) -> None:
        """Allow for a turn (rad) here, which may have been none."""
        _add(self.doubt, angle, self.state.x - self.start.x, self.state.y - self.start.y)

    def carry(self, duration: float) -> None:
        """Allow for a robot that has moved for a duration (s) with its wheels at rest."""
        before, self.carried = self.carried, self.carried + CARRY_SPEED * duration
        for index in X, Y:
            self.P[index][index] += self.carried ** 2 - before ** 2

    def update(self, H: tuple[float, ...], difference: float, variance: float) -> None:
        """Update the errors with a measurement of H (derivatives with respect to bias, slip, curvature) that differs
        from what is expected."""
        by_bias, by_slip, by_curvature = H
        PH = [row[BIAS] * by_bias + row[SLIP] * by_slip + row[CURVATURE] * by_curvature for row in self.P]
        S = variance + (PH[BIAS] * by_bias + PH[SLIP] * by_slip + PH[CURVATURE] * by_curvature)
        for i, one in enumerate(PH):
            self.error[i] += one / S * difference
            self.P[i] = [value - one * other / S for value, other in zip(self.P[i], PH)]


def _add(errors: List[float], angle: float, x: float, y: float) -> None:
    """Add the error of a turn (rad) at a place, relative to the start."""
    errors[0] += angle * y
    errors[1] -= angle * x
    errors[2] += angle
