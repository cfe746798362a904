"""Detects faults of the TurtleBot's gyro from its counts."""
from __future__ import annotations

from math import radians
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
SETTLE = 0.5                # s after a fast turn, and after the base took control and switched the power on
ROUNDING = radians(1)       # rounding error of a turn of the wheels
REPAIRED = 1.0              # s of good readings at rest after which a faulty gyro counts as working again


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
        self.rested: float | None = None    # s of consecutive good readings at rest; None: the last reading was not one
        self._settled = 0.0         # s without a fast left turn, and with the power switched on
        self._low = self._wrong = 0     # consecutive readings without power, and wrong readings at rest

    def accepts(self, count: int, at_rest: bool) -> bool:
        """Return whether a count shows an angular velocity."""
        return LOWEST <= count <= HIGHEST if at_rest else NO_POWER <= count < FULL_SCALE

    def update(self, count: int, step: Step) -> None:
        """Check a count."""
        is_fast = max(step.turn - ROUNDING, step.commanded) > self.fast * step.elapsed
        self._settled = 0.0 if is_fast or not step.driven else self._settled + step.elapsed
        good, low = self.accepts(count, True), count < NO_POWER
        self._low = self._low + 1 if low else 0
        self._wrong = self._wrong + 1 if step.at_rest and not (step.touched or good or low) else 0
        self.rested = (None if not (good and step.at_rest) or step.missing
                       else 0.0 if self.rested is None else self.rested + step.elapsed)
        if self._low >= FEW and self._settled >= SETTLE:
            self._fail(f'{count} counts: expected at least {NO_POWER}: does it have power?')
        elif self._wrong >= FEW_AT_REST:
            self._fail(f'{count} counts at rest: expected {LOWEST} to {HIGHEST}')
        elif self.problem and (self.rested or 0.0) >= REPAIRED:
            self.problem = ''
            self.info('Gyro: working again')

    def _fail(self, problem: str) -> None:
        if not self.problem:
            self.error(f'Gyro: {problem}; using the wheels alone for the heading')
        self.problem = problem
