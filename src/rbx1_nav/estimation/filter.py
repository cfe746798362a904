"""The arithmetic of the combined odometry: a planar extended Kalman filter of wheel odometry and a gyro.

Both sensors measure the same turn. The wheels slip by a fraction of their travel, which changes on the way; the gyro
has a bias and a scale error. These errors are part of the state, after the pose:

    x, y (m), yaw (rad), gyro bias (rad/s), gyro scale error, slip turning, slip straight (fractions of the travel)

In each step the wheels report a turn W, of which the robot makes W (1 - slip turning), and the gyro's rates add up to
G, which stands for a turn of (G - bias * time) / (1 + scale error). The difference of the two, which should be 0, is a
measurement of the errors. Their mean, weighted by the inverse variances, is the turn. The noise of that mean and the
noise of the difference are uncorrelated (the Gauss-Markov theorem), so using one after the other loses no information
and counts none twice. This also holds for the sum of the differences of several steps, and that sum is what is used: a
single step's turn by the wheels may be coarsely rounded. The rest is the standard filter: Thrun, Burgard and Fox,
Probabilistic Robotics, section 3.3.

The covariance is kept as a root, a matrix whose product with its own transpose it is: so it has no negative eigenvalue,
whatever is measured. A measurement changes the root as in Potter's filter (Maybeck, Stochastic Models, Estimation, and
Control, volume 1, 1979, section 7.3). Noise adds columns to it; a QR decomposition makes it square again.
"""
from collections import namedtuple
from math import cos, inf, radians, sin, sqrt

import numpy

from rbx1_nav.estimation.agreement import Agreement
from rbx1_nav.units import clamp

X, Y, YAW, BIAS, SCALE, TURNING, STRAIGHT = range(7)

START_VARIANCE = 1e-9       # of the first pose, m^2 and rad^2: the frame begins where the robot does
BIAS_WALK = radians(0.002)  # rad/s per root of a second: random walk of the bias; 0.5 deg/s in 17 hours
SLIP_WALK = 0.02            # per root of a radian, or of a metre: random walk of the slip
OUTLIER = 5.0               # standard deviations between wheels and gyro beyond which one of them must be wrong
MAX_ERROR = 0.5             # of slip and scale error: beyond it something else is wrong
PART_TURN, PART_TIME = 0.2, 1.0     # rad, s: turn and time over which the differences of wheels and gyro are added up
STEADY = 0.5                # variance of the gyro's turn over a gap at a steady rate / variance of the wheels' turn

# no gyro is better, whatever a floor's file says: 1 sigma of the bias (rad/s) and of the scale error
MIN_BIAS, MIN_SCALE_ERROR = radians(0.5), 0.003
# no floor is known better than that from its file: 1 sigma of the slip
MIN_SPREAD_TURNING, MIN_SPREAD_STRAIGHT = 0.05, 0.02

Priors = namedtuple('Priors', 'slip_straight slip_straight_spread slip_turning slip_turning_spread '
                              'gyro_bias gyro_scale_error gyro_measurement_range '
                              'heading_noise_turning heading_noise_straight distance_noise')
Priors.__doc__ = 'What is assumed before the first message; fields of a Surface, in its units.'

# any floor. The noise is that of five real robots, config/surfaces/create_lab_floor.yaml; the spreads are as wide as
# the slips of all files are apart
UNKNOWN = Priors(0.0, 0.05, 0.0, 0.05, MIN_BIAS, MIN_SCALE_ERROR, radians(150), 0.084, 0.066, 0.044)


def priors(surface):
    """The Priors of a Surface (None: the ideal one)."""
    if surface is None:
        return Priors(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inf, 0.0, 0.0, 0.0)
    return Priors(*(getattr(surface, field) for field in Priors._fields))


Turn = namedtuple('Turn', 'angle variance by_bias by_scale by_slip')
Turn.__doc__ = "A turn (rad), its variance (rad^2), its derivatives by the gyro's bias and scale error and the slip."

SPARE = 32      # columns of the root for noise, before it is made square again


class Filter:
    """The state and its covariance. Knows nothing of time stamps, dropouts or invalid messages."""

    def __init__(self, prior, pose):
        """prior: Priors; pose: the initial Pose."""
        self.prior = prior
        self.state = [pose.x, pose.y, pose.yaw, 0.0, 0.0, prior.slip_turning, prior.slip_straight]
        self.root = numpy.zeros((7, 7 + SPARE))
        self.root[range(7), range(7)] = [sqrt(START_VARIANCE)] * 3 + [
            max(prior.gyro_bias, MIN_BIAS), max(prior.gyro_scale_error, MIN_SCALE_ERROR),
            max(prior.slip_turning_spread, MIN_SPREAD_TURNING), max(prior.slip_straight_spread, MIN_SPREAD_STRAIGHT)]
        self.used = 7               # columns of the root
        self.walked = [0.0] * 3     # s, rad, m since the root was square
        self.part = None            # sums of the steps whose difference has not been used yet, see _use()
        self.agreement = Agreement()
        self.doubt = 0.0            # rad: the sum of what wheels and gyro have contradicted each other by

    @property
    def covariance(self):
        """Of x, y (m) and yaw (rad), 3x3."""
        pose = self.root[:3]
        return pose @ pose.T

    def turn(self, duration, wheels=None, gyro=None, travelled=0.0, missing=0.0):
        """Estimate the Turn of a step of `duration` (s) for move(), and update the errors in the state.

        wheels, gyro: the measured (angle in rad, variance in rad^2), or None; travelled: m, by the wheels; missing:
        additional variance (rad^2) of the gyro's turn because readings are missing within this step. If wheels and gyro
        disagree by more than OUTLIER, the wheels have slipped far more than usual: the gyro is used alone.
        """
        if wheels:
            prior, (angle, variance) = self.prior, wheels
            wheels = angle, max(variance, prior.heading_noise_turning ** 2 * abs(angle)
                                + prior.heading_noise_straight ** 2 * travelled)
        both = self._compare(duration, wheels, gyro, missing) if wheels and gyro else None
        if both:
            return both
        if gyro:
            scale = 1 + self.state[SCALE]
            angle = (gyro[0] - self.state[BIAS] * duration) / scale
            return Turn(angle, (gyro[1] + missing) / scale ** 2, -duration / scale, -angle / scale, 0.0)
        if wheels:
            grip = 1 - self.state[TURNING]
            return Turn(wheels[0] * grip, wheels[1] * grip ** 2, 0.0, 0.0, -wheels[0])
        return Turn(0.0, 0.0, 0.0, 0.0, 0.0)

    def doubt_floor(self):
        """If wheels and gyro show a slip that the prior's floor does not have, the straight slip, which nothing
        measures, becomes as uncertain as on an unknown floor. Returns whether that is so."""
        if not self.agreement.difference(self.prior, self._bias_variance):
            return False
        self._add_noise(STRAIGHT, UNKNOWN.slip_straight_spread)
        return True

    def doubt_heading(self):
        """If wheels and gyro differ more than on any floor, one of them is wrong: the heading becomes as uncertain as
        they differ, and they are compared anew. Returns the angle (rad), or 0."""
        difference = self.agreement.difference(UNKNOWN, self._bias_variance)
        if difference:
            before, self.doubt = self.doubt, self.doubt + abs(difference)
            self._add_noise(YAW, sqrt(self.doubt ** 2 - before ** 2))
            self.agreement = Agreement()
        return difference

    @property
    def _bias_variance(self):
        return float(self.root[BIAS] @ self.root[BIAS])

    def _add_noise(self, index, deviation):
        """Make one of the state more uncertain."""
        self.root[index, self.used] = deviation
        self._use_columns(1)

    def _compare(self, duration, wheels, gyro, missing):
        """Add the step to the part, use the part when it is complete, and return the mean; None for an outlier."""
        alone = missing or gyro[1] > wheels[1]      # its noise would hide what the other steps have measured
        if alone and self.part:
            self._use(self.part)
            self.part = None
        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        difference = wheels[0] * grip - (gyro[0] - state[BIAS] * duration) / scale
        if missing:
            # if the rate changed while it was not read, the two turns differ by as much as the gyro's is wrong
            gyro = gyro[0], gyro[1] + min(missing, STEADY * wheels[1] + difference ** 2)
        noise = wheels[1] * grip ** 2 + gyro[1] / scale ** 2
        if difference ** 2 > OUTLIER ** 2 * noise:      # rare: the errors in the state count too
            spread = self._spread(duration, wheels[0], gyro[0])
            if difference ** 2 > OUTLIER ** 2 * (noise + float(spread @ spread)):
                return None
        step = (duration, *wheels, *gyro)
        if alone:
            self._use(step)
        else:
            part = self.part = tuple(map(sum, zip(self.part, step))) if self.part else step
            if part[0] > PART_TIME or abs(part[1]) > PART_TURN or abs(part[3]) > PART_TURN:
                self._use(part)
                self.part = None

        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        angle = (gyro[0] - state[BIAS] * duration) / scale
        wheel_noise, gyro_noise = wheels[1] * grip ** 2, gyro[1] / scale ** 2
        share = gyro_noise / (wheel_noise + gyro_noise)     # of the wheels
        return Turn(share * wheels[0] * grip + (1 - share) * angle, share * wheel_noise,
                    (share - 1) * duration / scale, (share - 1) * angle / scale, -share * wheels[0])

    def _spread(self, duration, wheels, gyro):
        """The derivatives of the difference of two turns (rad) by the errors in the state, multiplied by their root."""
        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        # noise that is both in a measurement and in its derivative does not average out. So the slip's derivative uses
        # the gyro's turn, since the wheels' is rounded to ticks; where the wheels stand, the gyro's turn is all noise
        turned = (gyro - state[BIAS] * duration) / scale if wheels else 0.0
        return numpy.array([duration / scale, turned / scale, -turned / grip]) @ self.root[BIAS:STRAIGHT]

    def _use(self, part):
        """Use the difference of wheels and gyro as a measurement of the errors.

        part: s, turn by the wheels (rad) and its variance, turn by the gyro (rad) and its variance.
        """
        duration, wheels, wheel_variance, gyro, gyro_variance = part
        spread = self._spread(duration, wheels, gyro)
        state, root = self.state, self.root
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        difference = wheels * grip - (gyro - state[BIAS] * duration) / scale
        noise = wheel_variance * grip ** 2 + gyro_variance / scale ** 2
        variance = float(spread @ spread) + noise
        gain = root @ spread / variance
        root -= (gain / (1 + sqrt(noise / variance)))[:, None] * spread
        state = [old - change * difference for old, change in zip(state, gain.tolist())]
        for index in SCALE, TURNING:
            state[index] = clamp(state[index], MAX_ERROR)
        self.state = state

    def move(self, duration, turn, direction=0.0, forward=0.0, left=0.0, variance=0.0):
        """Predict the state after a step of `duration` (s) with a Turn from turn() and a displacement.

        forward, left: displacement (m) measured by the wheels, in a frame that is rotated by `direction` (rad) against
        the robot's own half way through the turn; variance: of the displacement, m^2.
        """
        angle, noise, by_bias, by_scale, by_slip = turn
        x, y, yaw, bias, scale, turning, straight = self.state
        middle = yaw + angle / 2 + direction
        c, s = cos(middle), sin(middle)
        grip = 1 - straight
        along, across = forward * c - left * s, forward * s + left * c
        self.state = [x + grip * along, y + grip * across, yaw + angle, bias, scale, turning, straight]

        # derivatives of x and y by the heading half way, which depends on half of the turn
        dx, dy = -grip * across, grip * along
        root, used = self.root, self.used
        root[:3] = numpy.array([
            [1.0, 0.0, dx, dx / 2 * by_bias, dx / 2 * by_scale, dx / 2 * by_slip, -along],
            [0.0, 1.0, dy, dy / 2 * by_bias, dy / 2 * by_scale, dy / 2 * by_slip, -across],
            [0.0, 0.0, 1.0, by_bias, by_scale, by_slip, 0.0]]) @ root
        travelled = abs(forward) + abs(left)
        deviation = sqrt(noise)
        root[:3, used] = dx / 2 * deviation, dy / 2 * deviation, deviation
        columns = 1
        if travelled:
            deviation = grip * sqrt(max(variance, self.prior.distance_noise ** 2 * travelled))
            root[:2, used + 1] = c * deviation, s * deviation
            columns = 2
        self.walked[0] += duration
        self.walked[1] += abs(angle)
        self.walked[2] += travelled
        self._use_columns(columns)

    def _use_columns(self, number):
        """The root has so many more columns. If few are left, add the noise of the random walks, and make it square."""
        self.used += number
        if self.used <= 5 + SPARE:
            return
        walks = numpy.zeros((7, 3))
        walks[[BIAS, TURNING, STRAIGHT], range(3)] = [
            walk * sqrt(path) for walk, path in zip((BIAS_WALK, SLIP_WALK, SLIP_WALK), self.walked)]
        square = numpy.linalg.qr(numpy.hstack([self.root, walks]).T, mode='r').T
        self.root[:] = 0.0
        self.root[:, :7] = square
        self.used = 7
        self.walked = [0.0] * 3
