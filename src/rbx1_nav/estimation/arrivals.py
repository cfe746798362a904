"""When the messages of both sensors were measured, and when they arrived: which sensor is silent."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.estimation.inputs import RejectedMessage
from rbx1_nav.units import SECOND

ODOM, IMU = 'odom', 'imu_data'  # the sensors, by their topics

MAX_LEAD = SECOND // 2  # ns that a stamp may be ahead of the clock: clocks of computers differ
MAX_AGE = 60 * SECOND   # ns that it may be behind; simulated time may be ahead of it or behind it by as much
MAX_WAIT = 5 * SECOND   # ns that odometry waits for a gyro that is late but not silent


class Arrivals:
    """Stamps and arrivals of messages, by sensor, and which sensor has timed out. All times are in ns."""

    def __init__(self, timeout: int, warn: Callable[[str], None], clock: Callable[[], int] | None,
                 max_lead: int) -> None:
        """As CombinedOdometry."""
        self.timeout = timeout
        self.warn = warn
        self.clock = clock
        self.max_lead = max_lead
        self.now = 0
        self.last_stamp: dict[str, int | None] = {ODOM: None, IMU: None}
        self.time = 0               # when the last message of all arrived, see _count()
        self.last_clock = 0         # the clock then
        self.last_time: dict[str, int | None] = {ODOM: None, IMU: None}
        self.timed_out = {ODOM: False, IMU: False}

    def restart(self) -> None:
        """No sensor has timed out."""
        self.timed_out = {ODOM: False, IMU: False}

    def step_back(self, now: int) -> int:
        """By how much the clock has jumped back; 0 if it has not. After a jump, the stamps are forgotten."""
        back = self.now - now
        if back <= MAX_LEAD:
            return 0
        self.last_stamp = {ODOM: None, IMU: None}
        return back

    def add(self, sensor: str, now: int, stamp: int) -> int | None:
        """Check and store the stamp of a message that arrives at `now`; returns the one before it. Raises
        RejectedMessage."""
        self.now = now
        before = self.last_stamp[sensor]
        for good, expected, time in ((stamp <= now + self.max_lead, 'a stamp not later than now', now),
                                     (stamp >= now - MAX_AGE, 'a stamp not much older than now', now),
                                     (before is None or stamp > before, 'a stamp later than the last', before or 0)):
            if not good:
                raise RejectedMessage(f'header.stamp: {stamp / SECOND:.9f}: expected {expected}, {time / SECOND:.9f}')
        self.last_stamp[sensor] = stamp
        self._count(sensor, self.clock() if self.clock else now)
        other = self.last_stamp[ODOM if sensor == IMU else IMU]
        # not if it is still as late as when it was given up
        if self.timed_out[sensor] and (sensor == ODOM or (other or 0) - stamp <= MAX_WAIT):
            self.timed_out[sensor] = False
            self.warn(f'{sensor} has recovered')
        return before

    def _count(self, sensor: str, clock: int) -> None:
        """A message arrives. A pause of both sensors counts little: the process may have been asleep, and then
        processes all messages of one sensor before those of the other."""
        self.time += min(max(0, clock - self.last_clock), self.timeout // 4)
        self.last_clock = clock
        self.last_time[sensor] = self.time

    def is_silent(self, sensor: str, since: int) -> bool:
        """Whether no message of a sensor has arrived for longer than the timeout; if there was none yet, since a
        time."""
        last = self.last_time[sensor]
        return self.time - (since if last is None else last) > self.timeout

    def set_timed_out(self, sensor: str, reason: str = '') -> None:
        """A sensor is not used until it recovers."""
        if not self.timed_out[sensor]:
            self.timed_out[sensor] = True
            reason = reason or f'no valid message for more than {self.timeout / SECOND:g} s'
            self.warn(f'{sensor} has timed out: {reason}; not used until it recovers')
