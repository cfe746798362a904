"""Keeps time for a driving script, on the wall clock or on simulated time.

A driving script publishes from its main thread only. A shutdown request reaches it as an exception from its next
sleep() or pause(), and the script itself stops the robot.
"""
from __future__ import annotations

import time

import rospy

from rbx1_nav.ros.driving.watching import Listeners
from rbx1_nav.ros.node.life import check_end, sleep
from rbx1_nav.schedule import NODE_TIMEOUT
from rbx1_nav.units import SECOND

MAX_DELAY = SECOND      # ns


def now() -> int:
    """Return simulated time, or the time of the monotonic clock, in ns."""
    return time.monotonic_ns() if rospy.rostime.is_wallclock() else rospy.get_rostime().to_nsec()


def _wait_until(end: int, longest: int, listeners: Listeners, last_look: float) -> None:
    """Wait until now() is `end` (ns), but no longer than `longest` (ns) on a clock that jumped back.

    last_look: last time at which the script is known to have run, s of the monotonic clock.
    Raises ROSInterruptException as soon as shutdown is requested, and ROSException like Listeners.check(): a clock
    may have stopped because its base has exited. Also raises ROSException if the base's clock no longer waits
    for this script.
    """
    warn_time = time.monotonic() + 5
    last = None
    while True:
        check_end()
        look = time.monotonic()
        if listeners.on_clock_of_base and look - last_look > NODE_TIMEOUT:
            raise rospy.ROSException(f'This script was suspended for {look - last_look:.1f} s: expected at most '
                                     f'{NODE_TIMEOUT:g} s, after which the clock of the base continues')
        last_look = look
        listeners.check()
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
            rospy.logwarn('/use_sim_time is true, but the time on /clock is not advancing')


def pause(seconds: float, listeners: Listeners) -> None:
    """Wait for `seconds` of ROS time. listeners: see wait_for_subscribers().

    Raises ROSInterruptException as soon as shutdown is requested, and ROSException if a listener no longer accepts
    commands.
    """
    duration = round(seconds * SECOND)
    _wait_until(now() + duration, duration, listeners, time.monotonic())


def wait_for_tick(listeners: Listeners) -> None:
    """On simulated time, wait until it advances: what begins now is prompted by the clock. Raises like pause()."""
    if not rospy.rostime.is_wallclock():
        _wait_until(now() + 1, 1, listeners, time.monotonic())


class Rate:
    """rospy.Rate for commands: a shutdown request interrupts it, and two ticks never follow each other immediately.

    On the clock of a simulated base, which waits for this script, the ticks are those of rospy.Rate. On any other
    clock, a delay is made up for over the next ticks, each at least 0.6 periods long: otherwise a base could receive
    two commands in one step. A delay of more than MAX_DELAY is an error, because the base has stopped by then.
    """

    def __init__(self, hz: float, listeners: Listeners) -> None:
        """hz: ticks per second of ROS time, the first one a period from now; listeners: see wait_for_subscribers()."""
        self.listeners = listeners
        self.period = int(SECOND / hz)      # rounded down, as in rospy.Rate
        self.shortest = 0 if listeners.on_clock_of_base else self.period * 6 // 10
        self.restart()

    def restart(self) -> None:
        """Start again after a pause; the next tick is a period from now."""
        self.last_look = time.monotonic()
        self.due = self.next = now() + self.period      # times of the next tick without and with delays

    def sleep(self) -> None:
        """Wait for the next tick. Raises like pause(), and ROSException if the delay is too long."""
        _wait_until(self.next, self.period, self.listeners, self.last_look)
        self.last_look = time.monotonic()
        time_now = now()
        if time_now - self.due > MAX_DELAY:
            raise rospy.ROSException(f'A command is {(time_now - self.due) / SECOND:.1f} s late: expected at most '
                                     f'{MAX_DELAY / SECOND:g} s, after which a base stops')
        self.due = min(self.due, time_now) + self.period
        self.next = max(self.due, time_now + self.shortest)
