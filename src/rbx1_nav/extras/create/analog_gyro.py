"""The TurtleBot's gyro, which the Create reads through its analog input."""
from __future__ import annotations

from collections import deque
from math import radians
from typing import Callable, NamedTuple

from rbx1_nav.base.covariances import MEASURED, Reading
from rbx1_nav.extras.create.create_parameters import Settings

MAX_REST = 1000         # maximum number of readings at rest in the offset: half a minute, as in create_node
MIN_REST = 10           # minimum number; with fewer readings, no angular velocity is reported
JUMP, JUMP_TIME = 15, 1.0   # counts (4 degrees/s) and s at rest beyond which the offset has jumped, not drifted
COUNT_VARIANCE = 1.0    # counts^2, variance of a reading: rounding and the noise of the analog input
SCALE_ERROR = 0.01      # 1 sigma of the calibrated scale, as a fraction
# counts (thresholds of create_node): below 100 the gyro has no power; at rest, a working gyro is between the other two
NO_POWER, LOWEST, HIGHEST = 100, 425, 575
FULL_SCALE = 1023       # counts at full scale
FEW = 10                # consecutive wrong readings: some are corrupted, and a robot may turn while its wheels do not
FAST = radians(65)      # rad/s: in a faster left turn, a gyro that is not calibrated may have a count below 100
ROUNDING = radians(1)   # rounding error of a turn of the wheels
SETTLE = 0.5            # s after a fast turn, and after the base took control and switched the power on
REPAIRED = 1.0          # s of good readings at rest after which a faulty gyro counts as working again


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


class AnalogGyro:
    """Converts counts to an angular velocity, as create_node does: -(count - offset) / offset * range * correction.

    The offset is the mean of the good readings while the robot is stationary, so it follows the temperature. Power and
    range are checked, and logged when the gyro fails and when it works again. Then a new offset is measured.
    """

    def __init__(self, settings: Settings, error: Callable[[str], None], info: Callable[[str], None]) -> None:
        self.full_scale = radians(settings.gyro_measurement_range) * settings.gyro_scale_correction
        self.error = error
        self.info = info
        self.rest: deque[int] = deque(maxlen=MAX_REST)      # good readings at rest
        self.problem = ''           # why the gyro must not be used; '' if it works
        self.yaw = 0.0              # rad, integrated rate
        self._turned = 0.0          # rad, integrated absolute rate
        self._variance = MEASURED   # rad^2, variance of the yaw without the scale error
        self._settled = 0.0         # s without a fast left turn, and with the power switched on
        self._wrong = 0             # number of consecutive wrong readings
        self._good = 0.0            # s of consecutive good readings at rest
        self._jumped = 0.0          # s of consecutive readings at rest that are far from the offset

    @property
    def offset(self) -> float | None:
        """The offset in counts; None while there are too few readings at rest."""
        return sum(self.rest) / len(self.rest) if len(self.rest) >= MIN_REST else None

    def update(self, count: int, step: Step) -> Reading | None:
        """Return the Reading for a count after a Step; None without an offset, or if the count shows no angular
        velocity.

        The rate is always the current rate. In gaps and without a rate, the heading follows the wheels.
        """
        good = step.at_rest and LOWEST <= count <= HIGHEST
        self._check(count, step, good)
        offset = self._calibrate(count, step, good)
        scale = self.full_scale / (offset or 1.0)
        rate, variance = ((offset or 0.0) - count) * scale, COUNT_VARIANCE * scale ** 2
        may_turn = step.touched or not step.at_rest
        measures = offset is not None and not self.problem and (good or may_turn and NO_POWER <= count < FULL_SCALE)
        if measures and not step.missing:
            self.yaw += rate * step.elapsed
            self._turned += abs(rate) * step.elapsed
            self._variance += variance * (1 + 1 / len(self.rest)) * step.elapsed ** 2
        else:
            self.yaw += step.turn
            self._variance += step.variance
        reading = Reading(rate, variance, self.yaw, self._variance + (SCALE_ERROR * self._turned) ** 2)
        return reading if measures else None

    def _check(self, count: int, step: Step, good: bool) -> None:
        """Check power and range. good: whether this is a good reading at rest."""
        low, fast = count < NO_POWER, max(step.turn - ROUNDING, step.commanded) > FAST * step.elapsed
        self._settled = 0.0 if fast or not step.driven else self._settled + step.elapsed
        wrong = self._settled >= SETTLE if low else step.at_rest and not (good or step.touched)
        self._wrong = self._wrong + 1 if wrong else 0
        self._good = self._good + step.elapsed if good and not step.missing else 0.0
        if self._wrong >= FEW:
            before, self.problem = self.problem, (
                f'{count} counts: expected at least {NO_POWER}: does it have power?' if low else
                f'{count} counts at rest: expected {LOWEST} to {HIGHEST}')
            if not before:
                self.error(f'Gyro: {self.problem}; using the wheels alone for the heading')
        elif self.problem and self._good >= REPAIRED:
            self.problem = ''
            self.info('Gyro: working again')

    def _calibrate(self, count: int, step: Step, good: bool) -> float | None:
        """Add a good reading to the offset, and discard an offset that has become wrong. Returns the offset."""
        offset = self.offset
        far = good and offset is not None and abs(count - offset) > JUMP
        self._jumped = self._jumped + step.elapsed if far else 0.0
        if (self.problem and not good) or self._jumped > JUMP_TIME:
            self.rest.clear()
            self._jumped = 0.0
        elif good and not far:
            self.rest.append(count)
        return self.offset
