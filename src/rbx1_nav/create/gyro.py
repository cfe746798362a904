"""The TurtleBot's gyro, which the Create reads with its analog input."""
from collections import deque
from math import pi, radians

from rbx1_nav.model.gyro import Reading
from rbx1_nav.model.wheels import MEASURED

MAX_REST = 1000         # readings at rest that the offset is the mean of: half a minute, as in create_node
MIN_REST = 10           # and at least so many: before, no angular velocity is reported
COUNT_VARIANCE = 1.0    # of a reading, counts^2: rounding and the noise of the analog input
SCALE_ERROR = 0.01      # 1 sigma of the calibrated scale, a fraction
GAP_VARIANCE = pi ** 2  # rad^2/s^2: of the mean rate over a time without readings


class AnalogGyro:
    """Converts counts to an angular velocity, as create_node does: -(count - offset) / offset * range * correction.

    The offset is the mean of the readings while the robot stands, so it follows the temperature.
    """

    def __init__(self, measurement_range, correction):
        """measurement_range: degrees/s, of the chip; correction: factor."""
        self.full_scale = radians(measurement_range) * correction
        self.rest = deque(maxlen=MAX_REST)
        self.total = 0          # of the readings in `rest`
        self.yaw = 0.0          # rad, the integrated rate
        self.turned = 0.0       # rad, both directions counted positive
        self.variance = MEASURED    # rad^2, of the yaw, except for the scale's

    @property
    def offset(self):
        """The reading at rest, counts; None before there is one."""
        return self.total / len(self.rest) if self.total and len(self.rest) >= MIN_REST else None

    def update(self, count, elapsed, standing, gap=None):
        """The Reading of a count, `elapsed` (s) after the one before; None while there is no offset.

        standing: whether the robot stands; gap: after a time without readings, the turn (rad) and its variance (rad^2)
        by the odometry.
        """
        if standing:
            if len(self.rest) == MAX_REST:
                self.total -= self.rest[0]
            self.rest.append(count)
            self.total += count
        offset = self.offset
        if offset is None:
            return None
        scale = self.full_scale / offset
        rate = (offset - count) * scale
        variance = COUNT_VARIANCE * scale ** 2
        if gap:
            self.yaw += gap[0]
            self.variance += gap[1]
            variance = GAP_VARIANCE
        else:
            self.yaw += rate * elapsed
            self.turned += abs(rate) * elapsed
            self.variance += variance * (1 + 1 / len(self.rest)) * elapsed ** 2
        return Reading(rate, variance, self.yaw, self.variance + (SCALE_ERROR * self.turned) ** 2)
