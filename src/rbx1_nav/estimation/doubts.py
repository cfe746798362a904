"""What wheels and gyro show of each other, told to the filter and to the user."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.estimation.filter import Filter
from rbx1_nav.units import SECOND

CONTRADICTION = 5 * SECOND  # ns for which a contradiction is shown


class Doubts:
    """Warns where wheels and gyro contradict what the filter believes, or each other."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        """warn(text): logs a warning."""
        self.warn = warn
        self.another_floor = False  # whether the sensors have shown that the prior is that of another floor
        self.contradicted: int | None = None    # ns, when wheels and gyro last contradicted each other

    def contradicts(self, time: int) -> bool:
        """Whether wheels and gyro contradict each other at a time (ns), or did so a moment ago."""
        return self.contradicted is not None and time - self.contradicted < CONTRADICTION

    def check(self, ekf: Filter, time: int) -> None:
        """There is something new in the agreement of a Filter, at a time (ns)."""
        sums = ekf.agreement
        measured = f'odom turned by {sums.wheels:.2f} rad, imu_data by {sums.gyro:.2f} rad'
        if ekf.doubt_heading():
            if not self.contradicts(time):
                self.warn(f'{measured}: one of them is wrong; the heading is uncertain')
            self.contradicted = time
        elif not self.another_floor and ekf.doubt_floor():
            self.another_floor = True
            self.warn(f'{measured}: this is another floor than the one that the filter started with; the distance is '
                      'less certain')
