"""Reads the angle of a Create, which may keep or drop the fraction of a degree at each reading.

According to the specification, each reading continues where the last one stopped. But some robots start each reading at
0 and drop the fraction (libcreate, issue 22; create_robot, issue 28). At 30 readings per second and 1 rad/s, they lose
a third of the turn. The angle is therefore read rarely, and the heading follows the commands in between, unless the
robot is known to keep fractions.

A calibration shows which kind of robot this is: in a slow turn, the angle is read rarely for 45 degrees, then at each
update for 45 degrees. A robot that keeps fractions reports as much both times, one that drops them next to nothing at
each update. On carpet, both may turn by less than was commanded.
"""
from __future__ import annotations

from math import copysign
from typing import NamedTuple

from rbx1_nav.base.units import clamp
from rbx1_nav.node.config import AUTO

KEPT, LOST, TEST = 'kept', 'lost', 'test'
KINDS = (AUTO, KEPT, LOST, TEST)
MEASURED = 'measured: '     # result of the test

COARSE_ANGLE = 45.0     # degrees between two readings
COARSE_ANGLE_LOST = 14.0    # the same, of a robot that is known to drop fractions
COARSE_TIME = 0.9       # s between two readings of a robot that is not commanded to turn
VARIATION = 0.3         # relative variation of both: with equal intervals, each could drop the same fraction
GOLDEN = (5 ** 0.5 - 1) / 2     # its multiples are spread evenly between whole numbers
LOSS_VARIANCE = 1 / 6    # degrees^2, of a reading that drops a fraction, or may do so
MAX_CORRECTION = 120.0  # degrees/s: a filter would mistake a large jump of the heading for a change of place
GAP = 0.3               # s without a reading after which the angle is read
UNSURE = 0.1            # 1 sigma of a commanded turn that was not read, as a part of it
UNCERTAIN = 1.0         # degrees: a lost turn of this size does not show in the next reading
ENOUGH = 80.0           # degrees of each kind of reading that the test needs
SLOW = 0.6              # degrees between two frequent readings of the test: a robot that drops fractions reports 0
FOLLOWS = 0.25          # part of the commanded turn below which the robot hardly turns, so that the test shows nothing
SAME = 0.5              # ratio of both turns of the test below which the robot drops fractions


class CountedTurn(NamedTuple):
    """A turn in degrees, and its variance in degrees^2 without rounding."""

    angle: float
    variance: float


def lost_part(lost: float, after: float, reading: float, uncertain: float) -> tuple[float, float]:
    """Return (motion, 1 sigma): the motion before a lost reply that the next reading does not include. It includes all
    of it if the query was lost instead. lost, after: commanded motion before and after this query; uncertain: a smaller
    `lost` does not show in the reading."""
    if abs(lost) <= uncertain:
        return lost, abs(lost)
    return (0.0, 0.0) if abs(reading - after - lost) < abs(reading - after) else (lost, UNSURE * abs(lost))


class Fractions:
    """Decides when to read the angle, and converts the readings to turns. Angles are in degrees."""

    def __init__(self, kind: str = AUTO) -> None:
        """kind: one of KINDS."""
        self.kind = kind
        self._mean_loss = {KEPT: 0.0, LOST: 0.5}.get(kind, 0.25)    # a fraction is uniformly distributed
        self._angle = COARSE_ANGLE_LOST if kind == LOST else COARSE_ANGLE   # the fewer readings, the less is dropped
        self._count = 0                         # number of readings
        self.turn = self.time = 0.0             # commanded turn and time (s) since the last reading of the angle
        self.lost = 0.0                         # the part of `turn` before a lost reply
        self._owed = 0.0                        # correction of the commanded turn that was not returned yet
        # absolute turns of the test, with rare and with frequent readings: commanded, and read from the robot
        self._commanded, self._counted = [0.0, 0.0], [0.0, 0.0]

    @property
    def known(self) -> str:
        """What is known of the robot: its kind, or the result of the test."""
        if self.kind != TEST or min(self._commanded) < ENOUGH:
            return self.kind
        rare, frequent = (counted / commanded for counted, commanded in zip(self._counted, self._commanded))
        return TEST if rare < FOLLOWS else MEASURED + (KEPT if frequent > SAME * rare else LOST)

    @property
    def _is_frequent(self) -> bool:
        """Whether the test now reads the angle at each update."""
        return self.kind == TEST and sum(self._commanded) // COARSE_ANGLE % 2 == 1

    @property
    def unread(self) -> float:
        """The turn that was reported and not read."""
        return self.turn - self._owed

    def is_due(self, turn: float, time: float) -> bool:
        """Return whether to read the angle now. turn, time: commanded turn and time (s) since the last update."""
        if self.kind == KEPT or time > GAP or self._is_frequent:
            return True
        factor = 1 + VARIATION * (self._count * GOLDEN % 1)
        return abs(self.turn + turn) >= factor * self._angle or (not turn and self.time + time >= factor * COARSE_TIME)

    def lose(self, turn: float) -> None:
        """Handle a lost reply with an angle. turn: commanded turn from the last update to the query."""
        self.lost = self.turn + turn

    def finish_reading(self) -> None:
        """Note that the robot starts to count the angle from 0."""
        self.turn = self.time = self.lost = 0.0

    def update(self, commanded: float, elapsed: float, angle: int | None) -> CountedTurn:
        """Return the turn since the last update. commanded: commanded turn; elapsed: s; angle: the reading, or None."""
        ahead = self.turn
        self.turn += commanded
        self.time += elapsed
        variance = 0.0
        if angle is not None:
            turn, variance = self._read(angle)
            self._owed += turn - commanded - ahead
            self.finish_reading()
        part = clamp(self._owed, MAX_CORRECTION * elapsed)
        self._owed -= part
        return CountedTurn(commanded + part, variance)

    def _read(self, angle: int) -> CountedTurn:
        """Return the CountedTurn since the last reading."""
        self._count += 1
        if self.kind == TEST:
            frequent = self._is_frequent
            if not frequent or abs(self.turn) <= SLOW:
                self._commanded[frequent] += abs(self.turn)
                self._counted[frequent] += abs(angle)
            if frequent:        # the reading may have lost most of the turn
                return CountedTurn(self.turn, (UNSURE * self.turn) ** 2)
        lost, sigma = lost_part(self.lost, self.turn - self.lost, angle, UNCERTAIN)
        turn = angle + lost + (copysign(self._mean_loss, angle) if angle else 0.0)
        return CountedTurn(turn, sigma ** 2 + (LOSS_VARIANCE if self.kind != KEPT and (angle or self.turn) else 0.0))
