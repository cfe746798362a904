"""Everything in a driving script except the maneuver: waiting for the base, monitoring it, progress, stopping.

Import this module first, so that Ctrl-C during the other imports exits quietly.
"""
from __future__ import annotations

import rbx1_nav.ros.node.early_interrupt    # noqa: F401

from math import pi, radians
from types import TracebackType
from typing import Callable, Iterator, Sequence, TypeVar

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.control.legs import whole_ticks
from rbx1_nav.parameters import Parameter, frame, number
from rbx1_nav.ros.driving.rate import Rate, pause, wait_for_tick
from rbx1_nav.ros.driving.waiting import wait_for_subscribers
from rbx1_nav.ros.driving.watching import Listeners
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.life import exit_status
from rbx1_nav.ros.node.params import param

__all__ = ['TimedDrive', 'exit_status', 'frame', 'init_node', 'number', 'param', 'whole_ticks']

WAIT_TIMEOUT = number('wait_timeout', 30, 's', 'maximum wait for roscore, and then for the base and its pose',
                      note='wall time')
MANY_TURNS = 4 * pi     # rad: an angle above this was probably meant in degrees

Self = TypeVar('Self', bound='Drive')


def init_node(name: str, usage: str, parameters: Sequence[Parameter] = ()) -> None:
    """Start the node `name` of a driving script, like life.init_node(), with the additional parameter ~wait_timeout."""
    life.init_node(name, usage, (*parameters, WAIT_TIMEOUT))
    for each in parameters:
        angle = param(each.name) if each.unit == 'rad' else 0.0
        if angle > MANY_TURNS:
            rospy.logwarn('%s/%s: %g: %.1f turns, because the unit is radians. For %g degrees: _%s:=%.6g',
                          rospy.get_name(), each.name, angle, angle / (2 * pi), angle, each.name, radians(angle))


class Drive:
    """A `with` block in which a script may drive: the base is connected, and the robot is stopped on exit.

    Raises ROSException if the base does not appear within ~wait_timeout s or disconnects during the run, and
    ROSInterruptException as soon as shutdown is requested. All methods must be called inside the block.
    """

    listeners: Listeners
    exact = False       # see wait_for_subscribers()

    def __init__(self, cmd_vel: rospy.Publisher, rate: float, stop: Callable[[], None]) -> None:
        """cmd_vel: publisher of Twist messages; rate: command rate, Hz; stop(): stops the robot, however the block is
        left."""
        self.cmd_vel = cmd_vel
        self.rate = rate
        self.stop = stop
        self.wait_timeout = param('wait_timeout')     # s
        self.current_rate: Rate | None = None

    def __enter__(self: Self) -> Self:
        try:
            self.begin()
            wait_for_tick(self.listeners)
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 traceback: TracebackType | None) -> None:
        self.stop()
        if kind is None:
            self.finish()

    def begin(self) -> None:
        """Wait for the base. Messages published before it subscribes would be lost."""
        self.listeners = wait_for_subscribers(self.cmd_vel, self.wait_timeout, self.exact)

    def finish(self) -> None:
        """Report the result; called when the robot has been stopped without an error."""

    def Rate(self) -> Rate:
        """Return a Rate for one motion, like rospy.Rate(rate)."""
        self.current_rate = Rate(self.rate, self.listeners)
        return self.current_rate

    def restart_rate(self) -> None:
        """Let the motion begin now, independently of the time that its log line and its progress bar took."""
        if self.current_rate:
            self.current_rate.restart()

    def rest(self, seconds: float) -> None:
        """Wait for `seconds` of ROS time, while the robot is stationary."""
        pause(seconds, self.listeners)


class TimedDrive(Drive):
    """Drives for a number of ticks."""

    exact = True
    distance = angle = 0.0      # m and rad, commanded so far

    def progress(self, name: str, ticks: int, command: Twist) -> Iterator[int]:
        """Yield the elements of range(ticks), for a motion with one command, and show its progress."""
        speed, unit = (command.linear.x, 'm') if command.linear.x else (command.angular.z, 'rad')
        rospy.loginfo('%s: %.2f %s at %g %s/s', name, ticks * speed / self.rate, unit, speed, unit)
        # with disable=None, tqdm shows its progress bar only in a terminal
        bar = tqdm(range(ticks), desc=name, disable=None, bar_format='{desc:9}: |{bar}| {n} of {total} commands')
        self.restart_rate()
        yield from bar
        self.distance += ticks * command.linear.x / self.rate
        self.angle += ticks * command.angular.z / self.rate

    def finish(self) -> None:
        self.listeners.check_delivery()
        # a script that does not use progress() has commanded something else
        commanded = f': commanded {self.distance:.2f} m forward and {self.angle:.2f} rad to the left'
        namespace = rospy.get_namespace().rstrip('/')
        rospy.loginfo('Done%s. To see where the robot is now, run: %srosrun rbx1_nav pose.py',
                      commanded if self.distance or self.angle else '',
                      f'ROS_NAMESPACE={namespace} ' if namespace else '')
