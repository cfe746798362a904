"""The arithmetic of the combined odometry: a planar extended Kalman filter of wheel odometry and a gyro.

Both sensors measure the same turn, each with errors that are constant during a run: the wheels slip by a fraction of
their travel, the gyro has a bias and a scale error. These errors are therefore part of the state, after the pose:

    x, y (m), yaw (rad), gyro bias (rad/s), gyro scale error, slip straight, slip turning (fractions of the travel),
    rounding (m): the error of the encoders' last reported travel, which their next report makes up for

In each step the wheels report a turn W, of which the robot makes W (1 - slip turning), and the gyro's rates add up to
G, which stands for a turn of (G - bias * time) / (1 + scale error). The difference of the two, which should be 0, is a
measurement of the errors. Their mean, weighted by the inverse variances, is the turn. The noise of that mean and the
noise of the difference are uncorrelated (the Gauss-Markov theorem), so using one after the other loses no information
and counts none twice. The rest is the standard filter: Thrun, Burgard and Fox, Probabilistic Robotics, section 3.3.
"""
from collections import namedtuple
from math import cos, inf, radians, sin

import numpy

X, Y, YAW, BIAS, SCALE, STRAIGHT, TURNING, ROUNDING = range(8)

START_VARIANCE = 1e-9       # of the first pose, m^2 and rad^2: the frame begins where the robot does
BIAS_WALK = radians(0.002)  # rad/s per root of a second: random walk of the bias; 0.5 deg/s in 17 hours
OUTLIER = 5.0               # standard deviations between wheels and gyro beyond which one of them must be wrong

Priors = namedtuple('Priors', 'slip_straight slip_straight_spread slip_turning slip_turning_spread '
                              'gyro_bias gyro_scale_error gyro_measurement_range')
Priors.__doc__ = 'What is assumed before the first message; fields of a Surface, in its units.'


def priors(surface):
    """The Priors of a Surface (None: the ideal one)."""
    if surface is None:
        return Priors(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf)
    return Priors(*(getattr(surface, field) for field in Priors._fields))


Turn = namedtuple('Turn', 'angle variance by_bias by_scale by_slip')
Turn.__doc__ = "A turn (rad), its variance (rad^2), its derivatives by the gyro's bias and scale error and the slip."


class Filter:
    """The state and its covariance. Knows nothing of time stamps, dropouts or invalid messages."""

    def __init__(self, prior, pose):
        """prior: Priors; pose: the initial Pose."""
        self.state = [pose.x, pose.y, pose.yaw, 0.0, 0.0, prior.slip_straight, prior.slip_turning, 0.0]
        self.covariance = numpy.diag([START_VARIANCE] * 3 + [
            prior.gyro_bias ** 2, prior.gyro_scale_error ** 2,
            prior.slip_straight_spread ** 2, prior.slip_turning_spread ** 2, 0.0])
        self.outliers = 0   # steps in which wheels and gyro disagreed by more than OUTLIER

    def turn(self, duration, wheels=None, gyro=None):
        """Estimate the Turn of a step of `duration` (s) for move(), and update the errors in the state.

        wheels, gyro: the measured (angle in rad, variance in rad^2), or None. If they disagree by more than OUTLIER,
        the wheels have slipped far more than usual: the gyro is used alone.
        """
        both = self._compare(duration, wheels, gyro) if wheels and gyro else None
        if both:
            return both
        if gyro:
            scale = 1 + self.state[SCALE]
            angle = (gyro[0] - self.state[BIAS] * duration) / scale
            return Turn(angle, gyro[1] / scale ** 2, -duration / scale, -angle / scale, 0.0)
        if wheels:
            grip = 1 - self.state[TURNING]
            return Turn(wheels[0] * grip, wheels[1] * grip ** 2, 0.0, 0.0, -wheels[0])
        return Turn(0.0, 0.0, 0.0, 0.0, 0.0)

    def _compare(self, duration, wheels, gyro):
        """Use the difference as a measurement, then return the mean; None for an outlier."""
        state, covariance = self.state, self.covariance
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        wheel_noise, gyro_noise = wheels[1] * grip ** 2, gyro[1] / scale ** 2
        angle = (gyro[0] - state[BIAS] * duration) / scale
        difference = wheels[0] * grip - angle
        # the slip's derivative uses the gyro's turn: the wheels' turn is rounded to ticks, and noise that is both in a
        # measurement and in its derivative does not average out
        by_bias, by_scale, by_slip = duration / scale, angle / scale, -angle / grip
        columns = by_bias * covariance[BIAS] + by_scale * covariance[SCALE] + by_slip * covariance[TURNING]
        _, _, _, bias, scale_error, _, slip, _ = columns.tolist()
        variance = (by_bias * bias + by_scale * scale_error + by_slip * slip) + wheel_noise + gyro_noise
        if difference ** 2 > OUTLIER ** 2 * variance:
            self.outliers += 1
            return None
        gain = columns / variance
        self.state = [old - change * difference for old, change in zip(state, gain.tolist())]
        covariance -= gain[:, None] * columns

        scale, grip = 1 + self.state[SCALE], 1 - self.state[TURNING]
        angle = (gyro[0] - self.state[BIAS] * duration) / scale
        share = gyro_noise / (gyro_noise + wheel_noise)     # of the wheels
        return Turn(share * wheels[0] * grip + (1 - share) * angle, share * wheel_noise,
                    (share - 1) * duration / scale, (share - 1) * angle / scale, -share * wheels[0])

    def move(self, duration, turn, direction=0.0, forward=0.0, left=0.0, variance=0.0):
        """Predict the state after a step of `duration` (s) with a Turn from turn() and a displacement.

        forward, left: displacement (m) measured by the wheels, in a frame that is rotated by `direction` (rad) against
        the robot's own half way through the turn; variance: of the displacement, m^2.
        """
        angle, noise, by_bias, by_scale, by_slip = turn
        x, y, yaw, bias, scale, straight, turning, rounding = self.state
        middle = yaw + angle / 2 + direction
        c, s = cos(middle), sin(middle)
        grip = 1 - straight
        moved = bool(forward or left)       # the next travel makes up for the rounding
        if moved:
            forward, rounding = forward + rounding, 0.0
        along, across = forward * c - left * s, forward * s + left * c
        self.state = [x + grip * along, y + grip * across, yaw + angle, bias, scale, straight, turning, rounding]

        # derivatives of x and y by the heading half way, which depends on half of the turn
        dx, dy = -grip * across, grip * along
        jacobian = numpy.array([
            [1.0, 0.0, dx, dx / 2 * by_bias, dx / 2 * by_scale, -along, dx / 2 * by_slip, grip * c * moved],
            [0.0, 1.0, dy, dy / 2 * by_bias, dy / 2 * by_scale, -across, dy / 2 * by_slip, grip * s * moved],
            [0.0, 0.0, 1.0, by_bias, by_scale, 0.0, by_slip, 0.0]])
        covariance = self.covariance
        rows = jacobian @ covariance
        pose = rows @ jacobian.T
        rounded = variance / 2 * moved      # a difference of two roundings has twice the variance of one
        if moved:
            rows[:, ROUNDING] = -grip * c * rounded, -grip * s * rounded, 0.0
            covariance[ROUNDING] = 0.0
            covariance[ROUNDING, ROUNDING] = rounded
        covariance[:3] = rows
        covariance[:, :3] = rows.T
        dx, dy, c, s = dx / 2, dy / 2, grip * c, grip * s
        covariance[:3, :3] = pose + numpy.array([
            [dx * dx * noise + c * c * rounded, dx * dy * noise + c * s * rounded, dx * noise],
            [dx * dy * noise + c * s * rounded, dy * dy * noise + s * s * rounded, dy * noise],
            [dx * noise, dy * noise, noise]])
        covariance[BIAS, BIAS] += BIAS_WALK ** 2 * duration
