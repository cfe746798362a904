"""Reads the angle of a Create, which may keep or drop the fraction of a degree at each reading.

According to the specification, each reading continues where the last one stopped. But some robots start each reading at
0 and drop the fraction (libcreate, issue 22; create_robot, issue 28). At 30 readings per second and 1 rad/s, they lose
a third of the turn.

A test shows which kind of robot this is: in a steady turn, the angle is read so often that the robot turns by less than
a degree between two readings. A robot that keeps fractions reports this turn in steps of 1 degree. A robot that drops
them reports zeros, although the next reading, 10 degrees later, shows that it turns. Before the test, and on a robot
that drops fractions, the angle is read rarely, and the heading follows the commands in between.
"""
from __future__ import annotations

from math import ceil, copysign
from typing import Callable, NamedTuple

from rbx1_nav.base.units import clamp
from rbx1_nav.extras.create.protocol import UPDATE_PERIOD
from rbx1_nav.node.config import AUTO

KEPT, LOST = 'kept', 'lost'
KINDS = (AUTO, KEPT, LOST)

STEADY = 0.3            # s after a change of the commanded turn in which the robot may still lag
BELOW = 0.95            # maximum number of degrees between two readings of the test
ENOUGH = 4.0            # degrees of such readings that show which kind of robot this is, if they are all zeros
ROUNDS = 2              # number of times that this must happen: the wheels may have been blocked for a while
TURNS = 0.3             # part of the commanded turn from which the robot turns: on carpet, slow wheels lag
SLOWER = 0.8            # factor for the rate of the test after a reading that came too late
CHECK_ANGLE = 10.0      # degrees after which a reading shows whether a robot that reported zeros turns
MIN_CHECK = 4.0         # degrees: minimum, if the robot stops before
COARSE_ANGLE = {AUTO: 45.0, LOST: 14.0}     # degrees between two readings: the fewer readings, the less is dropped
COARSE_TIME = 0.9       # s between two readings of a robot that is not commanded to turn
VARIATION = 0.3         # relative variation of both: with equal intervals, each could drop the same fraction
GOLDEN = (5 ** 0.5 - 1) / 2     # its multiples are spread evenly between whole numbers
MEAN_LOSS = {KEPT: 0.0, AUTO: 0.25, LOST: 0.5}     # degrees of a reading: a fraction is uniformly distributed
LOSS_VARIANCE = 1 / 6    # degrees^2, of a reading that drops a fraction, or may do so
MAX_CORRECTION = 120.0  # degrees/s: a filter would mistake a large jump of the heading for a change of place
GAP = 0.3               # s without a reading after which the angle is read
UNSURE = 0.1            # 1 sigma of a commanded turn that was not read, as a part of it
UNCERTAIN = 1.0         # degrees: a lost turn of this size does not show in the next reading


class CountedTurn(NamedTuple):
    """A turn in degrees, and its variance in degrees^2 without rounding."""

    angle: float
    variance: float


NO_TURN = CountedTurn(0.0, 0.0)


def lost_part(lost: float, after: float, reading: float, uncertain: float) -> tuple[float, float]:
    """Return (motion, 1 sigma): the motion before a lost reply that the next reading does not include. It includes all
    of it if the query was lost instead. lost, after: commanded motion before and after this query; uncertain: a smaller
    `lost` does not show in the reading."""
    if abs(lost) <= uncertain:
        return lost, abs(lost)
    return (0.0, 0.0) if abs(reading - after - lost) < abs(reading - after) else (lost, UNSURE * abs(lost))


class Fractions:
    """Decides when to read the angle, and converts the readings to turns. Angles are in degrees."""

    def __init__(self, kind: str = AUTO, warn: Callable[[str], None] = lambda text: None) -> None:
        """kind: one of KINDS; warn: logs a line."""
        self.kind = kind
        self._warn = warn
        self._count = 0                         # number of readings
        self._rate = self._steady = 0.0         # commanded rate (degrees/s), and for how long (s)
        self.turn = self.time = 0.0             # commanded turn and time (s) since the last reading of the angle
        self._lost = 0.0                        # the part of `turn` before a lost reply
        self._owed = 0.0                        # correction of the commanded turn that was not returned yet
        self._fastest = BELOW / UPDATE_PERIOD   # degrees/s up to which this line allows the test
        self._begin_test()

    def _begin_test(self) -> None:
        self._checking = False
        self._tested = self._tested_turn = 0.0      # absolute and signed commanded turn between readings of the test
        self._rounds = 0                    # number of checks that have shown that the robot turns
        self._shown = self._shown_turn = 0.0    # what these readings show

    @property
    def hurries(self) -> bool:
        """Whether to query the robot again as soon as it has replied."""
        return (self.kind == AUTO and not self._checking and self._steady > STEADY
                and 0 < abs(self._rate) <= self._fastest)

    @property
    def unread(self) -> float:
        """The turn that was reported and not read."""
        return self.turn + self._tested_turn - self._owed

    def is_due(self, turn: float, time: float) -> bool:
        """Return whether to read the angle now. turn, time: commanded turn and time (s) since the last update."""
        if self.kind == KEPT or self.hurries or time > GAP:
            return True
        factor = 1 + VARIATION * (self._count * GOLDEN % 1)
        angle = CHECK_ANGLE if self._checking else COARSE_ANGLE[self.kind]
        return abs(self.turn + turn) >= factor * angle or (not turn and self.time + time >= factor * COARSE_TIME)

    def lose(self, turn: float) -> None:
        """Handle a lost reply with an angle. turn: commanded turn from the last update to the query."""
        self._lost = self.turn + turn

    def finish_reading(self) -> None:
        """Note that the robot starts to count the angle from 0."""
        self.turn = self.time = self._lost = 0.0

    def update(self, commanded: float, elapsed: float, angle: int | None) -> CountedTurn:
        """Return the turn since the last update. commanded: commanded turn; elapsed: s; angle: the reading, or None."""
        rate = commanded / elapsed if elapsed > 0 else 0.0
        self._steady = self._steady + elapsed if abs(rate - self._rate) <= 0.2 * abs(rate) else 0.0
        self._rate = rate
        ahead = self.turn
        self.turn += commanded
        self.time += elapsed
        variance = 0.0
        if angle is not None:
            turn, variance = self._add(commanded, elapsed, angle)
            self._owed += turn - commanded - ahead
        part = clamp(self._owed, MAX_CORRECTION * elapsed)
        self._owed -= part
        return CountedTurn(commanded + part, variance)

    def _add(self, commanded: float, elapsed: float, angle: int) -> CountedTurn:
        """Return the CountedTurn since the last reading of the angle."""
        self._count += 1
        if self.hurries and self.time == elapsed and not self._lost:
            if abs(self._rate) * UPDATE_PERIOD * ceil(elapsed / UPDATE_PERIOD) <= BELOW:
                self.finish_reading()
                return self._test(commanded, angle)
            self._fastest *= SLOWER
        tested = self._check(angle) if self._checking else NO_TURN
        turn, variance = self._read(angle)
        self.finish_reading()
        return CountedTurn(turn + tested.angle, variance + tested.variance)

    def _read(self, angle: int) -> CountedTurn:
        """Return the CountedTurn since the last reading."""
        lost, sigma = lost_part(self._lost, self.turn - self._lost, angle, UNCERTAIN)
        turn = angle + lost + (copysign(MEAN_LOSS[self.kind], angle) if angle else 0.0)
        return CountedTurn(turn, sigma ** 2 + (LOSS_VARIANCE if self.kind != KEPT and (angle or self.turn) else 0.0))

    def _test(self, commanded: float, angle: int) -> CountedTurn:
        """Add a reading before which the robot has turned by less than a degree."""
        self._tested += abs(commanded)
        self._tested_turn += commanded
        self._shown += angle if commanded > 0 else -angle
        self._shown_turn += angle
        part = self._tested - ENOUGH * self._rounds
        if not -1 <= self._shown <= 1.5 * self._tested + 2:     # the robot is pushed
            self._steady = 0.0
            return self._finish_test(self.kind, commanded)
        if part < ENOUGH or self._shown == 0:
            self._checking = part >= ENOUGH
            return CountedTurn(commanded, 0.0)
        # fewer: its wheels were blocked for a part of the time
        return self._finish_test(KEPT if self._shown >= TURNS * part else self.kind, commanded)

    def _check(self, angle: int) -> CountedTurn:
        """Check whether a robot that reported zeros turns. angle: the reading after them."""
        share = (angle + copysign(MEAN_LOSS[LOST], angle)) / self.turn if self.turn else 0.0
        if abs(self.turn) < MIN_CHECK or share > 1.5:
            return NO_TURN
        if share < TURNS:   # the wheels are blocked
            return self._finish_test(self.kind, 0.0)
        self._checking = False
        self._rounds += 1
        if self._rounds < ROUNDS:
            return NO_TURN
        self._shown_turn = share * self._tested_turn
        return self._finish_test(LOST, 0.0)

    def _finish_test(self, kind: str, commanded: float) -> CountedTurn:
        """Return the CountedTurn that replaces the commands during the test by what was read. kind: the result."""
        if kind == AUTO and self._rounds:   # a check has shown that the robot turned
            self._shown_turn += self._tested_turn * self._rounds * ENOUGH / self._tested
        if kind != self.kind:
            self.kind = kind
            if kind == LOST:
                self._warn('The robot loses fractions of a degree: correcting the odometry. Set '
                           'angle_fractions:=lost to correct it from the start')
        turn = CountedTurn(commanded + self._shown_turn - self._tested_turn,
                    0.0 if kind == KEPT else (UNSURE * self._tested_turn) ** 2)
        self._begin_test()
        return turn
