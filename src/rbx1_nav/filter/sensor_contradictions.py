"""What is logged when wheels and gyro contradict each other."""
from __future__ import annotations

from math import degrees
from typing import Callable

from rbx1_nav.filter.filter import Filter
from rbx1_nav.filter.pose_errors import BIAS

# what is logged about wheels and gyro
TEXTS = {
    'rest': 'the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may drift by '
            '{bias:.1f} degrees/s or more',
    'bias': 'odom has turned by {lost:.2f} rad more than imu_data since the last rest: the bias has drifted, or one of '
            'them is wrong; the heading is uncertain; let it rest',
    'scale': 'imu_data and odom differ by {scale:.0f} % in all turns: the scale of the gyro or the track width is '
             'wrong; the heading is uncertain',
    'gyro': 'odom has turned by {lost:.2f} rad more than imu_data since the last rest: the gyro fails, and is not used '
            'until it turns with the wheels',
    'dead': 'imu_data has never changed, while odom has turned: the gyro does not measure, and is not used until it '
            'turns with the wheels'}
LEFT = {'gyro', 'dead'}     # the gyro is not used


class Doubts:
    """Logs what wheels and gyro show of each other: each finding once, and a gyro that is left each time."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        self.warn = warn
        self.warned: set[str] = set()

    def report(self, found: str, ekf: Filter) -> None:
        """Report what a Filter has found, a key of TEXTS, or '' if wheels and gyro agree."""
        if found and not self.warned & (LEFT if found in LEFT else {found}):
            self.warned.add(found)
            self.warn(TEXTS[found].format(bias=degrees(ekf.sigma(BIAS)), lost=ekf.lost,
                                          scale=100 * ekf.scale_error))
        elif not ekf.gyro_left and self.warned & LEFT:
            self.warned -= LEFT
            self.warn('odom and imu_data agree again')
