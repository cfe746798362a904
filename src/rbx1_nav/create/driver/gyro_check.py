"""Detects faults of the TurtleBot's gyro from its counts and from the motion of the wheels."""
from __future__ import annotations

from math import copysign, inf, radians
from typing import Callable, NamedTuple

# counts (thresholds of create_node): below 100 the gyro has no power; at rest, a working gyro is between the other two
NO_POWER, LOWEST, HIGHEST = 100, 425, 575
FULL_SCALE = 1023           # counts at full scale
FEW = 5                     # consecutive readings that show a lack of power: on a bad line, one or two may be corrupted
FEW_AT_REST = 10            # consecutive readings at rest: on some floors the robot still turns when its wheels do not
# left turns in which a working gyro may have a count that low: a 150 degrees/s gyro above 120 degrees/s, and above 65
# if it is not calibrated and shows almost twice the rate
FAST = radians(65)          # rad/s
FAST_SHARE = 0.45           # fraction of the range, used if it is smaller
SLOW_TIME = 0.5             # s after a fast turn in which the robot may still turn
ROUNDING = radians(1)       # rounding error of a turn of the wheels
POWER_UP = 0.5              # s after the base took control, which switches the gyro's power on
NO_POWER_TIME = 2.0         # s without power that indicate a fault while the base has no control
REPAIRED = 1.0              # s of good readings at rest after which a faulty gyro counts as working again
STUCK_COUNTS = 1            # largest change of a count from noise alone
STUCK_TURN = radians(45)    # turn of the wheels in which the count of a working gyro changes
WRONG_TURN = radians(90)    # turn shown by an unchanging count ...
SHARE = 0.1                 # ... of which the wheels turn less than this fraction, for any scale error of the gyro
UNCERTAIN = radians(10) ** 2    # variance (rad^2) above which a turn of the wheels proves nothing: replies were lost


class Step(NamedTuple):
    """The motion of the robot since the previous reading."""

    elapsed: float      # s
    turn: float         # rad, from the odometry
    variance: float     # rad^2, variance of `turn`
    commanded: float    # rad, commanded turn
    at_rest: bool       # whether the robot is stationary on the floor
    driven: bool        # whether the base has control of the robot, and so has switched the power of its sensors on
    touched: bool       # whether a bumper is pressed or a wheel has dropped
    missing: bool       # whether readings are missing


class GyroCheck:
    """Checks each count, and logs when the gyro fails and when it works again."""

    def __init__(self, full_scale: float, error: Callable[[str], None], info: Callable[[str], None]) -> None:
        """full_scale: the largest angular velocity, rad/s; error, info: log a line."""
        self.fast = min(FAST, FAST_SHARE * full_scale)
        self.error = error
        self.info = info
        self.problem = ''           # why the gyro must not be used; '' if it works
        self._kind = ''             # kind of the problem
        self._logged: set[str] = set()      # kinds of problems since the gyro last worked
        self.rested: float | None = None    # s of consecutive good readings at rest; None: the last reading was not one
        self._changed = False       # whether the count has changed since a problem was found
        self._driven = 0.0          # s since the base took control
        self._slow = 0.0            # s since the last fast turn to the left
        self._low, self._low_time = 0, 0.0      # consecutive readings without power, and their duration (s)
        self._wrong_rest = 0        # consecutive wrong readings at rest
        self._lowest, self._highest = inf, -inf     # range of counts that are equal except for noise
        self._forget()

    def _forget(self) -> None:
        """Restart the sums, since the count has changed."""
        self.unseen = self.variance = 0.0   # turn (rad) of the wheels minus turn of the gyro, and its variance (rad^2)
        # rad, turn of the wheels on the floor: now, and its rightmost and leftmost value
        self._turn = self._right = self._left = 0.0
        self._wheels = self._commanded = self._shown = 0.0      # rad, turn of the wheels, the commands and the gyro
        # whether the robot was stationary since then: at a steady rate, the count of a working gyro does not change
        self._stood = False

    def accepts(self, count: int, at_rest: bool) -> bool:
        """Return whether a count shows an angular velocity."""
        return LOWEST <= count <= HIGHEST if at_rest else NO_POWER <= count < FULL_SCALE

    def update(self, count: int, step: Step, shown: float) -> bool:
        """Check a count. shown: the turn (rad) that was added to the gyro's heading in this step. Returns whether a
        fault was detected now."""
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
                self.error(f'Gyro: {text}; using the wheels alone for the heading')
        if self.problem and not before:
            self._changed, self.rested = False, None
            return True
        if self.problem:
            self._look_for_repair(count, step)
        return False

    def _follow_count(self, count: int, step: Step, shown: float) -> None:
        self._lowest, self._highest = min(self._lowest, count), max(self._highest, count)
        changed = self._highest - self._lowest > STUCK_COUNTS
        uncertain = step.missing or step.variance > UNCERTAIN   # in a gap, the count may have had any value
        self._changed |= changed
        if changed or uncertain:
            self._lowest = self._highest = count
            self._forget()
        self._stood |= step.at_rest
        if uncertain:
            return
        self.unseen += step.turn - shown
        self.variance += step.variance
        if not step.touched:    # in the air, the wheels do not turn the robot
            self._turn += step.turn
        self._right, self._left = min(self._right, self._turn), max(self._left, self._turn)
        self._wheels += step.turn
        self._commanded += step.commanded
        self._shown += step.turn if step.touched else shown     # a robot that is lifted or held may be turned by hand

    def _follow_power(self, count: int, step: Step) -> None:
        low = count < NO_POWER
        self._low, self._low_time = (self._low + 1, self._low_time + step.elapsed) if low else (0, 0.0)
        self._driven = self._driven + step.elapsed if step.driven else 0.0
        is_fast = max(step.turn - ROUNDING, step.commanded) > self.fast * step.elapsed
        self._slow = 0.0 if is_fast else self._slow + step.elapsed

    def _find_problem(self, count: int) -> tuple[str, str]:
        """Return (kind, text) of the current problem; ('', '') without a problem."""
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
        """Return whether the gyro shows a steady turn that the wheels do not make: slip and shoves are not as steady as
        a single count."""
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
            self.info('Gyro: working again')
