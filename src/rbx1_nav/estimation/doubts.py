"""Reports disagreement between wheels and gyro to the filter and to the user."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.estimation.filter import Filter
from rbx1_nav.units import SECOND

CONTRADICTION = 5 * SECOND  # ns for which a contradiction is reported


class Doubts:
    """Warns if wheels and gyro contradict the assumptions of the filter, or each other."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        """warn(text): logs a warning."""
        self.warn = warn
        self.another_floor = False  # whether the sensors have shown that the prior is for another floor
        self.contradicted: int | None = None    # ns, when wheels and gyro last contradicted each other

    def contradicts(self, time: int) -> bool:
        """Return whether wheels and gyro contradict each other at a time (ns), or did so recently."""
        return self.contradicted is not None and time - self.contradicted < CONTRADICTION

    def check(self, ekf: Filter, time: int) -> None:
        """Check the agreement of a Filter, which has new results, at a time (ns)."""
        sums = ekf.agreement
        measured = f'odom turned by {sums.wheels:.2f} rad, imu_data by {sums.gyro:.2f} rad'
        if ekf.doubt_heading():
            if not self.contradicts(time):
                self.warn(f'{measured}: one of them is wrong; the heading is uncertain')
            self.contradicted = time
        elif not self.another_floor and ekf.doubt_floor():
            self.another_floor = True
            self.warn(f'{measured}: the slip does not match the assumed floor; the distance is less certain')
