"""A stand-in for what a timed driving script uses of rospy. Simulated time passes only while the script sleeps."""
from __future__ import annotations

from contextlib import contextmanager
from functools import partial
import sys
from types import ModuleType
from typing import Any, Callable, Iterator, NoReturn

from rbx1_nav.base.command_gate import RejectedCommand
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.many_runs.simulated_run import Simulation
from rbx1_nav.extras.page.recorded_run import ERROR, INFO, WARNING, Stopped

LEVELS = {'logdebug': INFO, 'loginfo': INFO, 'logwarn': WARNING, 'logerr': ERROR, 'logfatal': ERROR}


class ROSException(Exception):
    """As in rospy."""


class ROSInterruptException(ROSException):
    """As in rospy."""


class Vector3:
    __slots__ = 'x', 'y', 'z'       # a misspelled attribute is an error, as in ROS

    def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        self.x, self.y, self.z = x, y, z


class Twist:
    __slots__ = 'linear', 'angular'

    def __init__(self, linear: Vector3 | None = None, angular: Vector3 | None = None) -> None:
        self.linear, self.angular = linear or Vector3(), angular or Vector3()


class Duration(float):
    """A number of seconds; as a time, since simulated time 0."""

    to_sec = float.__float__

    def __sub__(self, other: float) -> Duration:
        return Duration(float.__sub__(self, other))


class Rospy:
    """The modules that a script imports. They replace those in sys.modules."""

    def __init__(self, simulation: Simulation, log: Callable[[int, str], None], parameters: dict[str, Any]) -> None:
        """log(level, text): logs a line; parameters: the private parameters of the script."""
        self.simulation, self.log = simulation, log
        self.started = self.shut_down = self.is_shutdown = False    # in the functions of on_shutdown, rospy still runs
        self.functions: list[Callable[[], object]] = []     # of rospy.on_shutdown
        ros = self

        class Time(Duration):
            now = staticmethod(lambda: Duration(ros.now() / SECOND))

        class Rate:
            def __init__(self, hz: float, reset: bool = False) -> None:
                self.period, self.last = round(SECOND / hz), ros.now()

            def sleep(self) -> None:
                before = ros.now()
                ros.wait_until(self.last + self.period)
                self.last += self.period
                if before - self.last > 2 * self.period:    # as rospy does
                    self.last = before

        class Publisher:
            def __init__(self, name: str, data_class: type, *_: Any, **__: Any) -> None:
                if name.lstrip('/') != 'cmd_vel' or data_class is not Twist:
                    raise ROSException(f'the topic {name} does not exist on this page: expected cmd_vel with Twist')

            def publish(self, message: Any = None, **fields: Any) -> None:
                ros.command(Twist(**fields) if message is None else message)

        @contextmanager
        def drive(cmd_vel: Publisher, timed: bool = True) -> Iterator[None]:
            try:
                yield
            finally:
                cmd_vel.publish(Twist())

        modules: dict[str, dict[str, Any]] = {
            'rospy': {'ROSException': ROSException, 'ROSInterruptException': ROSInterruptException, 'Time': Time,
                      'Duration': Duration, 'Rate': Rate, 'Publisher': Publisher,
                      'get_param': lambda name, *default: parameters.get(name.lstrip('~'), *default) if default
                      else parameters[name.lstrip('~')],
                      'init_node': lambda name, *_, **__: setattr(self, 'started', True),
                      'on_shutdown': self.functions.append, 'is_shutdown': lambda: self.is_shutdown,
                      'sleep': lambda duration: self.wait_until(self.now() + round(duration * SECOND)),
                      'signal_shutdown': lambda reason: self.shutdown(), 'get_time': Time.now,
                      **{name: partial(self.log_line, level) for name, level in LEVELS.items()}},
            'geometry_msgs': {}, 'geometry_msgs.msg': {'Twist': Twist, 'Vector3': Vector3},
            'rbx1_nav.driving': {'Drive': drive}}
        for name, content in modules.items():
            module = sys.modules[name] = ModuleType(name)
            vars(module).update(content, __path__=[], __getattr__=lambda key, name=name: missing(f'{name}.{key}'))
        vars(sys.modules['geometry_msgs'])['msg'] = sys.modules['geometry_msgs.msg']

    def now(self) -> int:
        """Return the time, ns. Raises ROSException before init_node()."""
        if not self.started:
            raise ROSException('expected rospy.init_node() before this line')
        return self.simulation.now

    def command(self, message: Any) -> None:
        """Put a Twist in force; after a shutdown request, only the functions of on_shutdown can do so."""
        time, linear, angular, gate = self.now(), message.linear, message.angular, self.simulation.base.gate
        try:
            if not self.is_shutdown and self.simulation.base.command(
                    time, linear.x, angular.z, (linear.y, linear.z, angular.x, angular.y)) and gate.clamped == 1:
                self.log(WARNING, f'{linear.x:g} m/s, {angular.z:g} rad/s: expected at most '
                                  f'{gate.limits.linear:g} m/s, {gate.limits.angular:g} rad/s; clamped')
        except RejectedCommand as error:
            self.log(WARNING, f'Rejected a command: {error}')

    def log_line(self, level: int, text: object, *values: object, **_: object) -> None:
        self.log(level, str(text) % values if values else str(text))

    def wait_until(self, end: int) -> None:
        """Let simulated time pass until `end` (ns). Raises ROSInterruptException after a shutdown request."""
        while self.simulation.now < end and not self.is_shutdown:
            try:
                self.simulation.tick()
            except Stopped:
                if self.shut_down:      # these functions take too long
                    raise
                self.simulation.base.command(self.simulation.now, 0.0, 0.0)
                self.shutdown()
        if self.is_shutdown:
            raise ROSInterruptException('shutdown requested')

    def shutdown(self) -> None:
        """Call the functions of on_shutdown."""
        if not self.shut_down:
            self.shut_down = True
            for function in self.functions:
                function()
            self.is_shutdown = True


def missing(name: str) -> NoReturn:
    if '__' in name:        # what Python itself asks for
        raise AttributeError(name)
    raise NotImplementedError(f'{name} does not exist on this page')
