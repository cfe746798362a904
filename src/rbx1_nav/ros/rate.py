"""Keeps time for a driving script, on the wall clock or on simulated time.

A driving script publishes from its main thread only. A request to end the node reaches it as an exception from its next
sleep() or pause(), and the script itself stops the robot.
"""
import time

import rospy

from rbx1_nav.ros.node import end_requested, sleep
from rbx1_nav.ros.subscribers import connected_nodes
from rbx1_nav.units import SECOND


def now():
    """ns of simulated time, or of the monotonic clock."""
    return time.monotonic_ns() if rospy.rostime.is_wallclock() else rospy.get_rostime().to_nsec()


def _wait_until(end, longest, publisher):
    """Wait until now() is `end` (ns), but no longer than `longest` (ns) on a clock that jumped back.

    Raises ROSException as soon as nobody subscribes to the publisher: a clock that stands still may have ended with
    them.
    """
    warn_time = time.monotonic() + 5
    last = None
    while True:
        if end_requested.is_set():
            raise rospy.ROSInterruptException('shutdown requested')
        if not connected_nodes(publisher):
            raise rospy.ROSException('%s: the last subscriber has gone: expected a base' % publisher.resolved_name)
        time_now = now()
        end = min(end, time_now + longest)
        if time_now >= end:
            return
        if rospy.rostime.is_wallclock():
            sleep((end - time_now) / SECOND)
            continue
        clock_moved = rospy.rostime.get_rostime_cond()
        with clock_moved:
            if now() == time_now:
                clock_moved.wait(0.05)
        if time_now != last:
            last, warn_time = time_now, time.monotonic() + 5
        elif time.monotonic() > warn_time:
            warn_time += 5
            rospy.logwarn('/use_sim_time is true, but the time on /clock stands still')


def pause(seconds, publisher):
    """Wait for `seconds` of ROS time. Raises ROSInterruptException as soon as the node is to end, and ROSException as
    soon as nobody subscribes to the publisher."""
    duration = round(seconds * SECOND)
    _wait_until(now() + duration, duration, publisher)


class Rate:
    """rospy.Rate for commands: ends as soon as the node is to end, and never lets two ticks follow at once.

    A delay is made up for over the next ticks, each at least 0.6 periods long: otherwise a base could receive two
    commands in one step.
    """

    def __init__(self, hz, publisher):
        """hz: ticks per second of ROS time, the first one a period from now; publisher: of the commands."""
        self.publisher = publisher
        self.period = round(SECOND / hz)
        self.next = now() + self.period

    def sleep(self):
        """Wait for the next tick. Raises ROSInterruptException as soon as the node is to end, and ROSException as soon
        as nobody subscribes to the publisher."""
        _wait_until(self.next, self.period, self.publisher)
        time_now = now()
        self.next = min(max(self.next + self.period, time_now + self.period * 6 // 10), time_now + self.period)
