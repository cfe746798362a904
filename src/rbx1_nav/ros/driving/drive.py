"""What a driving script leaves to others: it waits for the base, watches it, shows the progress, and stops the
robot."""
from __future__ import annotations

from types import TracebackType
from typing import Callable, Iterator, Optional, Type, TypeVar

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.ros.driving.rate import Rate, pause
from rbx1_nav.ros.driving.waiting import wait_for_subscribers
from rbx1_nav.ros.driving.watching import Listeners
from rbx1_nav.ros.node.params import param

Self = TypeVar('Self', bound='Drive')


class Drive:
    """A `with` block in which a script may drive: the base listens, and the robot is stopped at the end.

    Raises ROSException if the base does not come within ~wait_timeout s, or is lost on the way, ROSInterruptException
    as soon as the node is to end. All methods belong into the block.
    """

    listeners: Listeners

    def __init__(self, cmd_vel: rospy.Publisher, rate: float, stop: Callable[[], None]) -> None:
        """cmd_vel: of Twist messages; rate: of the commands, Hz; stop(): stops the robot, however the block ends."""
        self.cmd_vel = cmd_vel
        self.rate = rate
        self.stop = stop
        self.wait_timeout = param('wait_timeout')     # s
        self.current_rate: Optional[Rate] = None

    def __enter__(self: Self) -> Self:
        try:
            self.begin()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.stop()
        if kind is None:
            self.finish()

    def begin(self) -> None:
        """Wait for the base. What is published before anyone subscribes is lost."""
        self.listeners = wait_for_subscribers(self.cmd_vel, self.wait_timeout)

    def finish(self) -> None:
        """Called when the robot has been stopped and nothing has gone wrong."""

    def Rate(self) -> Rate:
        """A Rate, as rospy.Rate(rate), for one motion."""
        self.current_rate = Rate(self.rate, self.listeners)
        return self.current_rate

    def restart_rate(self) -> None:
        """The motion begins now, however long its log line and its progress bar took."""
        if self.current_rate:
            self.current_rate.restart()

    def rest(self, seconds: float) -> None:
        """Wait for `seconds` of ROS time, while the robot is stationary."""
        pause(seconds, self.listeners)


class TimedDrive(Drive):
    """Drives for a number of ticks."""

    distance = angle = 0.0      # m and rad, commanded so far

    def progress(self, name: str, ticks: int, command: Twist) -> Iterator[int]:
        """As range(ticks), for a motion of one command, and shows its progress."""
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
        rospy.loginfo('Done: commanded %.2f m forward and %.2f rad to the left. To see where that led: '
                      'rosrun rbx1_nav pose.py', self.distance, self.angle)
