"""rospy.sleep and rospy.Rate as rospy documents them: a shutdown request interrupts them, also on the wall clock."""
from __future__ import annotations

import threading
import time
from typing import Any

import genpy
import rospy
import rospy.timer

from rbx1_nav.driving.commands import Commands, check_shutdown, fail, is_shutdown_function, now
from rbx1_nav.ros.node import life
from rbx1_nav.units import SECOND

MAX_DELAY = SECOND      # ns
_sleep = rospy.timer.sleep


# Any: seconds or a rospy.Duration
def sleep(duration: Any) -> None:
    """Sleep for a duration of ROS time: rospy.sleep. Inside a shutdown function, it is wall time, because a simulated
    clock may have stopped.

    Raises ROSInterruptException in the main thread as soon as shutdown is requested.
    """
    commands = Commands.current
    if commands and commands.thread == threading.get_ident():
        commands.due = None     # the script waits on purpose
    if not (rospy.rostime.is_wallclock() or is_shutdown_function()):
        _sleep(duration)
        return
    end = time.monotonic() + (duration.to_sec() if isinstance(duration, genpy.Duration) else duration)
    check_shutdown()
    while time.monotonic() < end:
        life.sleep(end - time.monotonic())
        check_shutdown()


def wait_for_tick() -> None:
    """On simulated time, wait until it advances: what begins now is prompted by the clock. Raises like sleep()."""
    if not rospy.rostime.is_wallclock():
        sleep(rospy.Duration(0, 1))


class Rate(rospy.timer.Rate):
    """rospy.Rate. In the thread that drives the robot in a Drive block, it makes up for delays.

    Its ticks begin with the first command of a motion. On the clock of a simulated base, which waits for this script,
    they are those of rospy.Rate. On any other clock, a delay is made up for over the next ticks, each at least 0.6
    periods long: otherwise a base could receive two commands in one step. A delay of more than MAX_DELAY is an error,
    because the base has stopped by then.
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
        sleep(rospy.Duration(0, max(self._due, commands.time + shortest) - now()))
        late = now() - self._due
        if late > MAX_DELAY:
            fail(f'A command is {late / SECOND:.1f} s late: expected at most {MAX_DELAY / SECOND:g} s, after which a '
                 'base stops')
        commands.due, commands.period = self._due, self._period
