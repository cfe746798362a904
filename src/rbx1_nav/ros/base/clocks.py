"""The clocks that a base can run on."""
from __future__ import annotations

import time
from typing import Any, Callable

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist
import rospy
from rosgraph_msgs.msg import Clock as ClockMessage

from rbx1_nav.ros.node import life
from rbx1_nav.schedule import Schedule


def wait_for_beat(beat: float, period: float) -> float:
    """Wait until `period` after `beat` (s of the monotonic clock); return that time, or the current time if it is
    later."""
    beat = max(beat + period, time.monotonic())
    while time.monotonic() < beat and not life.end_requested.is_set():
        life.sleep(beat - time.monotonic())
    return beat


class Clock:
    """Interface of all clocks. In this class, a command takes effect when it arrives."""

    def now(self) -> int:
        """Return the time of the clock that measures motion, ns."""
        raise NotImplementedError

    def stamp(self) -> rospy.Time:
        """Return the current time as a rospy.Time, for message headers."""
        raise NotImplementedError

    def run(self, step: Callable[[], None]) -> None:
        """Call step() at the rate of the odometry until shutdown is requested."""
        raise NotImplementedError

    # Any: the clock passes on commands and rospy's connections without using their contents
    def set_driver(self, apply: Callable[[Any], None], connections: Callable[[], Any]) -> None:
        """Set the functions of the driver.

        apply(command): puts a command in force; connections(): returns the connections to publishers of cmd_vel.
        """
        self.apply, self.connections = apply, connections

    def command(self, _: Twist, command: Any) -> None:
        """Call apply(command) when a received command takes effect. The Twist is the message with the command."""
        self.apply(command)

    def diagnose(self, status: DiagnosticStatus) -> None:
        """Add the state of the clock to a DiagnosticStatus."""


class RealTimeClock(Clock):
    """Measures motion on the monotonic clock, which cannot be set; stamps are in ROS time."""

    def __init__(self, rate: float) -> None:
        self.rate = rate

    def now(self) -> int:
        return time.monotonic_ns()

    def stamp(self) -> rospy.Time:
        return rospy.Time.now()

    def run(self, step: Callable[[], None]) -> None:
        beat = time.monotonic()
        while not life.end_requested.is_set():
            step()
            beat = wait_for_beat(beat, 1 / self.rate)


class HardwareClock(RealTimeClock):
    """Clock for a real robot, which keeps moving while the computer is suspended; this clock keeps running, too."""

    def now(self) -> int:
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)


class FollowedClock(Clock):
    """Simulated time that another node publishes on /clock."""

    def __init__(self, rate: float) -> None:
        self.time = 0       # ns, the latest /clock
        self.schedule = Schedule(rate)

    def now(self) -> int:
        return self.time

    def stamp(self) -> rospy.Time:
        return rospy.Time(0, self.time)

    def run(self, step: Callable[[], None]) -> None:
        def on_clock(message: ClockMessage) -> None:
            self.time = message.clock.to_nsec()
            if self.schedule.due(self.time):
                step()
        rospy.Subscriber('/clock', ClockMessage, on_clock, queue_size=None, tcp_nodelay=True)
        life.end_requested.wait()
