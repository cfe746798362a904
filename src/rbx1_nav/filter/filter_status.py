"""Reports the states of the filter and of its sensors on /diagnostics, and limits what it logs."""
from __future__ import annotations

from functools import partial
from math import degrees, sqrt
import re
from threading import Lock
import time
from typing import Callable, Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater

from rbx1_nav.base.messages import fill_status
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.one_sender import OneSender
from rbx1_nav.filter.pose_errors import BIAS

INTERVAL = 1.0      # s between two log lines of one kind
MAX_KINDS = 10      # lines in this time
NUMBER = re.compile(r'[-+]?\b(\d[\d.]*(e[-+]?\d+)?|nan|inf)\b')

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
CONTRADICTION = WARN, 'Wheels and gyro contradict each other'
JUMPED = WARN, 'Odometry ignored: faster than ~max_speed or ~max_turn_rate'
SUMMARIES = {'standstill': (OK, 'Standstill'), 'agreement': (OK, 'Wheels and gyro agree'),
             'contradiction': CONTRADICTION, 'carried': (WARN, 'Carried, or turned by hand')}


class Diagnostics:
    """Publishes a DiagnosticStatus of the filter and of each sensor."""

    def __init__(self, senders: Sequence[OneSender], timeout: float, lock: Lock,
                 get_filter: Callable[[], tuple[CombinedOdometry | None, int]]) -> None:
        """senders: of the sensors; timeout: age of the last message above which a sensor has timed out, s; lock: held
        while the filter is read; get_filter(): returns the filter and the number of published poses."""
        self.senders = senders
        self.timeout = timeout
        self.lock = lock
        self.get_filter = get_filter
        sensors = [each.name for each in senders]
        # arrival time of the last message of each sensor that the filter has accepted
        self.received: dict[str, rospy.Time | None] = dict.fromkeys(sensors)
        self.rejected = dict.fromkeys([*sensors, 'set_pose'], 0)    # number of messages
        self.updater = Updater()
        self.updater.setHardwareID('none')
        self.updater.add('filter', self._diagnose_filter)
        for sensor in sensors:
            self.updater.add(sensor, partial(self._diagnose_sensor, sensor))

    def update(self) -> None:
        """Publish the states, and log which sensor has no messages."""
        self.updater.force_update()
        for each in self.senders:
            each.report()

    def _diagnose_filter(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            combined, published = self.get_filter()
            ekf, estimate = (combined.filter, combined.estimate) if combined else (None, None)
            case = combined.case if combined else None
            summary = ((WARN, 'No estimate yet') if not combined or not ekf else
                       SUMMARIES[case] if case else
                       (WARN, 'A sensor has timed out') if any(combined.timed_out.values()) else
                       JUMPED if combined.suspect else
                       (OK, 'The gyro is not used'))
            return fill_status(status, *summary, {
                'Case': case or 'none',
                'Gyro bias (degrees/s)':
                    f'{degrees(ekf.bias):.4f} +- {degrees(ekf.sigma(BIAS)):.4f}' if ekf else 'unknown',
                'Doubted': ekf.doubted if ekf else 'nothing',
                'Standard deviation of the heading (degrees)':
                    f'{degrees(sqrt(estimate.covariance[2][2])):.2f}' if estimate else 'unknown',
                'Poses published': published,
                'Rejected messages on set_pose': self.rejected['set_pose']})

    def _diagnose_sensor(self, sensor: str, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        with self.lock:
            combined, received = self.get_filter()[0], self.received[sensor]
            age = None if received is None else (rospy.Time.now() - received).to_sec()
            summary = ((WARN, 'No message yet') if age is None or not combined else
                       # below 0: the clock has jumped back since the message
                       (WARN, 'Timed out, not used') if not -1 <= age <= self.timeout or combined.timed_out[sensor] else
                       JUMPED if sensor == 'odom' and combined.suspect else
                       CONTRADICTION if combined.case == 'contradiction' else
                       (OK, 'Used'))
            return fill_status(status, *summary, {
                'Age of the last message (s)': 'never' if age is None else f'{age:.3f}',
                'Rejected messages': self.rejected[sensor]})


class LimitedLog:
    """Logs at most one line of a kind per second, and MAX_KINDS lines in all. The others are dropped.

    Lines that differ only in numbers are of the same kind.
    """

    def __init__(self) -> None:
        self.logged: dict[str, float] = {}      # by kind: time of a line that was logged, s of the monotonic clock

    def add(self, log: Callable[..., None], text: str) -> None:
        """Log a line. log: a function such as rospy.logwarn."""
        kind, now = NUMBER.sub('', text), time.monotonic()
        self.logged = {each: then for each, then in self.logged.items() if now - then < INTERVAL}
        if kind not in self.logged and len(self.logged) < MAX_KINDS:
            self.logged[kind] = now
            log('%s', text)
