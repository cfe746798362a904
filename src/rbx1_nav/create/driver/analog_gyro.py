"""The TurtleBot's gyro, which the Create reads through its analog input."""
from __future__ import annotations

from collections import deque
from math import radians
from typing import Callable

from rbx1_nav.create.driver.gyro_check import GyroCheck, Step
from rbx1_nav.robot.readings import MEASURED, Reading

MAX_REST = 1000         # maximum number of readings at rest in the offset: half a minute, as in create_node
MIN_REST = 10           # minimum number; with fewer readings, no angular velocity is reported
JUMP, JUMP_TIME = 15, 1.0   # counts (4 degrees/s) and s at rest beyond which the offset has jumped, not drifted
COUNT_VARIANCE = 1.0    # counts^2, variance of a reading: rounding and the noise of the analog input
SCALE_ERROR = 0.01      # 1 sigma of the calibrated scale, as a fraction


class AnalogGyro:
    """Converts counts to an angular velocity, as create_node does: -(count - offset) / offset * range * correction.

    The offset is the mean of the good readings while the robot is stationary, so it follows the temperature. After a
    fault of the gyro, a new offset is measured.
    """

    def __init__(self, measurement_range: float, correction: float, error: Callable[[str], None],
                 info: Callable[[str], None]) -> None:
        """measurement_range: measurement range of the chip, degrees/s; correction: factor; error, info: log a line."""
        self.full_scale = radians(measurement_range) * correction
        self.check = GyroCheck(self.full_scale, error, info)
        self.rest: deque[int] = deque(maxlen=MAX_REST)
        self.total = 0          # sum of the readings in `rest`
        self.jumped = 0.0       # s of consecutive readings at rest that are far from the offset
        self.yaw = 0.0          # rad, integrated rate
        self.turned = 0.0       # rad, integrated absolute rate
        self.variance = MEASURED    # rad^2, variance of the yaw without the scale error

    @property
    def offset(self) -> float | None:
        """The offset in counts; None while there are too few readings at rest."""
        return self.total / len(self.rest) if len(self.rest) >= MIN_REST else None

    def update(self, count: int, step: Step) -> Reading | None:
        """Return the Reading for a count after a Step; None without an offset, or if the count shows no angular
        velocity.

        The rate is always the current rate. In gaps and without a rate, the heading follows the wheels.
        """
        self._calibrate(count, step)
        offset = self.offset
        scale = self.full_scale / (offset or 1.0)
        rate, variance = ((offset or 0.0) - count) * scale, COUNT_VARIANCE * scale ** 2
        measures = offset is not None and not self.check.problem and self.check.accepts(
            count, step.at_rest and not step.touched)
        if measures and not step.missing:
            self.yaw += rate * step.elapsed
            self.turned += abs(rate) * step.elapsed
            self.variance += variance * (1 + 1 / len(self.rest)) * step.elapsed ** 2
        else:
            self.yaw += step.turn
            self.variance += step.variance
        reading = Reading(rate, variance, self.yaw, self.variance + (SCALE_ERROR * self.turned) ** 2)
        self.check.update(count, step)
        return reading if measures and not self.check.problem else None

    def _calibrate(self, count: int, step: Step) -> None:
        """Add a count to the offset if it is good, and discard an offset that has become wrong."""
        good = step.at_rest and self.check.accepts(count, True)
        offset = self.offset
        far = good and offset is not None and abs(count - offset) > JUMP
        self.jumped = self.jumped + step.elapsed if far else 0.0
        if (self.check.problem and self.check.rested is None) or self.jumped > JUMP_TIME:
            self.rest.clear()
            self.total, self.jumped = 0, 0.0
        elif good and not far:
            if len(self.rest) == MAX_REST:
                self.total -= self.rest[0]
            self.rest.append(count)
            self.total += count
