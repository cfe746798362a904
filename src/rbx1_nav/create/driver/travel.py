"""Converts the robot's counters to travel, and handles wraps, gaps and implausible readings."""
from __future__ import annotations

from math import degrees, radians
from typing import Mapping, NamedTuple, Protocol

from rbx1_nav.create.driver.fractions import LOST, Fractions
from rbx1_nav.create.protocol import MAX_SPEED, Model

WHEEL_LIMIT = 1.3 * MAX_SPEED / 1000    # m/s: faster than any wheel
MARGIN = 0.015          # m of wheel travel that one reading may miss and the next one include
AGREED = 3              # consecutive implausible readings that agree, which show that the robot was reset
LOST_SHARE = 0.1        # 1 sigma of an expected travel that was never read, as a fraction of it
MEMORY = 0.02           # weight of the last reply in the share of lost replies, which covers about 50 replies
BAD_LINE = 0.015        # share of lost replies, reached after one loss: other replies may be corrupted undetected
DOUBT = 0.005           # m: on a bad line, a larger difference between read and expected wheel travel is doubtful
REPLY_SIZE = 30         # bytes
LONG = 0.3              # s without a reading after which the next reading cannot be compared with the previous one
ROUND = 1 / 12 ** 0.5   # 1 sigma of rounding to a whole number


class Travel(NamedTuple):
    """An arc, with the variances of its length and angle excluding rounding and slip."""

    distance: float             # m
    angle: float                # rad
    distance_variance: float    # m^2
    angle_variance: float       # rad^2


class Expected(NamedTuple):
    """The wheel travel (m) expected from the commands that were sent."""

    left: float
    right: float

    def plus(self, other: Expected) -> Expected:
        """Return the sum of both."""
        return Expected(self.left + other.left, self.right + other.right)

    def largest(self) -> float:
        """Return the travel of the wheel that travels farther, as an absolute value."""
        return max(abs(self.left), abs(self.right))


NOWHERE = Travel(0.0, 0.0, 0.0, 0.0)
STILL = Expected(0.0, 0.0)


class Implausible(ValueError):
    """A reading that no robot could produce: it is corrupted, or the robot has been reset."""


class Counter(Protocol):
    """Converts counts to Travel. elapsed: s since the last good reading; expected: commanded travel in this time."""

    @property
    def rounding(self) -> tuple[float, float]:
        """1 sigma (m, rad) of a position and a heading that are counted in whole units."""

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected) -> Travel:
        """Return the Travel since the last good reading. Raises Implausible."""

    def miss(self, begun: bool, elapsed: float, expected: Expected) -> None:
        """Handle a reading that was lost on the line. begun: whether a part of it arrived."""

    def restart(self) -> None:
        """Handle a robot that counts from 0 again: the next reading yields no travel."""

    def is_reset(self, reading: Mapping[str, int]) -> bool:
        """Return whether this may be the reading of a robot that counts from 0 again."""


def is_possible(left: float, right: float, elapsed: float) -> bool:
    """Return whether wheels can travel these distances (m) in `elapsed` seconds."""
    return max(abs(left), abs(right)) <= WHEEL_LIMIT * elapsed + MARGIN


def _distance(one: Expected, other: Expected) -> float:
    """Return the larger of the two wheels' differences, m."""
    return max(abs(one.left - other.left), abs(one.right - other.right))


def bridged(expected: Expected, measured: Expected, width: float) -> Travel:
    """Return the Travel that was not read, as expected from the commands. measured: travel at the speeds of the last
    reading; where the two differ, the wheels do not follow the commands, and either may be closer to the truth."""
    left, right = expected
    deviations = [abs(one - other) + LOST_SHARE * abs(one) for one, other in zip(expected, measured)]
    variance = sum(deviation ** 2 for deviation in deviations)
    return Travel((left + right) / 2, (right - left) / width, variance / 4, variance / width ** 2)


def unknown(expected: Expected, width: float) -> Travel:
    """Return the Travel of a robot that moved as commanded for an unknown part of the time, uniformly distributed."""
    left, right = expected
    return Travel(0.0, 0.0, ((left + right) / 2) ** 2 / 3, ((right - left) / width) ** 2 / 3)


class EncoderTravel:
    """Travel of the Create 2, from 16-bit encoders that wrap."""

    WRAP = 1 << 16

    def __init__(self, model: Model) -> None:
        """model: one with encoders."""
        assert model.counts_per_metre
        self.scale = 1 / model.counts_per_metre
        self.width = model.wheel_separation
        self.rounding = self.scale * ROUND / 2 ** 0.5, 2 ** 0.5 * self.scale * ROUND / self.width
        self.restart()

    def restart(self) -> None:
        self.counts: tuple[int, int] | None = None
        self.suspect: tuple[int, int] | None = None     # implausible counts
        self.suspected = 0      # number of consecutive implausible counts that agree

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected) -> Travel:
        counts = reading['left_encoder'], reading['right_encoder']
        if self.counts is None:
            self.counts = counts
            return NOWHERE
        before = self.counts
        left, right = (self.difference(new, old, travel) for new, old, travel in zip(counts, before, expected))
        if not is_possible(left, right, elapsed):
            self.check_reset(counts)
            raise Implausible(f'encoders: {counts[0]} and {counts[1]} after {before[0]} and {before[1]}')
        self.counts, self.suspected = counts, 0
        # beyond half a wrap, the number of wraps follows from commands that the robot may not have followed
        unsure = sum((self.WRAP * self.scale) ** 2 for travel in expected if abs(travel) > self.WRAP / 2 * self.scale)
        return Travel((left + right) / 2, (right - left) / self.width, unsure / 4, unsure / self.width ** 2)

    def is_reset(self, reading: Mapping[str, int]) -> bool:
        counts = [reading[name] for name in ('left_encoder', 'right_encoder')]
        return (all(abs(self.difference(count, 0, 0.0)) < MARGIN for count in counts)
                and not all(abs(self.difference(count, 0, 0.0)) < MARGIN for count in self.counts or (0, 0)))

    def difference(self, new: int, old: int, expected: float) -> float:
        """Return the travel (m) between two counts: of all travels that fit these counts, the closest to `expected`."""
        low = (new - old + self.WRAP // 2) % self.WRAP - self.WRAP // 2
        wraps = round((expected / self.scale - low) / self.WRAP)
        return (low + self.WRAP * wraps) * self.scale

    def check_reset(self, counts: tuple[int, int]) -> None:
        """Restart if implausible readings agree with each other: they come from a robot that counts from 0 again."""
        agrees = self.suspect and all(abs(self.difference(new, old, 0.0)) <= 2 * MARGIN
                                      for new, old in zip(counts, self.suspect))
        self.suspected = self.suspected + 1 if agrees else 1
        self.suspect = counts
        if self.suspected >= AGREED:
            self.restart()
            self.counts = counts

    def miss(self, begun: bool, elapsed: float, expected: Expected) -> None:
        """Do nothing: the encoders keep counting, so no travel is lost."""


class CounterTravel:
    """Travel of the Create, from distance and angle since the last reply. A lost reply loses the travel it reported.
    If the robot may lose fractions of a degree, the turn between two readings of the angle follows the commands."""

    CAP = 32767     # mm or degrees at which the robot stops counting

    def __init__(self, model: Model, fractions: Fractions) -> None:
        """model: one without encoders."""
        self.width = model.wheel_separation
        self.fractions = fractions
        self.rounding = 1e-3 * ROUND, radians(1) * ROUND
        self.restart()

    def restart(self) -> None:
        self.first = True
        self.lost: list[Travel] = []    # travel of lost replies
        self.doubtful = STILL   # commanded travel before queries that may or may not have reached the robot
        self.speed = STILL      # m/s, wheel speeds in the last reading
        self.bad = 0.0          # share of the last replies that were lost
        self.asks_angle = True  # whether the last query asks for the angle
        self._begin_angle()

    def _begin_angle(self) -> None:
        # since the last reading of the angle: time (s), commanded turn (rad), turn returned by update() (rad)
        self.angle_time = self.commanded_turn = self.returned_turn = 0.0

    def _turn(self, expected: Expected) -> float:
        return (expected.right - expected.left) / self.width

    def wants_angle(self, expected: Expected) -> bool:
        """Return whether the next query is to ask for the angle. expected: commanded travel since the last query."""
        turn = degrees(self.commanded_turn + self._turn(expected))
        self.asks_angle = self.fractions.is_due(turn, self.angle_time)
        return self.asks_angle

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected) -> Travel:
        distance = reading['distance'] / 1000
        if self.first:
            self.restart()
            self.first = False
            return NOWHERE
        time, turn = self.angle_time + elapsed, self._turn(expected)
        # the share of the last interval, if the angle covers a longer time
        angle = radians(reading['angle']) * (elapsed / time if time else 1.0) if self.asks_angle else turn
        wheels = Expected(distance - angle * self.width / 2, distance + angle * self.width / 2)
        if not is_possible(*wheels, elapsed):
            raise Implausible(f"distance: {reading['distance']} mm, angle: {reading.get('angle')} degrees in "
                              f'{elapsed:.3f} s')
        capped = abs(reading['distance']) >= self.CAP or (self.asks_angle and abs(reading['angle']) >= self.CAP)
        cap_variance = 100.0 if capped else 0.0
        angle, variance = self._read_angle(reading, time, turn)
        doubtful = self._doubt(wheels, expected, elapsed)
        resolved = self._resolve(wheels, expected)
        if self.fractions.coarse:       # the robot keeps counting the angle
            resolved = resolved._replace(angle=0.0)
        parts = [Travel(distance, angle, cap_variance, cap_variance + variance), resolved, *self.lost, doubtful]
        if elapsed > 0 and not self.lost and not any(resolved):
            self.speed = Expected(*(wheel / elapsed for wheel in wheels))
        self.lost.clear()
        self.doubtful = STILL
        return Travel(*map(sum, zip(*parts)))

    def _doubt(self, wheels: Expected, expected: Expected, elapsed: float) -> Travel:
        """Return the Travel by which to correct a reading. wheels: travel that was read.

        A reply has no checksum, so on a bad line some corrupted replies are not detected. A reply that differs from
        the expected travel is corrected: by half of the difference, or by all of it if the expectations agree.
        """
        self.bad *= 1 - MEMORY
        if self.bad < BAD_LINE or elapsed > LONG:
            return NOWHERE
        by_speed = Expected(*(speed * elapsed for speed in self.speed))
        with_doubtful = expected.plus(self.doubtful)
        far = DOUBT + LOST_SHARE * expected.largest()
        closest = min((expected, with_doubtful, by_speed), key=lambda each: _distance(wheels, each))
        if _distance(wheels, closest) > far:
            # if the robot keeps its speed, the reading is corrupted; otherwise the speed may have changed
            share = 1.0 if _distance(expected, by_speed) < far else 0.5
            less = Expected(*(share * (one - other) for one, other in zip(closest, wheels)))
            unsure = Expected(*((1 - share) * abs(each) + DOUBT for each in less))
            return bridged(less, less, self.width)._replace(
                distance_variance=sum(each ** 2 for each in unsure) / 4,
                angle_variance=sum(each ** 2 for each in unsure) / self.width ** 2)
        # an undetected error of one bit in the two low bytes
        variance = 2 * self.bad / REPLY_SIZE * DOUBT ** 2
        return Travel(0.0, 0.0, variance / 4, variance / self.width ** 2)

    def _read_angle(self, reading: Mapping[str, int], time: float, turn: float) -> tuple[float, float]:
        """Return (turn since the last update in rad, its variance excluding rounding). time: s since the angle was read
        before; turn: commanded turn since the last update, rad."""
        self.commanded_turn += turn
        if self.asks_angle:
            whole = self.fractions.add(degrees(self.commanded_turn), reading['angle'], time)
            angle = radians(whole) - self.returned_turn
            coarse = self.fractions.kind == LOST or bool(self.returned_turn)
            self._begin_angle()
        else:
            angle, coarse, self.angle_time = turn, True, time
            self.returned_turn += turn
        angle += radians(self.fractions.make_up())
        # the turn returned before was wrong by about as much as the angle differs now
        variance = (angle - turn) ** 2 / 4 + (self.rounding[1] ** 2 if self.asks_angle else 0.0)
        return angle, variance if coarse else 0.0

    def _resolve(self, wheels: Expected, expected: Expected) -> Travel:
        """Return the Travel lost by doubtful queries. wheels: the travel that was read afterwards.

        If they did not arrive, `wheels` includes the travel before them. If this is unclear, the result is half of that
        travel, plus or minus half.
        """
        doubtful = self.doubtful
        size = doubtful.largest()
        if not size:
            return NOWHERE
        answered = max(abs(wheel - part) for wheel, part in zip(wheels, expected))
        ignored = max(abs(wheel - part - other) for wheel, part, other in zip(wheels, expected, doubtful))
        if size > 2 * (LOST_SHARE * expected.largest() + self.rounding[0] + self.rounding[1] * self.width):
            return NOWHERE if ignored < answered else bridged(doubtful, doubtful, self.width)
        return bridged(Expected(*(part / 2 for part in doubtful)), STILL, self.width)

    @staticmethod
    def is_reset(reading: Mapping[str, int]) -> bool:
        return reading['distance'] == 0 and reading.get('angle', 0) == 0

    def miss(self, begun: bool, elapsed: float, expected: Expected) -> None:
        self.fractions.disturb()
        self.bad += (1 - self.bad) * MEMORY
        if not begun:
            self.doubtful = self.doubtful.plus(expected)
            return
        measured = Expected(*(speed * elapsed for speed in self.speed))
        part = bridged(expected, measured, self.width)
        self.lost.append(part)
        if self.asks_angle:
            self._begin_angle()
        else:
            self.commanded_turn += self._turn(expected)
            self.returned_turn += part.angle


def travel_of(model: Model, fractions: Fractions) -> EncoderTravel | CounterTravel:
    """Return the Counter for a robot of this Model. fractions: used for a robot without encoders."""
    return EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, fractions)
