"""The clocks that a base runs on in real time. A simulated clock replaces their methods."""
from __future__ import annotations

import time
from typing import Any, Callable

from diagnostic_msgs.msg import DiagnosticStatus
import rospy

from rbx1_nav.base.units import SECOND
from rbx1_nav.node import life

READING_TIME = 100_000      # ns: within this time, readings of two clocks count as simultaneous
TRIES = 10


def as_ros_time(instant: int, now: Callable[[], int]) -> rospy.Time:
    """Return the ROS time at an instant (ns) of another clock. now(): returns the current time of that clock, ns."""
    wall = rospy.rostime.is_wallclock()
    for _ in range(TRIES):
        # on a busy machine, the process may be suspended between the readings
        before, ros, after = now(), time.time_ns() if wall else rospy.Time.now().to_nsec(), now()
        if after - before < READING_TIME:
            break
    stamp = rospy.Time.__new__(rospy.Time)      # __init__() takes longer than all readings
    stamp.set(*divmod(ros + instant - (before + after) // 2, SECOND))
    return stamp


class Clock:
    """Measures motion on the monotonic clock, which cannot be set; stamps are in ROS time."""

    def __init__(self, rate: float) -> None:
        """rate: of the odometry, Hz."""
        self.rate = rate

    # Any: rospy has no types
    def watch(self, subscriber: Any) -> None:
        """Wait for the publishers that a subscriber to commands is connected to, if this clock waits for nodes."""

    def unwatch(self, subscriber: Any) -> None:
        """Undo watch()."""

    def receive(self, target: Any, header: dict[str, str], command: Any) -> None:
        """Put a command that has just arrived in force, now or later: call target.apply(command). header: of the
        connection."""
        target.apply(command)

    def publish(self, publisher: rospy.Publisher, message: Any) -> None:
        publisher.publish(message)

    def greet(self, send: Callable[[], None]) -> None:
        """Call send(), which sends the current state to a new subscriber, if this clock waits for nodes; otherwise, the
        next message follows soon."""

    def now(self) -> int:
        """Return the time of the clock that measures motion, ns."""
        return time.monotonic_ns()

    def stamp(self, instant: int) -> rospy.Time:
        """Return an instant of this clock (ns) as a rospy.Time, for message headers."""
        return as_ros_time(instant, self.now)

    def run(self, step: Callable[[], None]) -> None:
        """Call step() at the rate of the odometry until shutdown is requested."""
        beat = time.monotonic()
        while not life.end_requested.is_set():
            step()
            beat = max(beat + 1 / self.rate, time.monotonic())
            while (left := beat - time.monotonic()) > 0 and not life.end_requested.is_set():
                life.sleep(left)

    def diagnose(self, status: DiagnosticStatus) -> None:
        """Add the state of the clock to a DiagnosticStatus."""


class HardwareClock(Clock):
    """Clock for a real robot, which keeps moving while the computer is suspended; this clock keeps running, too."""

    def now(self) -> int:
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)
