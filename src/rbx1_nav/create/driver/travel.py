"""Converts the robot's counters to travel, and handles wraps, gaps and implausible readings."""
from __future__ import annotations

from math import degrees, radians, sqrt
from typing import Mapping, NamedTuple

from rbx1_nav.create.driver.fractions import UNSURE, Fractions
from rbx1_nav.create.protocol import MAX_SPEED, Model

WHEEL_LIMIT = 1.3 * MAX_SPEED / 1000    # m/s: faster than any wheel
MARGIN = 0.015          # m of wheel travel that one reading may miss and the next one include
AGREED = 3              # consecutive implausible readings, which show that the robot was reset
LOST_SHARE = 0.1        # 1 sigma of an expected travel that was never read, as a fraction of it
MEMORY = 0.02           # weight of the last reply in the share of lost replies, which covers about 50 replies
BAD_LINE = 0.015        # share of lost replies, reached after one loss: other replies may be corrupted undetected
DOUBT = 0.005           # m: on a bad line, a larger difference between read and expected wheel travel is doubtful
REPLY_SIZE = 30         # bytes
LOW_BYTE = 0.128        # m, the largest error of a low byte, which no range can reveal
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


def reach(elapsed: float) -> float:
    """Return how far (m) a wheel can travel in `elapsed` seconds."""
    return WHEEL_LIMIT * elapsed + MARGIN


def is_possible(left: float, right: float, elapsed: float) -> bool:
    """Return whether wheels can travel these distances (m) in `elapsed` seconds."""
    return max(abs(left), abs(right)) <= reach(elapsed)


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
    """Travel of the Create 2, from 16-bit encoders that wrap. A lost reply loses no travel."""

    WRAP = 1 << 16
    unread_variance = 0.0   # each reading shows the whole turn: see CounterTravel
    hurries = False

    def __init__(self, model: Model) -> None:
        """model: one with encoders."""
        assert model.counts_per_metre
        self.scale = 1 / model.counts_per_metre
        self.width = model.wheel_separation
        # 1 sigma (m, rad) of a position and a heading that are counted in whole units
        self.rounding = self.scale * ROUND / 2 ** 0.5, 2 ** 0.5 * self.scale * ROUND / self.width
        self.bad = 0.0          # share of the last replies that were lost
        self.restart()

    def restart(self) -> None:
        """Handle a robot that counts from 0 again: the next reading yields no travel."""
        self.counts: tuple[int, int] | None = None
        self.rejected = 0       # number of consecutive implausible counts

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected) -> Travel:
        """Return the Travel since the last good reading, `elapsed` s ago. expected: commanded travel in this time.
        Raises Implausible."""
        counts = reading['left_encoder'], reading['right_encoder']
        if self.counts is None:
            self.counts = counts
            return NOWHERE
        before = self.counts
        left, right = (self.difference(new, old, travel) for new, old, travel in zip(counts, before, expected))
        if not is_possible(left, right, elapsed):
            self.rejected += 1
            if self.rejected >= AGREED:
                self.restart()
            raise Implausible(f'encoders: {counts[0]} and {counts[1]} after {before[0]} and {before[1]}')
        self.counts, self.rejected = counts, 0
        self.bad *= 1 - MEMORY
        # beyond half a wrap, the number of wraps follows from commands that the robot may not have followed
        unsure = sum((self.WRAP * self.scale) ** 2 for travel in expected if abs(travel) > self.WRAP / 2 * self.scale)
        return Travel((left + right) / 2, (right - left) / self.width, unsure / 4, unsure / self.width ** 2)

    def is_reset(self, reading: Mapping[str, int]) -> bool:
        """Return whether this may be the reading of a robot that counts from 0 again."""
        counts = [reading[name] for name in ('left_encoder', 'right_encoder')]
        return (all(abs(self.difference(count, 0, 0.0)) < MARGIN for count in counts)
                and not all(abs(self.difference(count, 0, 0.0)) < MARGIN for count in self.counts or (0, 0)))

    def difference(self, new: int, old: int, expected: float) -> float:
        """Return the travel (m) between two counts: of all travels that fit these counts, the closest to `expected`."""
        low = (new - old + self.WRAP // 2) % self.WRAP - self.WRAP // 2
        wraps = round((expected / self.scale - low) / self.WRAP)
        return (low + self.WRAP * wraps) * self.scale

    def miss(self, begun: bool, elapsed: float, expected: Expected) -> None:
        """Handle a reading that was lost on the line. begun: whether a part of it arrived."""
        self.bad += (1 - self.bad) * MEMORY


class CounterTravel:
    """Like EncoderTravel, for the Create: distance and angle since the last reply. A lost reply loses this travel."""

    CAP = 32767     # mm or degrees at which the robot stops counting

    def __init__(self, model: Model, fractions: Fractions) -> None:
        """model: one without encoders."""
        self.width = model.wheel_separation
        self.fractions = fractions
        self.rounding = 1e-3 * ROUND, radians(1) * ROUND
        self.bad = 0.0          # share of the last replies that were lost
        self.restart()

    def restart(self) -> None:
        self.first = True
        self.lost = NOWHERE     # travel of lost replies
        self.lost_time = 0.0    # s, time before the queries for which no reading was accepted
        self.doubtful = STILL   # commanded travel before queries that may or may not have reached the robot
        self.speed = STILL      # m/s, wheel speeds in the last reading
        self.rejected = 0       # number of consecutive doubtful readings
        self.asks_angle = True  # whether the last query asks for the angle
        self.fractions.lose(doubtful=False)

    def _turn(self, expected: Expected) -> float:
        """Return a turn in degrees."""
        return degrees((expected.right - expected.left) / self.width)

    @property
    def hurries(self) -> bool:
        """Whether to query the robot again as soon as it has replied."""
        return self.fractions.hurries

    @property
    def unread_variance(self) -> float:
        """The variance (rad^2) of the turn that was commanded and has not been read yet."""
        return radians(UNSURE * self.fractions.unread) ** 2

    def wants_angle(self, expected: Expected, elapsed: float) -> bool:
        """Return whether the next query is to ask for the angle. expected: commanded travel since the last query,
        `elapsed` s ago."""
        self.asks_angle = self.fractions.is_due(self._turn(expected), elapsed)
        return self.asks_angle

    def update(self, reading: Mapping[str, int], elapsed: float, expected: Expected) -> Travel:
        if self.first:
            self.restart()
            self.first = False
            return NOWHERE
        interval = elapsed - self.lost_time
        distance, turn = reading['distance'] / 1000, self._turn(expected)
        angle = reading['angle'] if self.asks_angle else None
        wheels = self._wheels(distance, turn if angle is None else self._share(angle, interval))
        comparable = interval <= LONG and not any(self.doubtful) and self.rejected < AGREED
        is_doubtful = self.bad >= BAD_LINE and comparable and self._is_doubtful(wheels, expected, interval)
        self.rejected = self.rejected + 1 if is_doubtful else 0
        if is_doubtful or not is_possible(*wheels, elapsed):
            raise Implausible(f"distance: {reading['distance']} mm, angle: {reading.get('angle')} degrees in "
                              f'{elapsed:.3f} s')
        capped = max(abs(reading['distance']), abs(angle or 0)) >= self.CAP
        unsure = 10.0 if capped else self._undetected(DOUBT if comparable else min(reach(elapsed), LOW_BYTE))
        turned = self.fractions.update(turn, interval, angle)
        parts = [Travel(distance, radians(turned.angle), unsure ** 2,
                        (2 / self.width * unsure) ** 2 + radians(1) ** 2 * turned.variance),
                 self._resolve(distance, expected), self.lost]
        if interval > 0 and not any(self.doubtful):
            self.speed = Expected(*(wheel / interval for wheel in wheels))
        self.lost, self.lost_time, self.doubtful = NOWHERE, 0.0, STILL
        self.bad *= 1 - MEMORY
        return Travel(*(sum(each) for each in zip(*parts)))

    def _wheels(self, distance: float, turn: float) -> Expected:
        half = radians(turn) * self.width / 2
        return Expected(distance - half, distance + half)

    def _share(self, angle: int, interval: float) -> float:
        """Return the part of an angle in the last `interval` s, if the angle was not read for a longer time."""
        time = self.fractions.time + interval
        return angle * interval / time if time else angle

    def _is_doubtful(self, wheels: Expected, expected: Expected, interval: float) -> bool:
        """Return whether a reading is probably corrupted: it is beyond both the commanded travel and the travel at the
        speed of the reading before. A reply has no checksum, so on a bad line some errors are not detected."""
        far = DOUBT + LOST_SHARE * expected.largest()
        by_speed = (speed * interval for speed in self.speed)
        return any(not min(limits) - far <= wheel <= max(limits) + far
                   for wheel, *limits in zip(wheels, expected, by_speed))

    def _undetected(self, size: float) -> float:
        """Return 1 sigma of an undetected error of at most `size`: one of the four bytes of distance and angle."""
        return size * sqrt((1 - (1 - self.bad) ** (4 / REPLY_SIZE)) / 3) if self.bad >= BAD_LINE else 0.0

    def _resolve(self, distance: float, expected: Expected) -> Travel:
        """Return the Travel lost by doubtful queries. distance: what was read afterwards. If they did not arrive, it
        includes the distance before them. Fractions handles the angle in the same way."""
        doubtful, after = (sum(each) / 2 for each in (self.doubtful, expected))
        if not any(self.doubtful):
            return NOWHERE
        lost = bridged(self.doubtful, self.doubtful, self.width)
        unclear = abs(doubtful) < 2 * (self.rounding[0] + LOST_SHARE * abs(after))
        if unclear:
            return Travel(doubtful / 2, 0.0, lost.distance_variance + (doubtful / 2) ** 2, lost.angle_variance)
        if abs(distance - after - doubtful) < abs(distance - after):
            return NOWHERE
        return lost._replace(angle=0.0)

    @staticmethod
    def is_reset(reading: Mapping[str, int]) -> bool:
        return reading['distance'] == 0 and reading.get('angle', 0) == 0

    def miss(self, begun: bool, elapsed: float, expected: Expected) -> None:
        self.bad += (1 - self.bad) * MEMORY
        if self.first:
            return
        turn = self._turn(expected)
        turned = self.fractions.update(turn, elapsed, None)
        self.lost_time += elapsed
        if begun:
            by_speed = Expected(*(speed * elapsed for speed in self.speed))
            part = bridged(expected, by_speed, self.width)
        else:
            self.doubtful = self.doubtful.plus(expected)
            part = NOWHERE
        unread = radians(UNSURE * self.fractions.turn) if self.asks_angle else 0.0
        if self.asks_angle:
            self.fractions.lose(doubtful=not begun)
        part = part._replace(angle=radians(turned.angle), angle_variance=part.angle_variance + unread ** 2)
        self.lost = Travel(*(one + other for one, other in zip(self.lost, part)))


def travel_of(model: Model, fractions: Fractions) -> EncoderTravel | CounterTravel:
    """Return the Counter for a robot of this Model. fractions: used for a robot without encoders."""
    return EncoderTravel(model) if model.counts_per_metre else CounterTravel(model, fractions)
