"""The clocks that a base may run on."""
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
    """Wait until `period` after `beat` (s of the monotonic clock); returns that time, or the present one if it is
    later."""
    beat = max(beat + period, time.monotonic())
    while time.monotonic() < beat and not life.end_requested.is_set():
        life.sleep(beat - time.monotonic())
    return beat


class Clock:
    """What all clocks have. Here, a command takes effect as it arrives."""

    def now(self) -> int:
        """ns on the clock that motion is measured by."""
        raise NotImplementedError

    def stamp(self) -> rospy.Time:
        """The same moment as a rospy.Time, for message headers."""
        raise NotImplementedError

    def run(self, step: Callable[[], None]) -> None:
        """Call step() at the rate of the odometry until the node is to end."""
        raise NotImplementedError

    # Any: the clock passes on commands and connections of rospy, and looks into neither
    def set_driver(self, apply: Callable[[Any], None], connections: Callable[[], Any]) -> None:
        """apply(command): puts a command in force; connections(): to publishers of cmd_vel."""
        self.apply, self.connections = apply, connections

    def command(self, _: Twist, command: Any) -> None:
        """Call apply(command) when a received command is to take effect. The Twist is the message that brought it."""
        self.apply(command)

    def diagnose(self, status: DiagnosticStatus) -> None:
        """Add to a DiagnosticStatus."""


class RealTimeClock(Clock):
    """Motion on the monotonic clock, which nobody can set; stamps in ROS time."""

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
    """For a real robot: it moves on while the computer is suspended, and so does this clock."""

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
