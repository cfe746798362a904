"""Which sensor is silent, and which one is doubted: stamps and arrivals of the messages, and reports to the user."""
from __future__ import annotations

from math import degrees
from typing import Callable

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.filter import Filter, Verdict
from rbx1_nav.filter.inputs import RejectedMessage
from rbx1_nav.filter.pose_errors import BIAS

ODOM, IMU = 'odom', 'imu_data'  # the sensors, by their topics

MAX_LEAD = SECOND // 2  # ns that a stamp may be ahead of the clock: clocks of computers differ
MAX_AGE = 60 * SECOND   # ns that a stamp may be behind; simulated time may be ahead or behind by the same amount
MAX_WAIT = 5 * SECOND   # ns that odometry waits for a gyro that is late but not silent
REPORTED, FADED = 0.1, 0.01     # rad: a disagreement of wheels and gyro that is reported, and one that is over
REASONS = {'wheels': 'the wheels slip; the heading follows the gyro',
           'both': 'one of them is wrong; the heading is uncertain',
           'gyro': 'the gyro fails, and is not used until it turns with the wheels'}


def rejection(stamp: int, expected: str, time: int) -> RejectedMessage:
    """Return the error for a stamp (ns) that is not as expected, compared with a time (ns)."""
    return RejectedMessage(f'header.stamp: {stamp / SECOND:.9f}: expected {expected}, {time / SECOND:.9f}')


def clock_rejection(stamp: int, expected: str, time: int) -> RejectedMessage:
    """Return the error for a stamp (ns) of another clock than this node's, whose time is given (ns)."""
    return RejectedMessage(f'{rejection(stamp, expected, time)}; synchronize the clocks of both computers, or for a '
                           'bag, set use_sim_time before the nodes start, and play it with --clock')


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
        self.time = 0               # when the last message of either sensor arrived, see _count()
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
            raise clock_rejection(stamp, 'a stamp not later than now', now)
        if stamp < now - MAX_AGE:
            raise clock_rejection(stamp, 'a stamp not much older than now', now)
        if before is not None and stamp <= before:
            raise rejection(stamp, 'a stamp later than the last', before)
        self.last_stamp[sensor] = stamp
        self._count(sensor, self.clock() if self.clock else now)
        other = self.last_stamp[ODOM if sensor == IMU else IMU]
        # not if it is still as late as when it timed out
        if self.timed_out[sensor] and (sensor == ODOM or (other or 0) - stamp <= MAX_WAIT):
            self.timed_out[sensor] = False
            self.warn(f'{sensor} has recovered')
        return before

    def _count(self, sensor: str, clock: int) -> None:
        """Update the arrival times with a message.

        A pause of both sensors counts only partly: the process may have been asleep, and then it processes all messages
        of one sensor before the messages of the other.
        """
        self.time += min(max(0, clock - self.last_clock), self.timeout // 4)
        self.last_clock = clock
        self.last_time[sensor] = self.time

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


class Doubts:
    """Warns when wheels and gyro begin to contradict each other, when they agree again, and of what they show."""

    def __init__(self, warn: Callable[[str], None]) -> None:
        self.warn = warn
        self.doubted = 'nothing'
        self.warned: set[str] = set()   # of what there was a warning that does not become invalid
        self.dead = 0.0         # rad: turn of the wheels while the gyro has never changed

    def report(self, verdict: Verdict | None, ekf: Filter, time: int) -> None:
        """Report a Verdict of a Filter at a time (ns)."""
        if not verdict:
            return
        if not ekf.rested:
            self._once('rest', 'the robot has not been at rest yet, so the bias of the gyro is unknown: the heading '
                       f'may drift by {degrees(ekf.sigma(BIAS)):.1f} degrees/s or more')
        sums, doubted = verdict
        turns = f'odom turned by {sums.wheels:.2f} rad, imu_data by {sums.gyro:.2f} rad in {sums.time:.1f} s: '
        if doubted == 'scale':
            self._once(doubted, f'imu_data and odom differ by {100 * ekf.scale_error:.0f} % in all turns: the scale of '
                       'the gyro or the track width is wrong; the heading is uncertain')
        elif doubted == 'bias':
            self._once(doubted, 'the bias of imu_data seems to have drifted since the last rest, by '
                       f'{degrees(ekf.drift):.2f} degrees/s: the heading is uncertain; let it rest')
        elif (self.doubted == 'nothing' or self.doubted.startswith('wheels') and doubted in ('both', 'gyro')) and (
                doubted == 'gyro' or abs(ekf.disagreement) > REPORTED):
            self.warn(turns + REASONS.get(doubted, REASONS['both']))
            self.doubted = f'{doubted or "both"} since {time / SECOND:.1f} s'
        elif self.doubted != 'nothing' and not ekf.gyro_left and abs(ekf.disagreement) < FADED:
            self.warn('odom and imu_data agree again')
            self.doubted = 'nothing'

    def is_dead(self, turned: float, least: float) -> bool:
        """Return whether a gyro whose readings have never changed does not measure, because the wheels have turned
        (rad): by more than `least` in this step, or before."""
        if abs(turned) > least:
            self.dead += abs(turned)
        if self.dead > REPORTED:
            self._once('dead', f'imu_data has never changed, while odom has turned by {self.dead:.2f} rad: the gyro '
                       'does not measure, and is not used')
        return self.dead > REPORTED or abs(turned) > least

    def _once(self, kind: str, text: str) -> None:
        if kind not in self.warned:
            self.warned.add(kind)
            self.warn(text)
