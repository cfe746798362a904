"""The robot's motion, from its counters to what the base reports: pose, velocity and wheel travel, with uncertainties.

Wraps, gaps and implausible readings of the counters are handled here.
"""
from __future__ import annotations

from math import degrees, hypot, radians
from typing import Mapping, NamedTuple, Union

from rbx1_nav.base.covariances import MEASURED, Reading, Travel, UncertainOdometry
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND, Covariance
from rbx1_nav.extras.create.angle_fractions import UNSURE, Fractions, lost_part
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.protocol import MAX_SPEED, Model

WHEEL_LIMIT = 1.3 * MAX_SPEED / 1000    # m/s: faster than any wheel
MARGIN = 0.015          # m of wheel travel that one reading may miss and the next one include
WRONG, RESET = 3, 6     # consecutive implausible readings: the last good one was corrupted; the robot was reset
DOUBT = 0.5             # 1 sigma of a reading if all replies around it are lost, as a fraction of reach(); measured
DIRTY = 0.01            # share of lost replies from which a turn that was not commanded counts as corrupted,
DOUBTFUL = 16.0         # degrees, if it is larger: what a robot can turn between two readings
SILENT = 0.5            # s without a reading, in which the robot may not have received the commands
ANYWHERE = 10.0         # m, 1 sigma of the travel of a robot that has stopped counting
ROUND = 1 / 12 ** 0.5   # 1 sigma of rounding to a whole number
STANDSTILL = SECOND // 2    # ns without travel or a command to move, after which the robot is stationary


class Expected(NamedTuple):
    """The wheel travel (m) expected from the commands that were sent."""

    left: float
    right: float

    def plus(self, other: Expected, factor: float) -> Expected:
        """Return the sum of this and `factor` times another."""
        return Expected(self.left + factor * other.left, self.right + factor * other.right)


NOWHERE = Travel(0.0, 0.0, 0.0, 0.0)
STILL = Expected(0.0, 0.0)


def reach(elapsed: float) -> float:
    """Return how far (m) a wheel can travel in `elapsed` seconds, according to one reading."""
    return WHEEL_LIMIT * elapsed + MARGIN


def unknown(expected: Expected, width: float) -> Travel:
    """Return the Travel of a robot that moved as commanded for an unknown part of the time, uniformly distributed."""
    left, right = expected
    return Travel(0.0, 0.0, ((left + right) / 2) ** 2 / 3, ((right - left) / width) ** 2 / 3)


class EncoderTravel:
    """Travel of the Create 2, from 16-bit encoders that wrap. A lost reply loses no travel."""

    WRAP = 1 << 16
    unread_variance = 0.0   # each reading shows the whole turn: see CounterTravel
    resets = False          # whether the robot counts from 0 again after each reading

    def __init__(self, model: Model) -> None:
        """model: one with encoders."""
        assert model.counts_per_metre
        self.scale = 1 / model.counts_per_metre
        self.width = model.wheel_separation
        # 1 sigma (m, rad) of a position and a heading that are counted in whole units
        self.rounding = self.scale * ROUND / 2 ** 0.5, 2 ** 0.5 * self.scale * ROUND / self.width
        self.restart()

    def restart(self) -> None:
        """Handle a robot that counts from 0 again: the next reading yields no travel."""
        self.counts: tuple[int, int] | None = None
        self.before: tuple[tuple[int, int], float] | None = None    # previous counts, and s from them to the last ones
        self.rejected = 0       # number of consecutive implausible counts

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected, lost_share: float
               ) -> Travel | None:
        """Return the Travel since the last good reading, `elapsed` s ago; None if no robot could produce this reading:
        it is corrupted, or the robot has been reset. expected: commanded travel in this time; lost_share: share of the
        last replies that were lost."""
        counts = reading['left_encoder'], reading['right_encoder']
        if self.counts is None:
            self.counts = counts
            return NOWHERE
        last = self.counts
        left, right = map(self.difference, counts, last)
        if not self.fits(reading, elapsed, expected, lost_share):
            self.rejected += 1
            before, time = self.before or (None, 0.0)
            # if only the last counts do not fit, they were corrupted: this travel takes back what they have added
            if self.rejected < WRONG or before is None or not self._are_near(counts, before, time + elapsed):
                if self.rejected >= RESET:
                    self.restart()
                return None
        self.counts, self.before, self.rejected = counts, (last, elapsed), 0
        # from half a wrap on, the encoders may have wrapped
        wrap = self.WRAP * self.scale
        sigma = wrap if max(abs(each) for each in expected) > wrap / 2 else 0.0
        return Travel((left + right) / 2, (right - left) / self.width, sigma ** 2, (2 / self.width * sigma) ** 2)

    def fits(self, reading: Mapping[str, int], elapsed: float, expected: Expected, lost_share: float) -> bool:
        """Return whether a robot may have traveled so far since the last good reading. For the arguments see update().
        """
        new, old = (reading['left_encoder'], reading['right_encoder']), self.counts
        return old is None or self._are_near(new, old, elapsed)

    def _are_near(self, new: tuple[int, int], old: tuple[int, int], elapsed: float) -> bool:
        return max(abs(self.difference(*each)) for each in zip(new, old)) <= reach(elapsed)

    def is_reset(self, reading: Mapping[str, int]) -> bool:
        """Return whether this may be the reading of a robot that counts from 0 again."""
        def is_zero(count: int) -> bool:
            return abs(self.difference(count, 0)) < MARGIN
        return (is_zero(reading['left_encoder']) and is_zero(reading['right_encoder'])
                and not all(map(is_zero, self.counts or (0, 0))))

    def difference(self, new: int, old: int) -> float:
        """Return the travel (m) between two counts: at most half a wrap, which is 15 m."""
        return ((new - old + self.WRAP // 2) % self.WRAP - self.WRAP // 2) * self.scale

    def wants_angle(self, elapsed: float, expected: Expected) -> bool:
        """Return whether the next query is to ask for all counters: see CounterTravel."""
        return True

    def miss(self, elapsed: float, expected: Expected) -> None:
        """Handle a lost reply to a query. expected: commanded travel from the last good reading to this query,
        `elapsed` s later."""


class CounterTravel:
    """Like EncoderTravel, for the Create: distance and angle since the last reply. A lost reply loses this travel."""

    CAP = 32767     # mm or degrees at which the robot stops counting
    resets = True

    def __init__(self, model: Model, fractions: Fractions) -> None:
        """model: one without encoders."""
        self.width = model.wheel_separation
        self.fractions = fractions
        self.rounding = 1e-3 * ROUND, radians(1) * ROUND
        self.restart()

    def restart(self) -> None:
        self.first = True
        self.lost, self.lost_time = STILL, 0.0      # commanded travel and time (s) before the last lost reply
        self.asks_angle = True  # whether the last query asks for the angle
        self.fractions.finish_reading()

    def _turn(self, expected: Expected) -> float:
        """Return a turn in degrees."""
        return degrees((expected.right - expected.left) / self.width)

    @property
    def unread_variance(self) -> float:
        """The variance (rad^2) of the turn that was commanded and has not been read yet."""
        return radians(UNSURE * self.fractions.unread) ** 2

    def wants_angle(self, elapsed: float, expected: Expected) -> bool:
        """Return whether the next query is to ask for the angle. expected: commanded travel since the last good
        reading, `elapsed` s ago."""
        self.asks_angle = self.first or self.fractions.is_due(self._turn(expected), elapsed)
        return self.asks_angle

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected, lost_share: float
               ) -> Travel | None:
        if self.first:
            self.restart()
            self.first = False
            return NOWHERE
        distance, angle = reading['distance'] / 1000, reading['angle'] if self.asks_angle else None
        if not self.fits(reading, elapsed, expected, lost_share):
            return None
        lost, sigma = self._lost_distance(distance, elapsed, expected)
        sigma = hypot(sigma, DOUBT * lost_share ** 1.5 * reach(elapsed))    # this reading may be corrupted, too
        if max(abs(reading['distance']), abs(angle or 0)) >= self.CAP:
            sigma = ANYWHERE
        turned = self.fractions.update(self._turn(expected), elapsed, angle)
        self.lost, self.lost_time = STILL, 0.0
        return Travel(distance + lost, radians(turned.angle), sigma ** 2,
                      (2 / self.width * sigma) ** 2 + radians(1) ** 2 * turned.variance)

    def fits(self, reading: Mapping[str, int], elapsed: float, expected: Expected, lost_share: float) -> bool:
        if self.first:
            return True
        if not self.asks_angle:
            return abs(reading['distance']) / 1000 <= reach(elapsed)
        time = self.fractions.time + elapsed        # in which the angle was counted
        turn, commanded = reading['angle'], self.fractions.turn + self._turn(expected)
        # a corrupted angle after a long time may look possible; on a line that loses nothing, somebody turns the robot
        error = min(abs(turn - commanded), abs(turn - commanded + self.fractions.lost))
        if lost_share > DIRTY and elapsed < SILENT and error > DOUBTFUL + DOUBT * abs(commanded):
            return False
        share = elapsed / time if time else 1.0
        return abs(reading['distance']) / 1000 + radians(abs(turn)) * share * self.width / 2 <= reach(elapsed)

    def _lost_distance(self, distance: float, elapsed: float, expected: Expected) -> tuple[float, float]:
        """Return (distance, 1 sigma): the travel before a lost reply that the reading does not include."""
        lost, total = ((each.left + each.right) / 2 for each in (self.lost, expected))
        lost, sigma = lost_part(lost, total - lost, distance, 2 * (self.rounding[0] + UNSURE * abs(total - lost)))
        if not lost:
            return 0.0, 0.0
        # where the wheels do not follow the commands, either the commands or the reading are closer to the truth
        follow = distance * self.lost_time / max(elapsed - self.lost_time, self.lost_time)
        return lost, sigma + abs(lost - follow)

    @staticmethod
    def is_reset(reading: Mapping[str, int]) -> bool:
        return reading['distance'] == 0 and reading.get('angle', 0) == 0

    def miss(self, elapsed: float, expected: Expected) -> None:
        if not self.first:
            self.lost, self.lost_time = expected, elapsed
            if self.asks_angle:
                self.fractions.lose(self._turn(expected))


Counter = Union[EncoderTravel, CounterTravel]


class State(NamedTuple):
    """A report of the robot's motion."""

    time: int                       # ns, time of the last reading
    pose: Pose
    covariance: Covariance
    velocity: tuple[float, float]   # m/s and rad/s, the mean since the last State
    variances: tuple[float, float]  # of both velocities
    travel: tuple[float, float]     # m, left and right wheel
    gyro: Reading | None


class MotionReport:
    """Accumulates Travel. Times are in ns."""

    def __init__(self, settings: Settings, model: Model, rounding: tuple[float, float]) -> None:
        """rounding: see UncertainOdometry."""
        self.width = model.wheel_separation
        self.corrections = settings.odom_linear_scale_correction, settings.odom_angular_scale_correction
        self.rounding = rounding
        self.moving_yaw_variance = settings.moving_yaw_variance
        self.odometry = UncertainOdometry(self.width, settings.errors, rounding)
        self.left = self.right = 0.0    # m, total travel of the wheels as the robot counts it
        self.time: int | None = None        # time of the last Travel
        self.moved_time: int | None = None  # time of the last nonzero travel or command to move
        self.reported: int | None = None    # time of the last State
        self.since = NOWHERE                # Travel since the last State

    def command(self, now: int) -> None:
        """Note that the wheels were commanded to move."""
        self.moved_time = now

    def add(self, time: int, travel: Travel) -> Travel:
        """Add a Travel that finished at `time`. Returns the corrected Travel."""
        linear, angular = self.corrections
        corrected = Travel(travel.distance * linear, travel.angle * angular,
                           travel.distance_variance * linear ** 2, travel.angle_variance * angular ** 2)
        self.odometry.move(corrected)
        self.since = Travel(*(sum(parts) for parts in zip(self.since, corrected)))
        difference = travel.angle * self.width / 2
        self.left += travel.distance - difference
        self.right += travel.distance + difference
        self.time = time
        if travel.distance or travel.angle or self.moved_time is None:
            self.moved_time = time
        return corrected

    def reset(self) -> None:
        """Put the odometry back at the origin."""
        self.odometry = UncertainOdometry(self.width, self.odometry.errors, self.rounding)
        self.since = NOWHERE

    @property
    def stands(self) -> bool:
        """Whether the robot has neither moved nor been commanded to move for STANDSTILL."""
        return self.time is not None and self.moved_time is not None and self.time - self.moved_time >= STANDSTILL

    def state(self, gyro: Reading | None, unread_variance: float = 0.0) -> State:
        """Return the State, with the gyro's last Reading or None. unread_variance: see CounterTravel. Call it after
        add()."""
        assert self.time is not None
        elapsed = (self.time - self.reported) / SECOND if self.reported is not None else 0.0
        velocity, variances = (0.0, 0.0), (MEASURED, MEASURED)
        if elapsed > 0 and (any(self.since) or not self.stands):
            velocity = self.since.distance / elapsed, self.since.angle / elapsed
            # the error is the difference of two rounding errors
            errors = self.odometry.errors.variances(self.since.distance, self.since.angle)
            linear, angular = ((variance + error + 2 * rounding ** 2) / elapsed ** 2 + MEASURED
                               for variance, error, rounding in zip(self.since[2:], errors, self.rounding))
            variances = linear, angular
        x, y, (x_yaw, y_yaw, yaw) = self.odometry.covariance
        yaw += unread_variance
        if self.moving_yaw_variance and any(velocity):
            yaw = self.moving_yaw_variance
            variances = variances[0], self.moving_yaw_variance
        self.reported, self.since = self.time, NOWHERE
        return State(self.time, self.odometry.pose, (x, y, (x_yaw, y_yaw, yaw)), velocity, variances,
                     (self.left, self.right), gyro)
