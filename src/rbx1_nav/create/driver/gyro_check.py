"""Finds out whether the TurtleBot's gyro works, from its counts and from what the wheels do."""
from __future__ import annotations

from math import copysign, inf, radians
from typing import Callable, NamedTuple

# counts (thresholds of create_node): below 100 the gyro has no power; at rest, one that works is between the others
NO_POWER, LOWEST, HIGHEST = 100, 425, 575
FULL_SCALE = 1023           # counts, the end of the scale
FEW = 5                     # readings in a row that show a lack of power: on a bad line, one or two may be corrupted
FEW_AT_REST = 10            # readings in a row at rest: on some floors, the robot turns on after its wheels report none
# left turns in which a gyro that works may have such a count: one for 150 degrees/s has it above 120, and above 65 if
# it is not calibrated and shows almost twice the rate
FAST = radians(65)          # rad/s
FAST_SHARE = 0.45           # of the range, if that is less
SLOW_TIME = 0.5             # s after such a turn, in which the robot may turn on
ROUNDING = radians(1)       # of a turn of the wheels
POWER_UP = 0.5              # s after the base took control, and with that switched the gyro's power on
NO_POWER_TIME = 2.0         # s without power that prove something if the base has no control
REPAIRED = 1.0              # s of good readings at rest after which a gyro that was broken works again
STUCK_COUNTS = 1            # by which a count may change by noise alone
STUCK_TURN = radians(45)    # turn of the wheels in which a gyro that works shows another count
WRONG_TURN = radians(90)    # turn that a count shows while it does not change ...
SHARE = 0.1                 # ... of which the wheels turn less than this, however wrong the gyro's scale is
UNCERTAIN = radians(10) ** 2    # variance (rad^2) of a turn of the wheels that proves nothing: replies were lost


class Step(NamedTuple):
    """What the robot did since the reading before."""

    elapsed: float      # s
    turn: float         # rad, by the odometry
    variance: float     # rad^2, of this turn
    commanded: float    # rad, the turn by the commands
    at_rest: bool       # whether it is stationary on the floor
    driven: bool        # whether it is in the mode in which the base drives it and has switched its sensors' power on
    touched: bool       # whether a bumper is pressed or a wheel has dropped
    missing: bool       # whether readings are missing


class GyroCheck:
    """Looks at each count, and logs when the gyro breaks and when it works again."""

    def __init__(self, full_scale: float, error: Callable[[str], None], info: Callable[[str], None]) -> None:
        """full_scale: the largest angular velocity, rad/s; error, info: log a line."""
        self.fast = min(FAST, FAST_SHARE * full_scale)
        self.error = error
        self.info = info
        self.problem = ''           # why the gyro is not to be used; '' if it is
        self._kind = ''             # of the problem
        self._logged: set[str] = set()      # kinds of problems since the gyro last worked
        self.rested: float | None = None    # s of good readings at rest in a row; None: the last one was none
        self._changed = False       # whether the count has changed since a problem was found
        self._driven = 0.0          # s since the base has had control
        self._slow = 0.0            # s since the last fast turn to the left
        self._low, self._low_time = 0, 0.0      # readings without power in a row, and their time (s)
        self._wrong_rest = 0        # readings in a row
        self._lowest, self._highest = inf, -inf     # counts that are one but for noise
        self._forget()

    def _forget(self) -> None:
        """Begin to add up, since the count has changed."""
        self.unseen = self.variance = 0.0   # turn (rad) by the wheels - by the gyro, and its variance (rad^2)
        self._turn = self._right = self._left = 0.0     # rad by the wheels on the floor: now, farthest to either side
        self._wheels = self._commanded = self._shown = 0.0      # rad, by wheels, commands and gyro
        # whether the robot stood meanwhile: at a steady rate, a gyro that works does not change
        self._stood = False

    def accepts(self, count: int, at_rest: bool) -> bool:
        """Whether a count shows an angular velocity."""
        return LOWEST <= count <= HIGHEST if at_rest else NO_POWER <= count < FULL_SCALE

    def update(self, count: int, step: Step, shown: float) -> bool:
        """Look at a count. shown: the turn of this step (rad) as it was added to the gyro's heading. Returns
        whether the gyro broke now."""
        self._follow_count(count, step, shown)
        self._follow_power(count, step)
        is_wrong = step.at_rest and not step.touched and count >= NO_POWER and not LOWEST <= count <= HIGHEST
        self._wrong_rest = self._wrong_rest + 1 if is_wrong else 0
        before = self.problem
        kind, text = self._find_problem(count)
        if kind and kind != self._kind:
            self._kind, self.problem = kind, text
            if kind not in self._logged:
                self._logged.add(kind)
                self.error(f'Gyro: {text}; the heading is measured by the wheels alone')
        if self.problem and not before:
            self._changed, self.rested = False, None
            return True
        if self.problem:
            self._look_for_repair(count, step)
        return False

    def _follow_count(self, count: int, step: Step, shown: float) -> None:
        self._lowest, self._highest = min(self._lowest, count), max(self._highest, count)
        changed = self._highest - self._lowest > STUCK_COUNTS
        uncertain = step.missing or step.variance > UNCERTAIN   # in a gap, the count may have been any
        self._changed |= changed
        if changed or uncertain:
            self._lowest = self._highest = count
            self._forget()
        self._stood |= step.at_rest
        if uncertain:
            return
        self.unseen += step.turn - shown
        self.variance += step.variance
        if not step.touched:    # in the air, the wheels turn nothing
            self._turn += step.turn
        self._right, self._left = min(self._right, self._turn), max(self._left, self._turn)
        self._wheels += step.turn
        self._commanded += step.commanded
        self._shown += step.turn if step.touched else shown     # who lifts or holds the robot may turn it

    def _follow_power(self, count: int, step: Step) -> None:
        low = count < NO_POWER
        self._low, self._low_time = (self._low + 1, self._low_time + step.elapsed) if low else (0, 0.0)
        self._driven = self._driven + step.elapsed if step.driven else 0.0
        is_fast = max(step.turn - ROUNDING, step.commanded) > self.fast * step.elapsed
        self._slow = 0.0 if is_fast else self._slow + step.elapsed

    def _find_problem(self, count: int) -> tuple[str, str]:
        """(kind, text) of what is wrong now; ('', '') if nothing is."""
        if self._low >= FEW and self._slow >= SLOW_TIME and (
                self._driven >= POWER_UP or self._low_time >= NO_POWER_TIME):
            return 'power', f'{count} counts: expected at least {NO_POWER}: does it have power?'
        if self._wrong_rest >= FEW_AT_REST:
            return 'rest', f'{count} counts at rest: expected {LOWEST} to {HIGHEST}'
        if self.problem:
            return '', ''
        if self._stood and self._left - self._right > STUCK_TURN:
            return 'stuck', f'stuck at {count} counts while the wheels turn the robot'
        if self._is_contradicted():
            return 'wrong', f'stuck at {count} counts: it shows a turn that the wheels do not make'
        return '', ''

    def _is_contradicted(self) -> bool:
        """Whether the gyro shows a steady turn without the wheels: slip and shoves are not steady to a count."""
        side, size = copysign(1, self._shown), abs(self._shown)
        return size > WRONG_TURN and max(side * self._wheels, side * self._commanded) < SHARE * size

    def _look_for_repair(self, count: int, step: Step) -> None:
        good = self._changed and step.at_rest and not step.missing and LOWEST <= count <= HIGHEST
        if not good:
            self.rested = None
            return
        self.rested = 0.0 if self.rested is None else self.rested + step.elapsed
        if self.rested >= REPAIRED:
            self._kind = self.problem = ''
            self._logged.clear()
            self.info('Gyro: works again')
