"""The clocks that a base may run on. All have

    now()                           ns on the clock that motion is measured by
    stamp()                         the same moment as a rospy.Time, for message headers
    set_driver(apply, connections)  apply(command): puts a command in force; connections(): to publishers of cmd_vel
    command(twist, command)         calls apply(command) when a received command is to take effect
    diagnose(status)                adds to a DiagnosticStatus
    run(step)                       calls step() at the rate of the odometry until the node is to end
"""
import time

import rospy
from rosgraph_msgs.msg import Clock as ClockMessage

from rbx1_nav.ros.node import life
from rbx1_nav.schedule import Schedule


def wait_for_beat(beat, period):
    """Wait until `period` after `beat` (s of the monotonic clock); returns that time, or the present one if it is
    later."""
    beat = max(beat + period, time.monotonic())
    while time.monotonic() < beat and not life.end_requested.is_set():
        life.sleep(beat - time.monotonic())
    return beat


class Clock:
    """What the clocks have in common: a command takes effect as it arrives."""

    apply = connections = None

    def set_driver(self, apply, connections):
        """See above."""
        self.apply, self.connections = apply, connections

    def command(self, _, command):
        """See above."""
        self.apply(command)

    def diagnose(self, status):
        """See above."""


class RealTimeClock(Clock):
    """Motion on the monotonic clock, which nobody can set; stamps in ROS time."""

    def __init__(self, rate):
        self.rate = rate

    @staticmethod
    def now():
        """See above."""
        return time.monotonic_ns()

    @staticmethod
    def stamp():
        """See above."""
        return rospy.Time.now()

    def run(self, step):
        """See above."""
        beat = time.monotonic()
        while not life.end_requested.is_set():
            step()
            beat = wait_for_beat(beat, 1 / self.rate)


class HardwareClock(RealTimeClock):
    """For a real robot: it moves on while the computer is suspended, and so does this clock."""

    @staticmethod
    def now():
        """See above."""
        return time.clock_gettime_ns(time.CLOCK_BOOTTIME)


class FollowedClock(Clock):
    """Simulated time that another node publishes on /clock."""

    def __init__(self, rate):
        self.time = 0       # ns, the latest /clock
        self.schedule = Schedule(rate)

    def now(self):
        """See above."""
        return self.time

    def stamp(self):
        """See above."""
        return rospy.Time(0, self.time)

    def run(self, step):
        """See above."""
        def on_clock(message):
            self.time = message.clock.to_nsec()
            if self.schedule.due(self.time):
                step()
        rospy.Subscriber('/clock', ClockMessage, on_clock, queue_size=None, tcp_nodelay=True)
        life.end_requested.wait()
