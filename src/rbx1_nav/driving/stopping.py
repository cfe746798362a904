"""The commands of a driving script: none to move is published after a shutdown request, and the last one is a stop."""
from __future__ import annotations

from contextlib import suppress
import threading
import time
from typing import Any, Callable

import rospy
from geometry_msgs.msg import Twist
from rospy.msg import args_kwds_to_message

from rbx1_nav.base.units import SECOND
from rbx1_nav.driving.base_connection import Listeners
from rbx1_nav.node.life import end_requested, exit_status, request_end

MAX_LATE_STOP = SECOND // 20    # ns: a robot that stops later has moved by more than a timed script can ignore
LOCK_TIMEOUT = 0.1      # s: a stop does not wait longer for a publisher that hangs
_publish, _signal_shutdown = rospy.Publisher.publish, rospy.core.signal_shutdown
is_shutdown_of_rospy = rospy.core.is_shutdown     # true only after the functions of rospy.on_shutdown
# a command to move is published before a stop, or not at all; reentrant, for a script's own signal handler
_lock = threading.RLock()
_moving: dict[str, rospy.Publisher] = {}    # publishers whose last command was to move, by topic
shutdown_wanted = threading.Event()     # makes a thread call rospy.signal_shutdown, see script.py
_shutdown_threads: set[int] = set()     # threads that are calling the functions of rospy.on_shutdown


def now() -> int:
    """Return simulated time, or the time of the monotonic clock, in ns."""
    return time.monotonic_ns() if rospy.rostime.is_wallclock() else rospy.get_rostime().to_nsec()


def signal_shutdown(reason: str) -> None:
    """Stop the robots, see script.start_node(), then call the functions of rospy.on_shutdown: rospy.signal_shutdown."""
    _shutdown_threads.add(threading.get_ident())
    try:
        _signal_shutdown(reason)
    finally:
        _shutdown_threads.discard(threading.get_ident())


def is_shutdown_function() -> bool:
    """Return whether this thread is calling the functions of rospy.on_shutdown."""
    return threading.get_ident() in _shutdown_threads


def is_shutdown() -> bool:
    """Return whether shutdown has been requested: rospy.is_shutdown. To the functions of rospy.on_shutdown, rospy is
    still running."""
    if is_shutdown_function():
        return bool(is_shutdown_of_rospy())
    return end_requested.is_set() or bool(rospy.core.is_shutdown_requested())


def check_shutdown() -> None:
    """In the main thread, raise ROSInterruptException if shutdown has been requested."""
    if is_shutdown() and threading.current_thread() is threading.main_thread():
        raise rospy.ROSInterruptException('shutdown requested')


def stop_robots() -> None:
    """Publish a zero Twist on each topic on which the last command was to move."""
    locked = _lock.acquire(timeout=LOCK_TIMEOUT)
    for publisher in list(_moving.values()):
        with suppress(Exception):       # a topic that has been closed
            _publish(publisher, Twist())
    _moving.clear()
    if locked:
        _lock.release()


def halt() -> None:
    """Stop the robots. The script may go on."""
    for publisher in list(_moving.values()):
        publish(publisher, Twist())


def end(status: int, text: str = '') -> None:
    """Stop the robots, log an error, and shut down: the process exits with this status. The first call counts."""
    # a script that has called rospy.signal_shutdown() is no longer connected, which is no error
    if not (end_requested.is_set() or text and rospy.core.is_shutdown_requested()):
        exit_status[0] = status
        request_end()
        stop_robots()
        if text:
            rospy.logerr('%s', text)
    shutdown_wanted.set()


def fail(text: str) -> None:
    """End the script with an error. Raises like check_shutdown()."""
    end(1, text)
    check_shutdown()


class Commands:
    """What the block of a Drive has commanded."""

    current: Commands | None = None     # of the block that runs

    def __init__(self, publisher: rospy.Publisher, listeners: Listeners, timed: bool) -> None:
        """timed: whether a stop that comes late is an error."""
        self.topic = publisher.resolved_name
        self.listeners = listeners
        self.timed = timed
        self.thread: int | None = None      # that has sent the last command
        self.linear = self.angular = 0.0    # m/s and rad/s, of the last command
        self.moving = False     # whether the last command was to move
        self.time = now()       # ns, of the last command
        self.moved = 0.0        # s of the monotonic clock, of the last command to move
        self.motions = 0        # number of motions, each of which begins after a stop
        self.begin: int         # ns, of the last motion
        self.period = 0         # ns, of its Rate
        self.due: int | None = None     # ns: when the next command is due; None without a Rate
        self.ticks = 0          # commands of the last motion
        self.distance = self.angle = 0.0    # m and rad, so far
        self.before: tuple[float, float]    # distance and angle at the begin of the last motion
        self.longest = 0        # ns, longest delay of a command

    def add(self, message: Twist, moving: bool) -> int:
        """Add a command. Return by how much it is late, ns."""
        time_now = now()
        seconds = (time_now - self.time) / SECOND
        self.distance += self.linear * seconds
        self.angle += self.angular * seconds
        late = max(0, time_now - self.due) if self.moving and self.due is not None else 0
        self.longest = max(self.longest, late)
        if moving and not self.moving:
            self.motions += 1
            self.begin, self.due, self.ticks = time_now, None, 0
            self.before = self.distance, self.angle
        self.ticks += moving
        self.moved = time.monotonic() if moving else self.moved
        self.thread, self.time, self.moving = threading.get_ident(), time_now, moving
        self.linear, self.angular = message.linear.x, message.angular.z
        return late

    def result(self) -> tuple[Callable[..., None], str]:
        """Return how to log the result, and a text."""
        namespace = rospy.get_namespace().rstrip('/')
        where = ('To see where the robot is now, run: '
                 f"{namespace and f'ROS_NAMESPACE={namespace} '}rosrun rbx1_nav pose.py")
        if not self.timed:
            return rospy.loginfo, f'Done. {where}'
        text = (f'Done: commanded {self.distance:.2f} m forward and {self.angle:.2f} rad to the left. '
                f'The longest delay of a command was {self.longest / 1e6:.0f} ms')
        if self.longest <= self.period:
            return rospy.loginfo, f'{text}. {where}'
        return rospy.logwarn, (f'{text}, more than a period: the robot may be off by more than a millimeter or two. '
                               f'{where}')


def publish(publisher: rospy.Publisher, *args: Any, **keywords: Any) -> None:
    """Publish a message: rospy.Publisher.publish. After a shutdown request, a Twist that is not zero is dropped, and
    the main thread is interrupted."""
    if publisher.data_class is not Twist:
        _publish(publisher, *args, **keywords)
        return
    message = args_kwds_to_message(Twist, args, keywords)
    moving = any((message.linear.x, message.linear.y, message.linear.z,
                  message.angular.x, message.angular.y, message.angular.z))
    topic, commands, late = publisher.resolved_name, Commands.current, 0
    if commands and topic != commands.topic:
        commands = None
    stopped = commands and commands.moving and not moving
    problem = commands.listeners.problem() if commands and moving else ''
    with _lock:
        if not moving:
            _moving.pop(topic, None)
        elif not (problem or end_requested.is_set() or rospy.core.is_shutdown_requested()):
            _moving[topic] = publisher
        else:
            message = None
        if message:
            late = commands.add(message, moving) if commands else 0
            _publish(publisher, message)
    if problem:
        fail(problem)
    if not message:
        check_shutdown()
    elif commands and stopped:
        rospy.loginfo('%d commands in %.2f s: %.2f m forward, %.2f rad to the left', commands.ticks,
                      (commands.time - commands.begin) / SECOND, commands.distance - commands.before[0],
                      commands.angle - commands.before[1])
        if commands.timed and late > MAX_LATE_STOP:
            fail(f'The robot was stopped {late / SECOND:.2f} s late, so it has moved too far: expected at most '
                 f'{MAX_LATE_STOP / SECOND:g} s')
