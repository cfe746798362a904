"""Stamps and arrivals of the messages of each sensor: which messages are late, and which sensor has timed out."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import RejectedMessage

ODOM, IMU = 'odom', 'imu_data'  # the sensors, by their topics

MAX_LEAD = SECOND // 2  # ns that a stamp may be ahead of the clock: clocks of computers differ
MAX_AGE = 60 * SECOND   # ns that a stamp may be behind; simulated time may be ahead or behind by the same amount
MAX_WAIT = 5 * SECOND   # ns that odometry waits for a gyro that is late but not silent
OTHER_CLOCK = ('; synchronize the clocks of both computers, or for a bag, set use_sim_time before the nodes start, and '
               'play it with --clock')


def rejection(stamp: int, expected: str, time: int, advice: str = '') -> RejectedMessage:
    """Return the error for a stamp (ns) that is not as expected, compared with a time (ns)."""
    return RejectedMessage(f'header.stamp: {stamp / SECOND:.9f}: expected {expected}, {time / SECOND:.9f}{advice}')


class Arrivals:
    """Stamps and arrivals of messages by sensor, and the sensors that have timed out. All times are in ns."""

    def __init__(self, timeout: int, warn: Callable[[str], None], clock: Callable[[], int] | None,
                 max_lead: int) -> None:
        """For the arguments see CombinedOdometry."""
        self.timeout = timeout
        self.warn = warn
        self.clock = clock
        self.max_lead = max_lead
        self.now = 0
        self.last_stamp: dict[str, int | None] = {ODOM: None, IMU: None}
        self.time = 0               # when the last message of either sensor arrived, less the pauses of both
        self.last_clock = 0         # the clock at that time
        self.last_time: dict[str, int | None] = {ODOM: None, IMU: None}
        self.timed_out = {ODOM: False, IMU: False}

    def restart(self) -> None:
        """Mark both sensors as not timed out."""
        self.timed_out = {ODOM: False, IMU: False}

    def notice_step_back(self, now: int) -> int:
        """Discard the stamps if the clock has jumped back. Returns how far (ns), or 0."""
        back = self.now - now
        if back <= MAX_LEAD:
            return 0
        self.last_stamp = {ODOM: None, IMU: None}
        return back

    def add(self, sensor: str, now: int, stamp: int) -> int | None:
        """Check and store the stamp of a message that arrives at `now`, and return the previous stamp.

        Raises RejectedMessage.
        """
        self.now = now
        before = self.last_stamp[sensor]
        if stamp > now + self.max_lead:
            raise rejection(stamp, 'a stamp not later than now', now, OTHER_CLOCK)
        if stamp < now - MAX_AGE:
            raise rejection(stamp, 'a stamp not much older than now', now, OTHER_CLOCK)
        if before is not None and stamp <= before:
            raise rejection(stamp, 'a stamp later than the last', before)
        self.last_stamp[sensor] = stamp
        # a pause of both sensors counts only partly: the process may have been asleep, and then it processes all
        # messages of one sensor before the messages of the other
        clock = self.clock() if self.clock else now
        if clock > self.last_clock:
            self.time += min(clock - self.last_clock, self.timeout // 4)
        self.last_clock, self.last_time[sensor] = clock, self.time
        # not if it is still as late as when it timed out
        if self.timed_out[sensor] and (sensor == ODOM or (self.last_stamp[ODOM] or 0) - stamp <= MAX_WAIT):
            self.timed_out[sensor] = False
            self.warn(f'{sensor} has recovered')
        return before

    def is_silent(self, sensor: str, since: int) -> bool:
        """Return whether no message of a sensor has arrived for longer than the timeout.

        since: start of the period if no message has arrived yet.
        """
        last = self.last_time[sensor]
        return self.time - (since if last is None else last) > self.timeout

    def set_timed_out(self, sensor: str, reason: str = '') -> None:
        """Stop using a sensor until it recovers."""
        if not self.timed_out[sensor]:
            self.timed_out[sensor] = True
            reason = reason or f'no valid message for more than {self.timeout / SECOND:g} s'
            self.warn(f'{sensor} has timed out: {reason}; not used until it recovers')
