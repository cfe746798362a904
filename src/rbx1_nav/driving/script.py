"""Makes rospy keep its promises in a driving script, which is plain rospy.

Importing this module replaces rospy's init_node, is_shutdown, signal_shutdown, sleep, Rate and Publisher.publish. From
init_node() on, a signal is handled in a thread: it publishes a zero Twist, calls the functions of rospy.on_shutdown,
and interrupts the main thread at its next call of rospy. docs/decisions/nodes.md explains why.
"""
from __future__ import annotations

import atexit
from math import pi, radians
import os
import signal
import sys
import threading
import time
import traceback
from types import TracebackType
from typing import Any, Callable, Sequence, TypeVar

import rosgraph
import rospy
import rospy.client
import rospy.core
import rospy.timer
from geometry_msgs.msg import Twist

from rbx1_nav.driving import rate, stopping
from rbx1_nav.driving.base_connection import wait_for_listeners
from rbx1_nav.driving.stopping import Commands, end, shutdown_wanted
from rbx1_nav.node import life
from rbx1_nav.node.life import end_requested
from rbx1_nav.node.parameters import Parameter, number, split_usage
from rbx1_nav.node.private_parameters import param

WAIT_TIMEOUT = number('wait_timeout', 30, 's', 'maximum wait for roscore, and then for the base and its pose',
                      note='wall time')
MANY_TURNS = 4 * pi     # rad: an angle above this was probably meant in degrees
PACKAGE = os.path.realpath(os.path.join(os.path.dirname(__file__), '..')) + os.sep

Self = TypeVar('Self', bound='Drive')
_started: list[int] = []    # id of the process that has started a node
_functions_called = threading.Event()       # the functions of rospy.on_shutdown
_script_ended = threading.Event()
_results: list[tuple[Callable[..., None], str]] = []    # of the blocks that have been completed: how to log, and a text
_failed: list[BaseException] = []       # errors with which blocks have been left
_interrupted: list[BaseException] = []  # ROSInterruptExceptions that the script has not caught
_thread_excepthook = threading.excepthook


def init_node(name: str, *args: Any, **options: Any) -> None:
    """Start a node: rospy.init_node.

    If the docstring of the script has a list of parameters, it is the usage text: it is printed for --help, and the
    command line and the parameters are checked against it, see parameters.split_usage(). There is an additional
    parameter, ~wait_timeout. Raises like life.init_node().
    """
    usage, parameters = split_usage(sys._getframe(1).f_globals.get('__doc__') or '')
    names = 'argv', 'anonymous', 'log_level', 'disable_rostime', 'disable_rosout', 'disable_signals'
    options.update(zip(names, args))
    start_node(name, usage if parameters else '', parameters, **options)


def start_node(name: str, usage: str, parameters: Sequence[Parameter], **options: Any) -> None:
    """Start the node of a driving script, like life.init_node()."""
    if not _started:
        _started.append(os.getpid())
        # both are the first ones: from here on, no command to move is published; rospy's own hook waits for the master
        rospy.core.add_client_shutdown_hook(stopping.stop_robots)
        rospy.core.add_preshutdown_hook(_finish)
        threading.Thread(target=_shut_down, daemon=True).start()
    life.init_node(name, usage, [*parameters, WAIT_TIMEOUT], on_signal=lambda number: end(128 + number), **options)
    for each in parameters:
        angle = param(each.name) if each.unit == 'rad' else 0.0
        if angle > MANY_TURNS:
            rospy.logwarn('%s/%s: %g: %.1f turns, because the unit is radians. For %g degrees: _%s:=%.6g',
                          rospy.get_name(), each.name, angle, angle / (2 * pi), angle, each.name, radians(angle))


def _shut_down() -> None:
    """Wait for a shutdown request or the end of the script. This thread exists from the start, because Python 3.12
    cannot start one while it exits."""
    shutdown_wanted.wait()
    stopping.signal_shutdown('requested')


def _finish(_: str) -> None:
    """Log the results; called by rospy after the functions of rospy.on_shutdown, while it can still publish."""
    for log, text in _results:
        if not (end_requested.is_set() or _failed):
            log('%s', text)
    _functions_called.set()
    _script_ended.wait(0.1)     # with a line that goes to /rosout, too
    time.sleep(0.02)


@atexit.register
def _exit() -> None:
    """Call the functions of rospy.on_shutdown, and unregister the node, without waiting for a master that hangs."""
    if _started != [os.getpid()]:       # not in a child process
        return
    _script_ended.set()
    shutdown_wanted.set()
    _functions_called.wait()
    life.wait_for_shutdown()
    if end_requested.is_set() or _failed:
        os._exit(life.exit_status[0])
    if _interrupted:        # the script itself has called rospy.signal_shutdown()
        os._exit(0)


def _report(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Log an error that rospy or this package has detected in one line; print the traceback of any other."""
    if issubclass(kind, rospy.ROSInterruptException) and stopping.is_shutdown():
        _interrupted.append(error)
        return
    frames = traceback.extract_tb(trace)
    by_us = [os.path.realpath(each.filename).startswith(PACKAGE) for each in frames]
    if issubclass(kind, ConnectionError) and (any(by_us) or any('/rospy/' in each.filename for each in frames)):
        rospy.logerr('The master at %s does not answer (%s)', rosgraph.get_master_uri(), error)
    elif issubclass(kind, rospy.ROSException) or (
            issubclass(kind, ValueError) and by_us[-1]):
        rospy.logerr('%s', error)
    else:
        sys.__excepthook__(kind, error, trace)
    end(128 + signal.SIGINT if kind is KeyboardInterrupt else 1)     # also for a thread that drives on


def _report_in_thread(arguments: Any) -> None:
    """Like _report(), for threading.excepthook."""
    if not (issubclass(arguments.exc_type, rospy.ROSInterruptException) and stopping.is_shutdown()):
        _thread_excepthook(arguments)


class Drive:
    """A `with` block in which a script drives: the base is monitored, and the robot is stopped at the end.

    Raises ROSException if the base does not appear within ~wait_timeout s. If it does not follow the commands until the
    end of the block, the script is shut down with status 1.
    """

    commands: Commands

    def __init__(self, cmd_vel: rospy.Publisher, timed: bool = True) -> None:
        """cmd_vel: publisher of Twist messages; timed: whether the robot goes wrong if a command is late, clamped or
        lost. It does, unless the script uses its pose."""
        if getattr(cmd_vel, 'data_class', None) is not Twist:
            raise rospy.ROSException(f'Drive: {cmd_vel!r}: expected a rospy.Publisher of geometry_msgs/Twist')
        self.cmd_vel = cmd_vel
        self.timed = timed

    def __enter__(self: Self) -> Self:
        if not _started:
            raise rospy.ROSException('Drive: expected rospy.init_node() before it, and rbx1_nav.driving to be imported '
                                     'before that')
        try:
            listeners = wait_for_listeners(self.cmd_vel, param('wait_timeout'), self.timed, stopping.fail)
            rate.wait_for_tick()
        except rospy.ROSException as problem:
            if not stopping.is_shutdown():
                _failed.append(problem)
            raise
        rospy.loginfo('Connected to %s', ', '.join(each.name for each in listeners.called))
        self.commands = Commands.current = Commands(self.cmd_vel, listeners, self.timed)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        if kind is None:
            stopping.halt()
        stopping.stop_robots()
        Commands.current = None
        try:
            if kind is None and not stopping.is_shutdown():
                self.commands.listeners.finish(self.commands.moved)
                _results.append(self.commands.result())
        except rospy.ROSException as problem:
            _failed.append(problem)
            raise
        finally:
            self.commands.listeners.release()
        if end_requested.is_set():      # the lines of the log are then in order
            _functions_called.wait(life.EXIT_DEADLINE)
        elif isinstance(error, SystemExit):
            end(error.code if isinstance(error.code, int) else int(error.code is not None))
        elif error and not stopping.is_shutdown():
            _failed.append(error)


rospy.init_node = rospy.client.init_node = init_node
rospy.is_shutdown = rospy.core.is_shutdown = stopping.is_shutdown
rospy.signal_shutdown = rospy.core.signal_shutdown = stopping.signal_shutdown
rospy.sleep = rospy.timer.sleep = rate.sleep
rospy.Rate = rospy.timer.Rate = rate.Rate
rospy.Publisher.publish = stopping.publish
sys.excepthook, threading.excepthook = _report, _report_in_thread
