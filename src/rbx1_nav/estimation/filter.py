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

Which of the errors are learned depends on the case:

- standstill (standstill.py): the gyro's rate is its bias. How much the bias has changed between two standstills shows
  how fast it drifts, and so how uncertain the heading becomes between them.
- agreement: wheels and gyro differ no more than they may on a floor. The difference is a measurement of the slip. It is
  one of bias and scale error only until the bias has been learned at rest, because wheels that slip in a way that the
  model does not know would corrupt them. The noise of the wheels is as small as the differences show (noise.py).
- contradiction: they differ more than on any floor (agreement.py). The heading becomes as uncertain as they differ;
  only the slip is still learned. When they agree again, the doubt shrinks to what this slip does not explain.
- carried (standstill.py): the heading turns with the gyro, and becomes as uncertain as the turn is large; so does the
  position by the distance that the robot may have been carried.

The covariance is kept as a square root, a matrix whose product with its own transpose is the covariance. So it has no
negative eigenvalue, whatever is measured. A measurement changes the root by Joseph's form (Maybeck, Stochastic Models,
Estimation, and Control, volume 1, 1979, section 5.6), which holds for any gain. Noise adds columns to it; a QR
decomposition makes it square again.
"""
from collections import namedtuple
from math import cos, exp, inf, radians, sin, sqrt

import numpy

from rbx1_nav.estimation.agreement import Agreement
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.noise import Drift, NoiseFactor
from rbx1_nav.units import clamp

X, Y, YAW, BIAS, SCALE, TURNING, STRAIGHT = range(7)

START_VARIANCE = 1e-9       # of the first pose, m^2 and rad^2: the frame begins where the robot does
BIAS_WALK = radians(0.0005)  # rad/s after 1 s: random walk of a bias that does not drift; 0.03 degrees/s in an hour
SLIP_WALK = 0.02            # after 1 rad or 1 m: random walk of the slip
OUTLIER = 5.0               # standard deviations between wheels and gyro beyond which one of them must be wrong
MAX_SPREAD = 0.1            # 1 sigma of the straight slip, however far the robot drives
MAX_ERROR = 0.8             # of slip and scale error: beyond it something else is wrong
PART_TURN, PART_TIME = 0.2, 1.0     # rad, s: turn and time over which the differences of wheels and gyro are added up
STEADY = 0.5                # variance of the gyro's turn over a gap at a steady rate / variance of the wheels' turn
MIN_DRIFT_TIME = 1.0        # s between two standstills from which a drift is learned
COINCIDENCE = 0.4           # 1 sigma of the scale error / difference of wheels and gyro; the rest is slip
CARRY_SPEED = 0.5           # m/s: how fast the robot may move (1 sigma) while it is carried
FADE = 0.5                  # rad: a doubt shrinks with the exponential of the turn in which wheels and gyro agree

# what no surface file can promise: 1 sigma of the scale error of a gyro, of the slip in turns and straight on
MIN_SCALE_ERROR, MIN_SPREAD_TURNING, MIN_SPREAD_STRAIGHT = 0.003, 0.05, 0.02
# what a difference of wheels and gyro does not change once the bias is known, or while they contradict each other
KEPT = [X, Y, YAW, BIAS, SCALE]

Priors = namedtuple('Priors', 'slip_straight slip_straight_spread slip_turning slip_turning_spread '
                              'gyro_scale_error gyro_measurement_range '
                              'heading_noise_turning heading_noise_straight distance_noise')
Priors.__doc__ = 'What is assumed before the first message; fields of a Surface, in its units.'

# any floor. The noise is that of five real robots, config/surfaces/create_lab_floor.yaml; the spreads are as wide as
# the slips of all files are apart
UNKNOWN_FLOOR = Priors(0.0, 0.05, 0.0, 0.05, Limits().gyro_scale_error, Limits().max_turn_rate, 0.084, 0.066, 0.044)


def priors(surface):
    """The Priors of a Surface (None: the ideal one)."""
    if surface is None:
        return Priors(0.0, 0.0, 0.0, 0.0, 0.0, inf, 0.0, 0.0, 0.0)
    return Priors(*(getattr(surface, field) for field in Priors._fields))


HeadingChange = namedtuple('HeadingChange', 'angle variance by_bias by_scale by_slip')
HeadingChange.__doc__ = "A turn (rad), its variance (rad^2), its derivatives by the gyro's bias and scale error and " \
                        "the slip."

DOUBT, DRIFT, APART = 0, 1, 2   # columns of `columns`, see Filter; the number of them
SPARE = 32      # columns of the root for noise, before it is made square again


class Filter:
    """The state and its covariance. Knows nothing of time stamps, dropouts or invalid messages."""

    def __init__(self, prior, pose, max_bias=Limits().gyro_bias):
        """prior: Priors; pose: the initial Pose; max_bias: rad/s, 1 sigma of the bias at first."""
        self.prior = prior
        self.state = [pose.x, pose.y, pose.yaw, 0.0, 0.0, prior.slip_turning, prior.slip_straight]
        # DOUBT: error of the pose if wheels and gyro have contradicted each other; DRIFT: change of the state per
        # rad/s^2 by which the bias drifts since it was last known; the rest is the square root of the covariance
        self.columns = numpy.zeros((7, APART + 7 + SPARE))
        self.root = self.columns[:, APART:]
        self.root[range(7), range(7)] = [sqrt(START_VARIANCE)] * 3 + [
            max_bias, max(prior.gyro_scale_error, MIN_SCALE_ERROR),
            max(prior.slip_turning_spread, MIN_SPREAD_TURNING), max(prior.slip_straight_spread, MIN_SPREAD_STRAIGHT)]
        self.used = 7               # columns of the root
        self.walked = [0.0] * 3     # s, rad, m since the root was square
        self.part = None            # sums of the steps whose difference has not been used yet, see _use()
        self.agreement = Agreement()
        self.bias_known = False     # whether the bias was learned at rest
        self.drift = Drift()        # of the bias
        self.carried = numpy.zeros(2)       # rad, m: how far it may have been carried
        self.loose = False          # whether wheels and gyro have contradicted each other
        self.contradicted = numpy.zeros(2)      # rad, what they measured then: wheels, gyro
        self.noise = NoiseFactor()  # of the wheels
        self.roughness = 1.0        # the noise of their last turn, as a fraction of the prior's

    @property
    def covariance(self):
        """Of x, y (m) and yaw (rad), 3x3."""
        pose = self.root[:3]
        covariance = pose @ pose.T
        if self.loose:
            pose = self.columns[:3, DOUBT]
            covariance += pose[:, None] * pose
        if self.drift.value:
            pose = sqrt(self.drift.value) * self.columns[:3, DRIFT]
            covariance += pose[:, None] * pose
        return covariance

    @property
    def bias(self):
        """Of the gyro, rad/s."""
        return self.state[BIAS]

    @property
    def bias_sigma(self):
        """1 sigma of the gyro's bias, rad/s."""
        return sqrt(self._bias_variance + self.drift.value * float(self.columns[BIAS, DRIFT]) ** 2)

    def place(self, pose, covariance):
        """The robot is at a Pose, with this covariance (3x3) of x, y (m) and yaw (rad)."""
        self._make_square()
        self.state[:3] = pose
        self.root[:3] = 0.0
        values, vectors = numpy.linalg.eigh(covariance)
        self.root[:3, self.used:self.used + 3] = vectors * numpy.sqrt(numpy.maximum(values, START_VARIANCE))
        self.columns[:3, :APART] = 0.0
        self.carried[:] = self.contradicted[:] = 0.0
        self._use_columns(3)

    def turn(self, duration, wheels=None, gyro=None, travelled=0.0, missing=0.0):
        """Estimate the HeadingChange of a step of `duration` (s) for move(), and update the errors in the state.

        wheels, gyro: the measured (angle in rad, variance in rad^2), or None; travelled: m, by the wheels; missing:
        additional variance (rad^2) of the gyro's turn because readings are missing within this step. If wheels and gyro
        disagree by more than OUTLIER, the wheels have slipped far more than usual: the gyro is used alone.
        """
        if wheels:
            prior, (angle, variance) = self.prior, wheels
            floor = prior.heading_noise_turning ** 2 * abs(angle) + prior.heading_noise_straight ** 2 * travelled
            variance = self.noise.value * max(variance, floor)
            self.roughness = min(1.0, variance / floor) if floor else 1.0
            wheels = angle, variance
        both = self._compare(duration, wheels, gyro, missing) if wheels and gyro else None
        if both:
            return both
        if gyro:
            scale = 1 + self.state[SCALE]
            angle = (gyro[0] - self.state[BIAS] * duration) / scale
            return HeadingChange(angle, (gyro[1] + missing) / scale ** 2, -duration / scale, -angle / scale, 0.0)
        if wheels:
            grip = 1 - self.state[TURNING]
            return HeadingChange(wheels[0] * grip, wheels[1] * grip ** 2, 0.0, 0.0, -wheels[0])
        return HeadingChange(0.0, 0.0, 0.0, 0.0, 0.0)

    def doubt_floor(self):
        """If wheels and gyro show a slip that the prior's floor does not have, the straight slip, which nothing
        measures, becomes as uncertain as on an unknown floor. Returns whether that is so."""
        if self.loose or not self.agreement.difference(self.prior, self._bias_variance):
            return False
        self._add_noise(STRAIGHT, UNKNOWN_FLOOR.slip_straight_spread)
        return True

    def doubt_heading(self):
        """If wheels and gyro differ more than on any floor, one of them is wrong: the heading becomes as uncertain as
        they differ, and a new comparison begins. If they agree, that uncertainty shrinks. Returns the angle (rad) by
        which they differ, or 0."""
        floor = UNKNOWN_FLOOR._replace(slip_turning=self.state[TURNING] if self.loose else 0.0)
        difference = self.agreement.difference(floor, self._bias_variance)
        if difference:
            self.columns[YAW, DOUBT] += abs(difference)
            self.contradicted += self.agreement.wheels, self.agreement.gyro
            self.loose = True
            self.agreement = Agreement()
        elif not self.columns[YAW, DOUBT]:
            self._limit_scale()
        elif self.agreement.agrees(floor):
            self._shrink_doubt()
        return difference

    def _shrink_doubt(self):
        """Wheels and gyro agree: the wheels had slipped as they do now. The doubt shrinks to what this slip leaves
        unexplained. A gyro that was wrong, and is right again, leaves all of it."""
        doubt = float(self.columns[YAW, DOUBT])
        wheels, gyro = self.contradicted
        unexplained = abs(wheels * (1 - self.state[TURNING]) - gyro)
        self.columns[:, DOUBT] *= max(exp(-abs(self.agreement.last[1]) / FADE), min(1.0, unexplained / doubt))

    def _limit_scale(self):
        """If wheels and gyro agree over a long turn, the scale error is as small as their difference: it would be a
        coincidence if a larger one had the same effect as the slip of the wheels."""
        seen = self.agreement.ratio(self._bias_variance)
        if seen:
            spread = self.root[SCALE]
            variance = float(spread @ spread)
            least = max(seen * COINCIDENCE, MIN_SCALE_ERROR) ** 2
            if variance > 1.01 * least:
                self._measure(spread, self.state[SCALE], 1 / (1 / least - 1 / variance))    # makes it `least`

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
        if alone:
            self._use_part()
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
                self._use_part()

        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        angle = (gyro[0] - state[BIAS] * duration) / scale
        wheel_noise, gyro_noise = wheels[1] * grip ** 2, gyro[1] / scale ** 2
        share = gyro_noise / (wheel_noise + gyro_noise)     # of the wheels
        return HeadingChange(share * wheels[0] * grip + (1 - share) * angle, share * wheel_noise,
                    (share - 1) * duration / scale, (share - 1) * angle / scale, -share * wheels[0])

    def _spread(self, duration, wheels, gyro):
        """The derivatives of the difference of two turns (rad) by the errors in the state, multiplied by their root."""
        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        # noise that is both in a measurement and in its derivative does not average out. So the slip's derivative uses
        # the gyro's turn, since the wheels' is rounded to ticks; where the wheels stand, the gyro's turn is all noise
        turned = (gyro - state[BIAS] * duration) / scale if wheels else 0.0
        return numpy.array([duration / scale, turned / scale, -turned / grip]) @ self.root[BIAS:STRAIGHT]

    def _use_part(self):
        """Use the part, if there is one."""
        part, self.part = self.part, None
        if part:
            self._use(part)

    def _use(self, part):
        """Use the difference of wheels and gyro as a measurement of the errors.

        part: s, turn by the wheels (rad) and its variance, turn by the gyro (rad) and its variance.
        """
        duration, wheels, wheel_variance, gyro, gyro_variance = part
        state = self.state
        scale, grip = 1 + state[SCALE], 1 - state[TURNING]
        spread = self._spread(duration, wheels, gyro)
        difference = wheels * grip - (gyro - state[BIAS] * duration) / scale
        noise = wheel_variance * grip ** 2 + gyro_variance / scale ** 2
        total = float(spread @ spread) + noise
        self.noise.add(difference ** 2 / total, wheel_variance * grip ** 2 / total)
        self._measure(spread, difference, noise, KEPT if self.bias_known or self.loose else None)

    def _measure(self, spread, difference, noise, kept=None):
        """Use a measured difference that should be 0. spread: its derivatives by the state, multiplied by the root;
        noise: its variance; kept: what of the state it does not change, though it is uncertain."""
        gain = self.root @ spread / (float(spread @ spread) + noise)
        if kept:
            gain[kept] = 0.0
        # holds for any gain (Joseph's form)
        self.root -= gain[:, None] * spread
        self.root[:, self.used] = gain * sqrt(noise)
        state = self.state = [old - change * difference for old, change in zip(self.state, gain.tolist())]
        for index in SCALE, TURNING:
            state[index] = clamp(state[index], MAX_ERROR)
        self._use_columns(1)

    def rest(self, duration):
        """The wheels are at rest for `duration` (s)."""
        self._use_part()
        self.walked[0] += duration
        self.columns[BIAS, DRIFT] += duration

    def learn_bias(self, rate, variance):
        """The gyro's mean rate (rad/s), with its variance, is its bias, because the robot is at rest."""
        spread, drift = self.root[BIAS], self.columns[:, DRIFT]
        difference = self.state[BIAS] - rate
        if self.bias_known:
            if drift[BIAS] > MIN_DRIFT_TIME:
                noise = float(spread @ spread) + variance
                self.drift.add(drift[BIAS], difference ** 2, noise)
            self.root[:, self.used] = sqrt(self.drift.value) * drift
            self._use_columns(1)
        self._measure(self.root[BIAS], difference, variance)
        drift[:] = 0.0
        self.bias_known = True

    def carry(self, angle, duration):
        """The gyro has turned by an angle (rad) in `duration` (s) while the wheels were at rest. Where the robot was
        carried to, nothing measures."""
        self.state[YAW] += angle
        before, self.carried = self.carried, self.carried + (abs(angle), CARRY_SPEED * duration)
        turned, moved = numpy.sqrt(self.carried ** 2 - before ** 2)
        self._add_noise(YAW, turned)
        self._add_noise(X, moved)
        self._add_noise(Y, moved)

    def doubt_bias(self, rate):
        """The wheels were at rest, and the gyro's rate (rad/s) was steady for a while: it may be the bias."""
        self._add_noise(BIAS, abs(rate - self.state[BIAS]))

    def move(self, duration, turn, direction=0.0, forward=0.0, left=0.0, variance=0.0):
        """Predict the state after a step of `duration` (s) with a HeadingChange from turn() and a displacement.

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
        self.columns[:3] = numpy.array([
            [1.0, 0.0, dx, dx / 2 * by_bias, dx / 2 * by_scale, dx / 2 * by_slip, -along],
            [0.0, 1.0, dy, dy / 2 * by_bias, dy / 2 * by_scale, dy / 2 * by_slip, -across],
            [0.0, 0.0, 1.0, by_bias, by_scale, by_slip, 0.0]]) @ self.columns
        self.columns[BIAS, DRIFT] += duration
        travelled = abs(forward) + abs(left)
        deviation = sqrt(noise)
        root[:3, used] = dx / 2 * deviation, dy / 2 * deviation, deviation
        columns = 1
        if travelled:
            floor = self.prior.distance_noise ** 2 * travelled
            deviation = grip * sqrt(max(self.noise.value * variance, self.roughness * floor))
            root[:2, used + 1] = c * deviation, s * deviation
            columns = 2
        self.walked[0] += duration
        self.walked[1] += abs(angle)
        self.walked[2] += travelled
        self._use_columns(columns)

    def _use_columns(self, number):
        """The root has so many more columns; it is made square if few are left."""
        self.used += number
        if self.used > 5 + SPARE:
            self._make_square()

    def _make_square(self):
        """Add the noise of the random walks, and make the root square."""
        walks = numpy.zeros((7, 3))
        variances = [walk ** 2 * path for walk, path in zip((BIAS_WALK, SLIP_WALK, SLIP_WALK), self.walked)]
        # nothing measures the straight slip: it would become ever more uncertain
        variances[2] = min(variances[2], max(0.0, MAX_SPREAD ** 2 - float(self.root[STRAIGHT] @ self.root[STRAIGHT])))
        walks[[BIAS, TURNING, STRAIGHT], range(3)] = numpy.sqrt(variances)
        square = numpy.linalg.qr(numpy.hstack([self.root, walks]).T, mode='r').T
        self.root[:] = 0.0
        self.root[:, :7] = square
        self.used = 7
        self.walked = [0.0] * 3
