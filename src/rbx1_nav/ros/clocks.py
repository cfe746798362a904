"""The clocks that a base may run on. All have

    now()                           ns on the clock that motion is measured by
    stamp()                         the same moment as a rospy.Time, for message headers
    set_driver(apply, connections)  apply(command): puts a command in force; connections(): to publishers of cmd_vel
    command(twist, command)         calls apply(command) when a received command is to take effect
    run(step)                       calls step() at the rate of the odometry until the node is to end
"""
import time

import rospy
from rosgraph_msgs.msg import Clock as ClockMessage

from rbx1_nav.control.lockstep import Lockstep
from rbx1_nav.ros import node
from rbx1_nav.ros.tcp import unread_bytes
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND

TICK = SECOND // 50     # ns, the step of the simulated clock


def make_clock(factor, rate):
    """The clock for a real-time factor (None if not set), an odometry rate (Hz), and /use_sim_time."""
    if factor:
        return OwnClock(factor, rate)
    return RealTimeClock(rate) if rospy.rostime.is_wallclock() else FollowedClock(rate)


def wait_for_beat(beat, period):
    """Wait until `period` after `beat` (s of the monotonic clock); returns that time, or the present one if it is
    later."""
    beat = max(beat + period, time.monotonic())
    while time.monotonic() < beat and not node.end_requested.is_set():
        node.sleep(beat - time.monotonic())
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
        while not node.end_requested.is_set():
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
        node.end_requested.wait()


class OwnClock(FollowedClock):
    """Simulated time that this node advances: at most `factor` times as fast as real time, in lockstep with the
    drivers."""

    def __init__(self, factor, rate):
        super().__init__(rate)
        self.factor = factor
        self.publisher = rospy.Publisher('/clock', ClockMessage, queue_size=10, tcp_nodelay=True)
        self.lockstep = None

    def set_driver(self, apply, connections):
        """See above."""
        super().set_driver(apply, connections)
        self.lockstep = Lockstep(apply, rospy.logwarn, self.is_connected, self.has_unread, node.end_requested.is_set)

    def command(self, twist, command):
        """See above: with the tick that it answers."""
        header = twist._connection_header       # one object per connection
        self.lockstep.receive(header, header['callerid'], command)

    def is_connected(self, header):
        """Whether a connection to a publisher of cmd_vel still exists."""
        return any(connection.header is header for connection in self.connections())

    def has_unread(self, header):
        """Whether bytes have arrived by a connection that were not read yet."""
        return any(unread_bytes(connection.socket) for connection in self.connections() if connection.header is header)

    def run(self, step):
        """See above."""
        beat = time.monotonic()
        while not node.end_requested.is_set():
            self.time += TICK
            self.publisher.publish(rospy.Time(0, self.time))
            if self.schedule.due(self.time):
                step()
            beat = wait_for_beat(beat, TICK / SECOND / self.factor)
            self.lockstep.collect()
