"""The arithmetic of the combined odometry: a planar extended Kalman filter of wheel odometry and a gyro.

The model and its state are in model.py. In each step, update() uses the difference of wheels and gyro as a measurement
of their errors, and predict() makes the step with the mean of both. The differences of several steps are used as one
sum, because the wheels may report the turn of a single step in coarse units. The rest is the standard filter (Thrun,
Burgard and Fox, Probabilistic Robotics, section 3.3; their letters in parentheses): the covariance P (Sigma), the
derivatives F (G) of the state after a step and H of a measured value, the variance R (Q) of that value, and the gain K.
Unlike there, update() comes first in a step, because the turn in predict() depends on the corrected errors.

Which of the errors are learned depends on the case:

- standstill (standstill.py): the gyro's rate is its bias. The change of the bias between two standstills shows how fast
  it drifts, and so how uncertain the heading becomes between them.
- agreement: wheels and gyro differ by no more than a floor allows. The difference is a measurement of the slip. It is
  also a measurement of bias and scale error, but only until the bias has been learned at rest, because slip that is not
  in the model would corrupt them. The noise of the wheels is as small as the differences show (noise.py).
- contradiction: wheels and gyro differ by more than on any floor (agreement.py). The heading uncertainty grows by the
  difference. From then on, a turn measures only the slip. When wheels and gyro agree again, the doubt
  shrinks to the part that this slip does not explain.
- carried (standstill.py): the heading turns with the gyro, and its uncertainty grows by the turn. The uncertainty of
  the position grows by the distance that the robot may have been carried.
"""
from __future__ import annotations

from math import exp, radians, sqrt

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.estimation.agreement import Agreement
from rbx1_nav.estimation.covariance import Covariance
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.estimation.model import (
    BIAS, SCALE, STRAIGHT, TURNING, X, Y, YAW, HeadingChange, Measurement, Turns, innovation, innovation_derivatives,
    mean_turn, move, turn_by_gyro, turn_by_wheels)
from rbx1_nav.estimation.noise import Drift, NoiseFactor
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR, Priors
from rbx1_nav.robot.kinematics import Pose
from rbx1_nav.units import clamp

START_VARIANCE = 1e-9       # variance of the first pose, m^2 and rad^2: the frame begins at this pose
BIAS_WALK = radians(0.0005)  # rad/s after 1 s: random walk of a bias that does not drift; 0.03 degrees/s in an hour
SLIP_WALK = 0.02            # after 1 rad or 1 m: random walk of the slip
OUTLIER = 5.0               # standard deviations between wheels and gyro beyond which one of them must be wrong
MAX_SPREAD = 0.1            # 1 sigma of the straight slip, however far the robot drives
MAX_ERROR = 0.8             # largest slip and scale error: if they are larger, something else is wrong
PART_TURN, PART_TIME = 0.2, 1.0     # rad, s: turn and time over which the differences of wheels and gyro are summed
UNREAD = 0.5                # variance of the gyro's turn over a gap at a steady rate / variance of the wheels' turn
MIN_DRIFT_TIME = 1.0        # minimum time (s) between two standstills to learn a drift
COINCIDENCE = 0.4           # 1 sigma of the scale error / difference of wheels and gyro; the rest is slip
CARRY_SPEED = 0.5           # m/s: possible speed of the robot (1 sigma) while it is carried
FADE = 0.5                  # rad: a doubt decays exponentially with the turn in which wheels and gyro agree

# lower limits of the values in a surface file: 1 sigma of the gyro's scale error, of the slip in turns and straight on
MIN_SCALE_ERROR, MIN_SPREAD_TURNING, MIN_SPREAD_STRAIGHT = 0.003, 0.05, 0.02
# not changed by a difference of wheels and gyro once the bias is known, or they have contradicted each other
KEPT = [X, Y, YAW, BIAS, SCALE]


class Filter:
    """The state and its covariance. Time stamps, dropouts and invalid messages are handled elsewhere."""

    def __init__(self, prior: Priors, pose: Pose, max_bias: float = Limits().gyro_bias) -> None:
        """pose: initial pose; max_bias: initial 1 sigma of the bias, rad/s."""
        self.prior = prior
        self.state = [pose.x, pose.y, pose.yaw, 0.0, 0.0, prior.slip_turning, prior.slip_straight]
        # `doubt` is the error of the state after a contradiction of wheels and gyro; `drift` is the change of the state
        # since the bias was last known, for a drift of 1 rad/s^2
        self.P = Covariance([sqrt(START_VARIANCE)] * 3 + [
            max_bias, max(prior.gyro_scale_error, MIN_SCALE_ERROR),
            max(prior.slip_turning_spread, MIN_SPREAD_TURNING),
            max(prior.slip_straight_spread, MIN_SPREAD_STRAIGHT)], self._take_random_walks)
        self.walked = [0.0] * 3     # s, rad, m since the random walks were last added
        self.part: Turns | None = None      # sum of the steps whose differences have not been used yet
        self.agreement = Agreement()
        self.bias_known = False     # whether the bias was learned at rest
        self.bias_drift = Drift()        # drift of the bias
        self.carried: Array = numpy.zeros(2)    # rad, m: how far the robot may have been carried
        self.contradicted = False          # whether wheels and gyro have contradicted each other
        self.contradicting: Array = numpy.zeros(2)  # rad, turns measured then: wheels, gyro
        self.noise = NoiseFactor()  # noise of the wheels
        self.roughness = 1.0        # noise of the wheels' last turn, as a fraction of the prior's noise

    @property
    def covariance(self) -> Array:
        """The covariance of x, y (m) and yaw (rad), 3x3."""
        covariance = self.P.of_first(3)
        if self.contradicted:
            doubt = self.P.doubt[:3]
            covariance += doubt[:, None] * doubt
        if self.bias_drift.value:
            drift = sqrt(self.bias_drift.value) * self.P.drift[:3]
            covariance += drift[:, None] * drift
        return covariance

    @property
    def bias(self) -> float:
        """The bias of the gyro, rad/s."""
        return self.state[BIAS]

    @property
    def bias_sigma(self) -> float:
        """1 sigma of the gyro's bias, rad/s."""
        return sqrt(self.P.variance(BIAS) + self.bias_drift.value * float(self.P.drift[BIAS]) ** 2)

    def place(self, pose: Pose, covariance: Array) -> None:
        """Set the robot's Pose, with its covariance (3x3) of x, y (m) and yaw (rad)."""
        self.state[:3] = pose
        self.P.replace_first(covariance, START_VARIANCE)
        self.carried[:] = self.contradicting[:] = 0.0

    # measurements

    def update(self, duration: float, wheels: Measurement | None = None, gyro: Measurement | None = None,
               travelled: float = 0.0, missing: float = 0.0) -> HeadingChange:
        """Update the errors in the state with the measurements of a step, and return the HeadingChange for predict().

        duration: s; travelled: distance measured by the wheels, m; missing: additional variance (rad^2) of the gyro's
        turn because readings are missing in this step. If wheels and gyro disagree by more than OUTLIER, the wheels
        have slipped far more than usual, and only the gyro is used.
        """
        if wheels:
            prior, (angle, variance) = self.prior, wheels
            floor = prior.heading_noise_turning ** 2 * abs(angle) + prior.heading_noise_straight ** 2 * travelled
            variance = self.noise.value * max(variance, floor)
            self.roughness = min(1.0, variance / floor) if floor else 1.0
            wheels = angle, variance
        both = self._compare(Turns(duration, *wheels, *gyro), missing) if wheels and gyro else None
        if both:
            return both
        if gyro:
            return turn_by_gyro(self.state, (gyro[0], gyro[1] + missing), duration)
        if wheels:
            return turn_by_wheels(self.state, wheels)
        return HeadingChange(0.0, 0.0, 0.0, 0.0, 0.0)

    def _compare(self, turns: Turns, missing: float) -> HeadingChange | None:
        """Add a step to the part, use the part if it is complete, and return the mean, or None for an outlier."""
        # the noise of this step would hide the differences of the other steps
        alone = bool(missing) or turns.gyro_variance > turns.wheel_variance
        if alone:
            self._use_part()
        difference, R = innovation(self.state, turns)
        if missing:
            # if the rate changed while it was not read, the difference is the error of the gyro's turn
            unread = min(missing, UNREAD * turns.wheel_variance + difference ** 2)
            turns = turns._replace(gyro_variance=turns.gyro_variance + unread)
            difference, R = innovation(self.state, turns)
        if difference ** 2 > OUTLIER ** 2 * R:      # rare: also consider the errors in the state
            HS = self._derivatives(turns)
            if difference ** 2 > OUTLIER ** 2 * (R + float(HS @ HS)):
                return None
        if alone:
            self._use(turns)
        else:
            part = self.part = self.part.plus(turns) if self.part else turns
            if part.time > PART_TIME or abs(part.wheels) > PART_TURN or abs(part.gyro) > PART_TURN:
                self._use_part()
        return mean_turn(self.state, turns)

    def _derivatives(self, turns: Turns) -> Array:
        """Return H S of innovation()."""
        HS: Array = innovation_derivatives(self.state, turns) @ self.P.root[BIAS:STRAIGHT]
        return HS

    def _use_part(self) -> None:
        """Use the part, if there is one."""
        part, self.part = self.part, None
        if part:
            self._use(part)

    def _use(self, turns: Turns) -> None:
        """Use the difference of wheels and gyro as a measurement of the errors."""
        HS = self._derivatives(turns)
        difference, R = innovation(self.state, turns)
        total = float(HS @ HS) + R
        self.noise.add(difference ** 2 / total, turns.wheel_variance * (1 - self.state[TURNING]) ** 2 / total)
        self._correct(difference, HS, R, KEPT if self.bias_known or self.contradicted else None)

    def _correct(self, difference: float, HS: Array, R: float, kept: list[int] | None = None) -> None:
        """Correct the state and P with an innovation (a difference), as in Covariance.update()."""
        K = self.P.update(HS, R, kept)
        state = self.state = [old + gain * difference for old, gain in zip(self.state, K.tolist())]
        for index in SCALE, TURNING:
            state[index] = clamp(state[index], MAX_ERROR)

    # comparison of wheels and gyro

    def doubt_floor(self) -> bool:
        """Return whether wheels and gyro show a slip that the prior's floor does not have. If so, make the straight
        slip, which nothing measures, as uncertain as on an unknown floor."""
        if self.contradicted or not self.agreement.difference(self.prior, self.P.variance(BIAS)):
            return False
        self.P.add_to(STRAIGHT, UNKNOWN_FLOOR.slip_straight_spread)
        return True

    def doubt_heading(self) -> float:
        """Return the angle (rad) by which wheels and gyro differ if no floor explains it, or 0. If it is not 0, one of
        them is wrong: the heading uncertainty grows by this angle, and a new comparison begins. If they agree, that
        uncertainty shrinks."""
        floor = UNKNOWN_FLOOR._replace(slip_turning=self.state[TURNING] if self.contradicted else 0.0)
        difference = self.agreement.difference(floor, self.P.variance(BIAS))
        if difference:
            self.P.doubt[YAW] += abs(difference)
            self.contradicting += self.agreement.wheels, self.agreement.gyro
            self.contradicted = True
            self.agreement = Agreement()
        elif not self.P.doubt[YAW]:
            self._limit_scale()
        elif self.agreement.agrees(floor):
            self._shrink_doubt()
        return difference

    def _shrink_doubt(self) -> None:
        """Shrink the doubt, because wheels and gyro agree, to the part that the present slip does not explain. If the
        gyro was wrong, and is right again, the whole doubt remains."""
        doubt = float(self.P.doubt[YAW])
        wheels, gyro = self.contradicting
        unexplained = abs(wheels * (1 - self.state[TURNING]) - gyro)
        self.P.doubt *= max(exp(-abs(self.agreement.last.gyro) / FADE), min(1.0, unexplained / doubt))

    def _limit_scale(self) -> None:
        """Limit the scale error to the difference of wheels and gyro if they agree over a long turn: it would be a
        coincidence if a larger scale error had the same effect as the slip of the wheels."""
        seen = self.agreement.ratio(self.P.variance(BIAS))
        if seen:
            variance = self.P.variance(SCALE)
            least = max(seen * COINCIDENCE, MIN_SCALE_ERROR) ** 2
            if variance > 1.01 * least:
                # a measurement of 0, with noise that leaves a variance of `least`
                self._correct(-self.state[SCALE], self.P.root[SCALE], 1 / (1 / least - 1 / variance))

    # results of standstill.py

    def rest(self, duration: float) -> None:
        """Make a step of `duration` (s) in which the wheels are at rest."""
        self._use_part()
        self.walked[0] += duration
        self.P.drift[BIAS] += duration

    def learn_bias(self, rate: float, variance: float) -> None:
        """Learn the bias from the gyro's mean rate (rad/s) and its variance, because the robot is at rest."""
        drift, difference = self.P.drift, rate - self.state[BIAS]
        if self.bias_known:
            if drift[BIAS] > MIN_DRIFT_TIME:
                self.bias_drift.add(float(drift[BIAS]), difference ** 2, self.P.variance(BIAS) + variance)
            self.P.add(sqrt(self.bias_drift.value) * drift)
        self._correct(difference, self.P.root[BIAS], variance)
        drift[:] = 0.0
        self.bias_known = True

    def carry(self, angle: float, duration: float) -> None:
        """Turn the robot by an angle (rad) that the gyro measured in `duration` (s) while the wheels were at rest. No
        sensor measures how far the robot was carried."""
        self.state[YAW] += angle
        before, self.carried = self.carried, self.carried + (abs(angle), CARRY_SPEED * duration)
        turned, moved = numpy.sqrt(self.carried ** 2 - before ** 2)
        self.P.add_to(YAW, turned)
        self.P.add_to(X, moved)
        self.P.add_to(Y, moved)

    def doubt_bias(self, rate: float) -> None:
        """Make the bias uncertain: the wheels were at rest, and a steady rate (rad/s) of the gyro may be the bias."""
        self.P.add_to(BIAS, abs(rate - self.state[BIAS]))

    # the model

    def predict(self, duration: float, turn: HeadingChange, direction: float = 0.0, forward: float = 0.0,
                left: float = 0.0, variance: float = 0.0) -> None:
        """Predict the state after a step of `duration` (s) with a HeadingChange from update() and a displacement.

        forward, left: displacement (m) measured by the wheels, in a frame that is rotated by `direction` (rad) relative
        to the robot's own frame halfway through the turn; variance: variance of the displacement, m^2.
        """
        step = move(self.state, turn, direction, forward, left)
        deviation = sqrt(turn.variance)
        noise = [[each * deviation for each in step.by_turn]]
        travelled = abs(forward) + abs(left)
        if travelled:
            floor = self.prior.distance_noise ** 2 * travelled
            grip = 1 - self.state[STRAIGHT]
            deviation = grip * sqrt(max(self.noise.value * variance, self.roughness * floor))
            noise.append([each * deviation for each in step.by_distance])
        self.state = step.state
        self.walked[0] += duration
        self.walked[1] += abs(turn.angle)
        self.walked[2] += travelled
        self.P.predict(step.F, noise)
        self.P.drift[BIAS] += duration

    def _take_random_walks(self) -> Array:
        """Return the noise (7 x 3) of the random walks of bias and slips since the last call."""
        walks = numpy.zeros((7, 3))
        variances = [walk ** 2 * path for walk, path in zip((BIAS_WALK, SLIP_WALK, SLIP_WALK), self.walked)]
        # nothing measures the straight slip, so its uncertainty would grow without limit
        variances[2] = min(variances[2], max(0.0, MAX_SPREAD ** 2 - self.P.variance(STRAIGHT)))
        walks[[BIAS, TURNING, STRAIGHT], range(3)] = numpy.sqrt(variances)
        self.walked = [0.0] * 3
        return walks
