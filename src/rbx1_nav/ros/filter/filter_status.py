"""Reports the states of the filter and of its sensors on /diagnostics, and limits what it logs."""
from __future__ import annotations

from functools import partial
from math import degrees, sqrt
import re
from threading import Lock
from typing import Callable, Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater

from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.filter import BIAS, Filter
from rbx1_nav.ros.messages import fill_status

INTERVAL = 0.5      # s between two log lines
KIND_INTERVAL = 1.0     # s between two lines of one kind
MAX_KINDS = 100     # kinds waiting to be logged; further kinds are dropped
NUMBER = re.compile(r'[-+]?\b(\d[\d.]*(e[-+]?\d+)?|nan|inf)\b')

OK, WARN = DiagnosticStatus.OK, DiagnosticStatus.WARN
CONTRADICTION = WARN, 'Wheels and gyro contradict each other'
JUMPED = WARN, 'Odometry ignored: faster than ~max_speed or ~max_turn_rate'
SUMMARIES = {'standstill': (OK, 'Standstill'), 'agreement': (OK, 'Wheels and gyro agree'),
             'contradiction': CONTRADICTION, 'carried': (WARN, 'Carried, or turned by hand')}


class Diagnostics:
    """Counts the messages to the filter, and publishes a DiagnosticStatus of the filter and of each sensor."""

    def __init__(self, sensors: Sequence[str], timeout: float, lock: Lock,
                 get_filter: Callable[[], tuple[CombinedOdometry | None, int]]) -> None:
        """sensors: names; timeout: age of the last message above which a sensor has timed out, s; lock: held while the
        filter is read; get_filter(): returns the filter and the number of published poses."""
        self.timeout = timeout
        self.lock = lock
        self.get_filter = get_filter
        # arrival time of the last message of each sensor
        self.received: dict[str, rospy.Time | None] = dict.fromkeys(sensors)
        self.rejected = dict.fromkeys([*sensors, 'set_pose'], 0)    # number of messages
        self.filter: Filter | None = None
        self.case: str | None = None
        self.starts = 0
        self.counts = {'contradiction': 0, 'carried': 0}
        self.updater = Updater()
        self.updater.setHardwareID('none')
        self.updater.add('filter', self._diagnose_filter)
        for sensor in sensors:
            self.updater.add(sensor, partial(self._diagnose_sensor, sensor))

    def count(self, topic: str, now: rospy.Time, combined: CombinedOdometry) -> None:
        """Count a message; to be called after each message on a topic that the filter has accepted at `now`."""
        self.received[topic] = now
        if combined.filter is not self.filter:
            self.filter = combined.filter
            if self.filter:
                self.starts += 1
        case = combined.case
        if case != self.case:
            self.case = case
            if case and case in self.counts:
                self.counts[case] += 1

    def publish(self) -> None:
        """Publish /diagnostics."""
        self.updater.force_update()

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
                'Doubted': combined.doubts.doubted if combined else 'nothing',
                'Standard deviation of the heading (degrees)':
                    f'{degrees(sqrt(estimate.covariance[2, 2])):.2f}' if estimate else 'unknown',
                'Contradictions': self.counts['contradiction'],
                'Times carried': self.counts['carried'],
                'Restarts': max(0, self.starts - 1),
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
    """A log that is limited to two lines per second. It keeps lines until they may be logged: the latest line of each
    kind, and the number of lines.

    Lines that differ only in numbers are of the same kind.
    """

    def __init__(self) -> None:
        # by kind, the oldest first: (log, text, number of lines)
        self.pending: dict[str, tuple[Callable[..., None], str, int]] = {}
        self.logged: dict[str, float] = {}      # by kind: time of the last logged line, s
        self.next = 0.0         # s
        self.lock = Lock()

    def add(self, log: Callable[..., None], text: str) -> None:
        """Add a line, from any thread. log: a function such as rospy.logwarn."""
        kind = NUMBER.sub('', text)
        with self.lock:
            if kind in self.pending or len(self.pending) < MAX_KINDS:
                self.pending[kind] = log, text, self.pending.get(kind, (log, text, 0))[2] + 1

    def flush(self, now: float) -> None:
        """Log at most one line. To be called often; now: s of a monotonic clock."""
        with self.lock:
            self.logged = {kind: time for kind, time in self.logged.items() if now - time < KIND_INTERVAL}
            kind = next((each for each in self.pending if each not in self.logged), None)
            if kind is None or now < self.next:
                return
            log, text, count = self.pending.pop(kind)
            self.logged[kind], self.next = now, now + INTERVAL
        log('%s', text if count == 1 else f'{text} (and {count - 1} more of this kind)')
