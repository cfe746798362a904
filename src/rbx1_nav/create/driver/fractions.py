"""Detects and corrects the loss of fractions of a degree when the angle of a Create is read.

According to the specification, each reading continues where the last one stopped. But some robots start each reading at
0 and drop the fraction (libcreate, issue 22; create_robot, issue 28). At 30 readings per second and 1 rad/s, they lose
a third of the turn. The less often the angle is read, the less is lost.
"""
from __future__ import annotations

from math import copysign
from typing import Callable

from rbx1_nav.config import AUTO
from rbx1_nav.units import clamp

KEPT, LOST = 'kept', 'lost'
KINDS = (AUTO, KEPT, LOST)

STEADY = 0.5            # s after a change of the commanded turn in which the robot may still lag
SUSPICIOUS = 15.0       # degrees of a steady turn after which readings that are too small raise a suspicion
CONTRAST = 6.0          # minimum number of degrees that must be missing if fractions are lost
ENOUGH = 90.0           # degrees after which readings that were large enough are discarded
COARSE_ANGLE = 14.0     # degrees between two readings of a robot that may lose fractions
COARSE_TIME = 0.9       # maximum time (s) between two such readings
VARIATION = 0.3         # relative variation of both: with equal intervals, each could lose the same fraction
GOLDEN = (5 ** 0.5 - 1) / 2     # its multiples are spread evenly between whole numbers
COMPARED = 40.0         # degrees of coarse readings that are compared with the readings before
MEAN_LOSS = 0.5         # degrees, mean loss of a nonzero reading
GAP = 2.5               # intervals between two readings beyond which readings are missing
MAX_CORRECTION = 2.0    # degrees per update: a filter would mistake a large jump of the heading for a change of place


def fraction(turn: float) -> float:
    """Return the expected loss (degrees) of a turn (degrees): half a degree on average, since the robot measures at its
    own instants; all of a turn that is smaller than a degree."""
    return turn if turn < 1 else MEAN_LOSS


class _Readings:
    """Readings in one steady turn, in degrees, positive in the commanded direction."""

    def __init__(self) -> None:
        self.commanded: list[float] = []
        self.total = self.read = self.fractions = 0.0   # commanded turn, turn that was read, expected loss

    def add(self, commanded: float, read: float) -> None:
        self.commanded.append(commanded)
        self.total += commanded
        self.read += read
        self.fractions += fraction(commanded)


class Fractions:
    """Detects from readings and commands whether fractions are lost, and corrects the loss. Angles are in degrees.

    Readings that are too small raise a suspicion, but wheels that slip or are held back look the same. So the angle is
    read less often for a while. If fractions are lost, the robot then seems to turn faster.
    """

    def __init__(self, kind: str = AUTO, warn: Callable[[str], None] = lambda text: None) -> None:
        """kind: one of KINDS; warn: logs a line."""
        self.kind = kind
        self._warn = warn
        self._count = 0                 # number of readings
        self._elapsed = 0.0             # s, interval of the last reading
        self._owed = 0.0                # lost turn that has not been corrected yet
        self._side = 0                  # direction of the commanded turn: 1 left, -1 right
        self._rate = 0.0                # commanded rate, degrees/s
        self._begin(0, 0.0)

    def add(self, commanded: float, angle: float, elapsed: float) -> float:
        """Return the turn since the previous reading. commanded: commanded turn; angle: the reading; elapsed: s."""
        self._count += 1
        if not self.coarse and elapsed > GAP * self._elapsed:
            self.disturb()
        self._elapsed = elapsed
        side = int(commanded > 0) - int(commanded < 0)
        rate = commanded / elapsed if elapsed > 0 else 0.0
        if side != self._side or abs(rate - self._rate) > 0.2 * abs(rate):
            self._begin(side, rate)
        self._turning += elapsed
        if self.kind == AUTO and side:
            self._owed = side * self._compare(side * commanded, side * angle)
        return angle + (copysign(MEAN_LOSS, angle) if self.kind == LOST and angle else 0.0)

    def make_up(self) -> float:
        """Return a part of the turn that was lost before, to be added at each update."""
        part = clamp(self._owed, MAX_CORRECTION)
        self._owed -= part
        return part

    def is_due(self, turn: float, time: float) -> bool:
        """Return whether to read the angle now. turn: commanded turn since the last reading; time: s since then."""
        if not self.coarse:
            return True
        factor = 1 + VARIATION * (self._count * GOLDEN % 1)
        return abs(turn) >= factor * COARSE_ANGLE or time >= factor * COARSE_TIME

    def disturb(self) -> None:
        """Restart the comparison, because a reading was lost."""
        self._begin(self._side, self._rate)

    def _begin(self, side: int, rate: float) -> None:
        self._side, self._rate, self._turning = side, rate, 0.0
        self._start, self._fine, self._coarse = _Readings(), _Readings(), _Readings()
        self.coarse = self.kind == LOST     # whether to read the angle less often

    def _compare(self, commanded: float, read: float) -> float:
        """Compare a reading. Returns the turn that was lost before, once a loss of fractions is detected; else 0."""
        if self.coarse:
            self._coarse.add(commanded, read)
            return self._decide() if self._coarse.total >= COMPARED else 0.0
        if self._turning <= STEADY:
            self._start.add(commanded, read)
            return 0.0
        fine = self._fine
        fine.add(commanded, read)
        if fine.total >= SUSPICIOUS and fine.fractions >= CONTRAST:
            self.coarse = fine.read < fine.total - fine.fractions / 2
            if not self.coarse and fine.total > ENOUGH:
                self._fine = _Readings()
        return 0.0

    def _decide(self) -> float:
        start, fine, coarse = self._start, self._fine, self._coarse
        if_kept = coarse.read / coarse.total * fine.total
        ratio = (coarse.read + MEAN_LOSS * len(coarse.commanded)) / coarse.total
        if_lost = sum(ratio * each - fraction(ratio * each) for each in fine.commanded)
        if fine.read > (if_kept + if_lost) / 2:
            self.kind, self.coarse = KEPT, False
            return 0.0
        self.kind = LOST
        self._warn('The robot loses fractions of a degree: correcting the odometry. Set angle_fractions:=lost to '
                   'correct it from the start')
        # while the robot lagged behind its command, only the number of readings shows how much was lost
        begun = min(MEAN_LOSS * len(start.commanded), max(0.0, ratio * start.total - start.read))
        # add() corrects the last coarse reading itself, like each one from now on
        return begun + max(0.0, ratio * fine.total - fine.read) + MEAN_LOSS * (len(coarse.commanded) - 1)
