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
from operator import add
from typing import NamedTuple, Tuple

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.filter.gyro_readings import Measurement
from rbx1_nav.filter.pose_errors import BIAS, BIAS_WALK, CURVATURE, INSTABILITY, PERIOD, SLIP, YAW, PoseErrors, Yaw
from rbx1_nav.filter.priors import Bounds, Priors

FIRST_BIAS = 0.05       # 1 sigma of the bias before the first rest / its limit: 0.5 degrees/s, as gyros have after a
#                         calibration at another temperature (surface files: gyro_bias)
KNOWN_BIAS = 0.65       # of FIRST_BIAS: the wheels have shown the bias if it is less uncertain. At a constant speed,
#                         bias and curvature are confused: without this limit, a Husky is 11 m off instead of 3
SKEW = 0.1              # s by which the stamps of wheels and gyro may be apart
LEAST_MOTION = 0.02     # m and rad in a PERIOD: in a smaller one, the robot is stationary, or somebody carries it
ENOUGH_TURN = 0.1       # rad in a PERIOD that show whether a gyro turns
TICK_VARIANCE = 1e-6    # rad^2: of a turn over PERIOD, because encoders count ticks of 0.2 mm (0.25 m of track)
ROUNDING = 0.005        # rad: 1 sigma of a turn in odometry that is rounded to whole degrees, as a Create reports it
RARE, CLEAR = 3.0, 5.0  # standard deviations of a rare difference, and of a contradiction: 1 of 370, and of 1.7 million
POSSIBLE_SLIP = -0.3, 0.95      # beyond it, one of the sensors is wrong. The wheels of a Jackal, a skid-steer, report
#                         7.4 times its turn (robot_localization, test2.bag: a slip of 0.865)
FIRST_NOISE = 0.25      # weight of the noise of any floor, in measurements of the noise
FADE = 0.85             # fraction of a doubt that remains after each PERIOD in a turn in which wheels and gyro agree
SMOOTH = 0.1            # noise of the wheels / noise of any floor, below which a steady difference is no slip
MAX_SCALE = 0.1         # a larger error of the scale is none: data sheets of MEMS gyros have 3 % (ADXRS613)
STEADY = radians(1)     # rad/s: a bias changes by less than this from one rest to the next


class Sums(NamedTuple):
    """What wheels and gyro have measured in a period."""

    time: float = 0.0       # s
    wheels: float = 0.0     # rad: the turn that the wheels report
    gyro: float = 0.0       # rad: the turn with its bias
    forward: float = 0.0    # m
    variance: float = 0.0   # rad^2: of both turns


Verdict = Tuple[Sums, str]      # what is doubted: 'wheels', 'both', 'gyro', 'scale', 'bias', or '' if all agree


class Filter(PoseErrors):
    """What is learned of the errors. Time stamps, dropouts and invalid messages are handled elsewhere."""

    def __init__(self, prior: Priors, pose: Pose, max_bias: float = Bounds().gyro_bias) -> None:
        """pose: initial pose; max_bias: the largest bias of a gyro, rad/s."""
        self.first_bias = FIRST_BIAS * max_bias
        super().__init__(prior, pose, self.first_bias)
        self.rested = False     # whether the bias was learned at rest
        self.gyro_left = False  # whether the gyro is not used, because it does not turn with the wheels
        self.last_turn = 0.0    # rad, of the wheels in the PERIOD before
        self.noise = FIRST_NOISE, FIRST_NOISE       # of the wheels: sum of measurements / noise of any floor, number
        self.drift = 0.0        # rad/s, by which the wheels show that the bias has drifted
        self._forget()

    def _forget(self) -> None:
        """Begin to compare wheels and gyro, at a start or at a rest."""
        self.compared = Sums()          # in this PERIOD
        self.deviations = 0.0, 0        # sum of the differences since then (standard deviations), and their number
        self.disagreement = 0.0         # rad: sum of the clear contradictions, which fades while both agree
        self.turned = self.lost = 0.0   # rad: turn of the gyro, and how much farther the wheels have turned

    def turn(self, duration: float, wheels: Measurement, gyro: Measurement | None, forward: float = 0.0) -> Yaw:
        """Return the Yaw of a step of `duration` (s): as measured by the gyro, or by the wheels if the gyro has not
        measured it, or so many of its readings are missing that the wheels are more certain."""
        variance = self.wheel_variance(wheels, forward)
        if gyro and not self.gyro_left and (
                gyro[1] <= max(ROUNDING ** 2, variance + self.P[SLIP][SLIP] * wheels[0] ** 2)):
            return Yaw(gyro[0] - self.bias * duration, gyro[1], True)
        return Yaw(wheels[0] * (1 - self.error[SLIP]) + self.error[CURVATURE] * forward, variance, False)

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

    def compare(self, duration: float, wheels: float, gyro: Measurement | None, forward: float) -> Verdict | None:
        """Compare the turns of wheels and gyro after a step, if the gyro has measured all of this PERIOD. Return the
        Verdict on a PERIOD that is complete. The difference never changes the pose."""
        if not gyro:
            self.compared = Sums()
            return None
        self.compared = sums = Sums(*map(add, self.compared, (duration, wheels, gyro[0], forward, gyro[1])))
        if sums.time < PERIOD - 1e-6:
            return None
        change, self.last_turn, self.compared = sums.wheels - self.last_turn, sums.wheels, Sums()
        if abs(sums.wheels) + abs(sums.forward) < LEAST_MOTION:
            return None
        turned = sums.gyro - self.bias * sums.time
        self.lost += sums.wheels * (1 - self.prior.slip_turning) - turned
        self.turned += turned
        if self.gyro_left and not (abs(sums.wheels) > ENOUGH_TURN and 0.5 < turned / sums.wheels < 2):
            return sums, 'gyro'
        self.gyro_left = False
        self.flush()
        bias, slip, curvature = self.error[3:]
        H = sums.time, -sums.wheels, sums.forward
        difference = sums.gyro - bias * sums.time - sums.wheels * (1 - slip) - curvature * sums.forward
        known = sum(self.P[3 + i][3 + j] * H[i] * H[j] for i in range(3) for j in range(3))
        least = sums.variance + TICK_VARIANCE + (SKEW / PERIOD * change) ** 2
        turning, straight, _ = self.noises[1]
        floor = turning * abs(sums.wheels) + straight * abs(sums.forward)
        measured, expected = self.noise
        noise = floor * measured / expected + least
        self.noise = measured + min(RARE ** 2, difference ** 2 / (known + floor + least)), expected + 1
        deviation = difference / sqrt(known + noise)
        self.update(H, difference, noise * max(1.0, (deviation / RARE) ** 2))
        if self.rested or self.P[BIAS][BIAS] < (KNOWN_BIAS * self.first_bias) ** 2:
            self.bias = self.error[BIAS]
        if self.error[SLIP] - POSSIBLE_SLIP[1] > sqrt(self.P[SLIP][SLIP]):      # wheels cannot slip so much
            self.leave_gyro()
            return sums, 'gyro'
        return sums, (self._test_difference(sums, turned, difference, deviation, noise) or self._test_drift(deviation)
                      or self._test_scale())

    def _test_difference(self, sums: Sums, turned: float, difference: float, deviation: float, noise: float) -> str:
        """Test whether a difference is a contradiction: return 'wheels' if a possible slip explains it, otherwise
        'both'."""
        if abs(deviation) < CLEAR:
            if abs(sums.wheels) > ENOUGH_TURN:
                self.doubt, self.disagreement = [FADE * each for each in self.doubt], FADE * self.disagreement
            return ''
        self.disagreement += difference
        low, high = sorted(sums.wheels * (1 - slip) for slip in POSSIBLE_SLIP)
        beyond = max(low - turned, turned - high, 0.0)
        if beyond ** 2 < CLEAR ** 2 * (noise + self.P[BIAS][BIAS] * sums.time ** 2):
            return 'wheels'
        self.doubt_turn(difference)
        return 'both'

    def _test_drift(self, deviation: float) -> str:
        """Test whether the differences since the last rest have one sign. If they do, the bias has drifted steadily, as
        far as the wheels show if they are right, or the wheels mislead: return 'bias', slip and curvature are unknown
        again, and the error that the drift has caused is part of the covariance. No bias drifts by more than STEADY:
        such a difference is a doubt, 'both'."""
        total, count = self.deviations = self.deviations[0] + deviation, self.deviations[1] + 1
        if not self.rested or total ** 2 < CLEAR ** 2 * count:
            return ''
        self.deviations = 0.0, 0
        drift = -2 * self.lost / self.moving    # twice the mean
        if abs(drift) > STEADY:
            self.disagreement -= self.lost
            self.doubt_turn(-self.lost)
            return 'both'
        self.drift = drift
        self.P[BIAS][BIAS] += drift ** 2
        self.P[YAW][YAW] += self.lost ** 2
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
            self.gyro_left = True
            self.doubt_turn(self.lost)
            self.forget_wheels()
