"""rospy.sleep and rospy.Rate as rospy documents them: a shutdown request interrupts them, also on the wall clock."""
from __future__ import annotations

import threading
import time
from typing import Any

import genpy
import rospy
import rospy.timer

from rbx1_nav.base.units import SECOND
from rbx1_nav.driving.stopping import Commands, check_shutdown, fail, is_shutdown, is_shutdown_function, now
from rbx1_nav.node import life

MAX_DELAY = SECOND      # ns


# Any: seconds or a rospy.Duration
def sleep(duration: Any) -> None:
    """Sleep for a duration of ROS time: rospy.sleep. Inside a shutdown function, it is wall time, because a simulated
    clock may have stopped.

    Raises ROSInterruptException as soon as shutdown is requested, on the wall clock only in the main thread, and
    ROSTimeMovedBackwardsException.
    """
    nanoseconds = duration.to_nsec() if isinstance(duration, genpy.Duration) else round(duration * SECOND)
    if is_shutdown_function():
        time.sleep(max(0, nanoseconds) / SECOND)
        return
    commands = Commands.current
    if commands and commands.thread == threading.get_ident():
        commands.due = None     # the script waits on purpose
    while not now():        # before the first message on /clock
        time.sleep(0.02)
        check_shutdown()
    _wait_until(now() + nanoseconds)


def _wait_until(end: int) -> None:
    """Wait until now() is `end` (ns). Raises like sleep()."""
    if rospy.rostime.is_wallclock():
        check_shutdown()
        while now() < end:
            life.sleep((end - now()) / SECOND)
            check_shutdown()
        return
    begin, clock_moved = now(), rospy.rostime.get_rostime_cond()
    with clock_moved:
        while begin <= now() < end and not is_shutdown():
            clock_moved.wait(0.5)
    if now() < begin:
        raise rospy.exceptions.ROSTimeMovedBackwardsException((begin - now()) / SECOND)
    if is_shutdown():
        raise rospy.ROSInterruptException('shutdown requested')


def wait_for_tick() -> None:
    """On simulated time, wait until it advances: what begins now is prompted by the clock. Raises like sleep()."""
    if not rospy.rostime.is_wallclock():
        sleep(rospy.Duration(0, 1))


class Rate(rospy.timer.Rate):
    """rospy.Rate. In the thread that drives the robot in a Drive block, it makes up for delays.

    Its ticks begin with the first command of a motion. On the clock of a simulated base, which waits for this script,
    they equal the ticks of rospy.Rate. On any other clock, a delay is made up for over the next ticks, each at least
    0.6 periods long: otherwise a base could receive two commands in one step. A delay of more than MAX_DELAY is an
    error, because the base has stopped by then.
    """

    def __init__(self, hz: float, reset: bool = False) -> None:
        """See rospy.Rate. hz: ticks per second."""
        super().__init__(hz, reset)
        self._period = self.sleep_dur.to_nsec()
        self._motion = Commands.current.motions if Commands.current else None   # for which _due is valid
        self._due = now()       # ns: last tick without delays

    def sleep(self) -> None:
        """Wait for the next tick. Raises like rospy.sleep()."""
        commands = Commands.current
        if not (commands and commands.thread == threading.get_ident() and commands.moving):
            super().sleep()
            return
        if self._motion != commands.motions:
            self._motion, self._due = commands.motions, commands.begin
        self._due += self._period
        shortest = 0 if commands.listeners.on_clock_of_base else self._period * 6 // 10
        _wait_until(max(self._due, commands.time + shortest))
        self.last_time = rospy.rostime.get_rostime()    # for remaining()
        late = now() - self._due
        if late > MAX_DELAY:
            fail(f'A command is {late / SECOND:.1f} s late: expected at most {MAX_DELAY / SECOND:g} s, after which a '
                 'base stops')
        commands.due, commands.period = self._due, self._period
