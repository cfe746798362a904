"""What a Create does with the fraction of a degree that it turns beyond a whole number when its angle is read.

By its specification each reading counts from where the last one ended. But some robots begin at 0 and drop the fraction
(libcreate, issue 22; create_robot, issue 28): at 30 readings a second and 1 rad/s, that is a third of the turn. The
less often the angle is read, the less is lost.
"""
from __future__ import annotations

from math import copysign
from typing import Callable

from rbx1_nav.config import AUTO
from rbx1_nav.units import clamp

KEPT, LOST = 'kept', 'lost'
KINDS = (AUTO, KEPT, LOST)

STEADY = 0.5            # s after a change of the commanded turn in which the robot may still lag behind
SUSPICIOUS = 15.0       # degrees of a steady turn after which readings that are too small count
CONTRAST = 6.0          # degrees that must be missing at least, if fractions are lost
ENOUGH = 90.0           # degrees after which readings that were large enough are forgotten
COARSE_ANGLE = 14.0     # degrees between two readings of a robot that may lose fractions
COARSE_TIME = 0.9       # s between two such readings at most
VARIATION = 0.3         # of both: at equal distances, the same fraction could be lost each time
GOLDEN = (5 ** 0.5 - 1) / 2     # its multiples spread evenly between whole numbers
COMPARED = 40.0         # degrees of coarse readings that are compared with those before
MEAN_LOSS = 0.5         # degrees, of a reading that is not 0
GAP = 2.5               # intervals between two readings: in a longer one, readings are missing
MAX_CORRECTION = 2.0    # degrees, of one update: to a filter, a heading that jumps is another place


def fraction(turn: float) -> float:
    """What a robot is expected to lose of a turn (degrees): half a degree in the mean, since it measures at instants of
    its own; all of a turn that is smaller than one."""
    return turn if turn < 1 else MEAN_LOSS


class _Readings:
    """Readings in one steady turn, in degrees to the commanded side."""

    def __init__(self) -> None:
        self.commanded: list[float] = []
        self.total = self.read = self.fractions = 0.0   # commanded, read, and fractions of what was commanded

    def add(self, commanded: float, read: float) -> None:
        self.commanded.append(commanded)
        self.total += commanded
        self.read += read
        self.fractions += fraction(commanded)


class Fractions:
    """Finds out from readings and commands whether fractions are lost, and makes up for it. Angles are in degrees.

    Readings that are too small raise a suspicion: wheels that slip or are held back look the same. So the angle is read
    less often for a while. If fractions are lost, the robot then seems to turn faster.
    """

    def __init__(self, kind: str = AUTO, warn: Callable[[str], None] = lambda text: None) -> None:
        """kind: one of KINDS; warn: logs a line."""
        self.kind = kind
        self._warn = warn
        self._count = 0                 # readings
        self._elapsed = 0.0             # s, of the last one
        self._owed = 0.0                # turn that was lost, and is not made up for yet
        self._side = 0                  # of the commanded turn: 1 left, -1 right
        self._rate = 0.0                # commanded, degrees/s
        self._begin(0, 0.0)

    def add(self, commanded: float, angle: float, elapsed: float) -> float:
        """The turn since the reading before, for one that is `angle` after `elapsed` s, and `commanded` by commands."""
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
        """A part of the turn that was lost before, to be added at each update."""
        part = clamp(self._owed, MAX_CORRECTION)
        self._owed -= part
        return part

    def is_due(self, turn: float, time: float) -> bool:
        """Whether to read the angle now. turn: by the commands since the last reading; time: s since then."""
        if not self.coarse:
            return True
        factor = 1 + VARIATION * (self._count * GOLDEN % 1)
        return abs(turn) >= factor * COARSE_ANGLE or time >= factor * COARSE_TIME

    def disturb(self) -> None:
        """A reading was lost: what was compared so far is of no use."""
        self._begin(self._side, self._rate)

    def _begin(self, side: int, rate: float) -> None:
        self._side, self._rate, self._turning = side, rate, 0.0
        self._start, self._fine, self._coarse = _Readings(), _Readings(), _Readings()
        self.coarse = self.kind == LOST     # whether to read the angle less often

    def _compare(self, commanded: float, read: float) -> float:
        """Look at a reading. Returns the turn that was lost before, once it is known that fractions are."""
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
        self._warn('The robot loses fractions of a degree: the odometry is corrected. angle_fractions:=lost corrects '
                   'it from the start')
        # while the robot lagged behind its command, nothing but the number of readings says how much was lost
        begun = min(MEAN_LOSS * len(start.commanded), max(0.0, ratio * start.total - start.read))
        # the last of the coarse readings gets its half degree as each does from now on
        return begun + max(0.0, ratio * fine.total - fine.read) + MEAN_LOSS * (len(coarse.commanded) - 1)
