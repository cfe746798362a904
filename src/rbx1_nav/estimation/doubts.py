"""Reports to the user which sensor the filter doubts, and since when."""
from __future__ import annotations

from math import degrees
from typing import Callable

from rbx1_nav.estimation.filter import BIAS, SLIP_TURNING, YAW, Filter, Verdict
from rbx1_nav.units import SECOND

CONTRADICTION = 5 * SECOND  # ns for which a contradiction is reported
FADED = 0.1                 # rad: a smaller doubt of the heading is none
REASONS = {'imu_data': 'the bias of the gyro has drifted',
           'wheels': 'the wheels slip; the heading follows the gyro',
           'both': 'one of them is wrong; the heading is uncertain'}


class Doubts:
    """Warns when wheels and gyro begin to contradict each other, and when they agree again."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        """warn(text): logs a warning."""
        self.warn = warn
        self.doubted = 'nothing'
        self.contradicted: int | None = None    # ns, when wheels and gyro last contradicted each other
        self.warned = False     # whether there was a warning that the bias is unknown

    def contradicts(self, time: int) -> bool:
        """Return whether wheels and gyro contradict each other at a time (ns), or did so recently."""
        return self.contradicted is not None and time - self.contradicted < CONTRADICTION

    def check(self, verdict: Verdict, ekf: Filter, time: int) -> None:
        """Report a Verdict of a Filter at a time (ns)."""
        if not (ekf.rested or self.warned):
            self.warned = True
            self.warn('the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may drift '
                      f'by {degrees(ekf.sigma(BIAS)):.1f} degrees/s or more')
        sums, doubted = verdict
        if doubted:
            self.contradicted = time
            if self.doubted == 'nothing':
                self.warn(f'odom turned by {sums.wheels:.2f} rad, imu_data by {sums.gyro:.2f} rad in '
                          f'{sums.time:.1f} s: {REASONS[doubted]}')
                self.doubted = f'{doubted} since {time / SECOND:.1f} s'
        elif (self.doubted != 'nothing' and ekf.doubt[YAW] < FADED
              and ekf.sigma(SLIP_TURNING) < 1.001 * ekf.prior.slip_turning_spread):
            self.warn('odom and imu_data agree again')
            self.doubted = 'nothing'
