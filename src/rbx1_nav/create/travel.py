"""From what the robot counts to travel: wraps, gaps, and readings that cannot be true.

Both classes have

    update(reading, elapsed, expected)  the Travel since the last good reading; raises Implausible
    miss(begun, elapsed, expected)      a reading was lost on the line; begun: whether a part of it arrived
    restart()                           the robot counts from 0 again: the next reading is no travel
    is_new(reading)                     whether this may be the reading of a robot that was just switched on
    rounding                            (m, rad): 1 sigma of a position and a heading that are counted in whole units

    elapsed: s since the last good reading; expected: Expected travel by the commands in the same time.
"""
from collections import namedtuple
from math import radians

from rbx1_nav.create.protocol import MAX_SPEED

WHEEL_LIMIT = 1.3 * MAX_SPEED / 1000    # m/s: faster than any wheel
MARGIN = 0.015          # m: the wheels' travel between two readings may be late by so much
AGREED = 3              # implausible readings in a row that agree: the robot was reset
LOST_SHARE = 0.1        # 1 sigma of an expected travel that was never read, a fraction of it
ROUND = 1 / 12 ** 0.5   # 1 sigma of rounding to a whole number

Travel = namedtuple('Travel', 'distance angle distance_variance angle_variance')
Travel.__doc__ = 'An arc: its length (m) and angle (rad), and their variances beyond rounding and slip (m^2, rad^2).'
NOWHERE = Travel(0.0, 0.0, 0.0, 0.0)

Expected = namedtuple('Expected', 'left right')
Expected.__doc__ = 'The travel of the wheels by the commands that were sent, m.'

STILL = Expected(0.0, 0.0)


class Implausible(ValueError):
    """A reading that no robot could produce: corrupted, or of a robot that was reset meanwhile."""


def is_possible(left, right, elapsed):
    """Whether wheels can travel so far (m) in `elapsed` seconds."""
    return max(abs(left), abs(right)) <= WHEEL_LIMIT * elapsed + MARGIN


def bridged(expected, measured, width):
    """The Travel that was not read: as the commands would have it. measured: Expected, by the speeds of the last
    reading; where the two differ, the wheels do not follow the commands, and who knows which is closer."""
    left, right = expected
    deviations = [abs(one - other) + LOST_SHARE * abs(one) for one, other in zip(expected, measured)]
    variance = sum(deviation ** 2 for deviation in deviations)
    return Travel((left + right) / 2, (right - left) / width, variance / 4, variance / width ** 2)


def unknown(expected, width):
    """The Travel of a robot that moved as commanded for some of the time, or not at all: uniform in between, from 0."""
    left, right = expected
    return Travel(0.0, 0.0, ((left + right) / 2) ** 2 / 3, ((right - left) / width) ** 2 / 3)


class EncoderTravel:
    """Of the Create 2: encoders of 16 bits that wrap."""

    WRAP = 1 << 16

    def __init__(self, model):
        """model: a Model with encoders."""
        self.scale = 1 / model.counts_per_metre
        self.width = model.wheel_separation
        self.rounding = self.scale * ROUND / 2 ** 0.5, 2 ** 0.5 * self.scale * ROUND / self.width
        self.restart()

    def restart(self):
        """See above."""
        self.counts = None
        self.suspect = None     # counts that were implausible
        self.suspected = 0      # how often in a row

    def update(self, reading, elapsed, expected):
        """See above."""
        counts = reading['left_encoder'], reading['right_encoder']
        if self.counts is None:
            self.counts = counts
            return NOWHERE
        left, right = (self.difference(new, old, travel)
                       for new, old, travel in zip(counts, self.counts, expected))
        if not is_possible(left, right, elapsed):
            self.check_reset(counts)
            raise Implausible('encoders: %s and %s after %s and %s' % (counts + self.counts))
        self.counts, self.suspected = counts, 0
        # beyond half a wrap, the commands decide how many there were, and they may not have been followed
        unsure = sum((self.WRAP * self.scale) ** 2 for travel in expected if abs(travel) > self.WRAP / 2 * self.scale)
        return Travel((left + right) / 2, (right - left) / self.width, unsure / 4, unsure / self.width ** 2)

    def is_new(self, reading):
        """See above."""
        return all(abs(self.difference(reading[name], 0, 0.0)) < MARGIN for name in ('left_encoder', 'right_encoder'))

    def difference(self, new, old, expected):
        """The travel (m) between two counts: of all that wrap to the same, the closest to that expected or to none."""
        low = (new - old + self.WRAP // 2) % self.WRAP - self.WRAP // 2
        wraps = round((expected / self.scale - low) / self.WRAP)
        return (low + self.WRAP * wraps) * self.scale

    def check_reset(self, counts):
        """Readings that are implausible but agree with each other come from a robot that counts from 0 again."""
        agrees = self.suspect and all(abs(self.difference(new, old, 0.0)) <= 2 * MARGIN
                                      for new, old in zip(counts, self.suspect))
        self.suspected = self.suspected + 1 if agrees else 1
        self.suspect = counts
        if self.suspected >= AGREED:
            self.restart()
            self.counts = counts

    def miss(self, begun, elapsed, expected):
        """See above: the encoders go on counting, nothing is lost."""


class CounterTravel:
    """Of the Create: distance and angle since the last reply. What a reply said that was lost is lost with it."""

    CAP = 32767     # mm or degrees, where the robot stops to count

    def __init__(self, model):
        """model: a Model without encoders."""
        self.width = model.wheel_separation
        self.rounding = 1e-3 * ROUND, radians(1) * ROUND
        self.restart()

    def restart(self):
        """See above."""
        self.first = True
        self.lost = []          # Travel of replies that were lost
        self.doubtful = STILL   # by the commands, before queries of which nobody knows if they arrived
        self.speed = STILL      # m/s, of the wheels by the last reading

    def update(self, reading, elapsed, expected):
        """See above."""
        distance, angle = reading['distance'] / 1000, radians(reading['angle'])
        if self.first:
            self.restart()
            self.first = False
            return NOWHERE
        wheels = Expected(distance - angle * self.width / 2, distance + angle * self.width / 2)
        if not is_possible(*wheels, elapsed):
            raise Implausible('distance: %s mm, angle: %s degrees in %.3f s'
                              % (reading['distance'], reading['angle'], elapsed))
        capped = abs(reading['distance']) >= self.CAP or abs(reading['angle']) >= self.CAP
        parts = [Travel(distance, angle, 100.0 * capped, 100.0 * capped), self._resolve(wheels, expected)] + self.lost
        if elapsed > 0 and len(parts) == 2:
            self.speed = Expected(*(wheel / elapsed for wheel in wheels))
        self.lost.clear()
        self.doubtful = STILL
        return Travel(*map(sum, zip(*parts)))

    def _resolve(self, wheels, expected):
        """The Travel that doubtful queries cost. wheels: the travel that was read at last.

        If they did not arrive, this includes the travel before them. If that cannot be seen: half, give or take half.
        """
        doubtful = self.doubtful
        size = max(map(abs, doubtful))
        if not size:
            return NOWHERE
        answered = max(abs(wheel - part) for wheel, part in zip(wheels, expected))
        ignored = max(abs(wheel - part - other) for wheel, part, other in zip(wheels, expected, doubtful))
        if size > 2 * (LOST_SHARE * max(map(abs, expected)) + self.rounding[0] + self.rounding[1] * self.width):
            return NOWHERE if ignored < answered else bridged(doubtful, doubtful, self.width)
        return bridged(Expected(*(part / 2 for part in doubtful)), STILL, self.width)

    @staticmethod
    def is_new(reading):
        """See above."""
        return reading['distance'] == reading['angle'] == 0

    def miss(self, begun, elapsed, expected):
        """See above."""
        if begun:
            measured = Expected(*(speed * elapsed for speed in self.speed))
            self.lost.append(bridged(expected, measured, self.width))
        else:
            self.doubtful = Expected(*map(sum, zip(self.doubtful, expected)))


def travel_of(model):
    """The object above for a Model."""
    return EncoderTravel(model) if model.counts_per_metre else CounterTravel(model)
