"""Simulated time, which a base advances in step with its drivers."""
from __future__ import annotations

from resource import RLIMIT_NOFILE, getrlimit, setrlimit
import threading
import time
from typing import Any, Callable

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
import rosgraph
from rosgraph_msgs.msg import Clock as ClockMessage
from rospy.impl import simtime

from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.lockstep.lockstep import Lockstep
from rbx1_nav.extras.lockstep.watched_nodes import Watch
from rbx1_nav.node import life, rospy_connections
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.master import call, is_alive
from rbx1_nav.node.parameters import flag, number
from rbx1_nav.node.private_parameters import param
from rbx1_nav.node.rospy_connections import NoDelay

CATCH_UP = 0.1      # s of wall time: a delay up to this is made up for
CLOCK_PERIOD = 0.7  # s of wall time between two searches for another clock

PARAMETERS = (
    number('real_time_factor', None, '', 'highest speed of simulated time, relative to real time', 0.01, 1000,
           shown='real time', note='see [Simulated time](reference.md#simulated-time)'),
    number('clock_step', 0.02, 's', 'step of simulated time', 0.001, 0.1, 'a time'),
    flag('strict', False, 'whether this node exits if a driver is not in step with simulated time'))


def read_clock(rate: float) -> Clock:
    """Return the clock selected by the private parameters real_time_factor, clock_step and strict, and /use_sim_time.

    rate: odometry rate, Hz. Raises ConfigError.
    """
    factor, step, strict = param('real_time_factor'), param('clock_step'), param('strict')
    if factor is not None:
        if rospy.rostime.is_wallclock():
            raise ConfigError(f'real_time_factor: {factor:g}: expected /use_sim_time to be true')
        clock = OwnClock(factor, rate, round(step * SECOND), strict)
        other = earlier_clock()
        if other:
            raise ConfigError(f'real_time_factor: {factor:g}: expected no other clock, but {other} publishes /clock: '
                              'fleet.launch simulates several robots on one clock')
        return clock
    if strict or rospy.has_param('~clock_step'):
        given = 'strict: true' if strict else f'clock_step: {step:g}'
        raise ConfigError(f'{given}: expected a simulated clock of this node: real_time_factor is not set')
    if not rospy.rostime.is_wallclock():
        raise ConfigError('real_time_factor: missing: expected one, because /use_sim_time is true. fleet.launch '
                          'simulates several robots on one clock')
    return Clock(rate)


def clock_publishers() -> list[str]:
    """Return the names of the registered publishers of /clock, in the order in which they have registered."""
    publishers, _, _ = call(rosgraph.get_master_uri(), 'getSystemState')
    return [name for topic, names in publishers if topic == '/clock' for name in names]


def earlier_clock() -> str | None:
    """Return the name of a live node that registered as a publisher of /clock before this node, or None.

    The master keeps the order, so of two nodes that start at the same time, only the second one finds the other.
    """
    names = clock_publishers()
    if rospy.get_name() not in names:
        raise rospy.ROSException('another node with this name has just started: expected only one')
    return next((name for name in names[:names.index(rospy.get_name())] if is_alive(name)), None)


class OwnClock(Clock):
    """Simulated time that this node advances: at most `factor` times as fast as real time, in step with the drivers."""

    def __init__(self, factor: float, rate: float, period: int, strict: bool) -> None:
        """factor, rate: see read_clock(); period: clock period, ns; strict: whether a driver that is not in step is an
        error."""
        self.time = 0       # ns
        self.schedule = Schedule(rate)
        self.factor = factor
        self.period = period
        self.strict = strict
        # rospy subscribes each node to /clock. This node sets the time, and receiving it would take a sixth of a tick.
        simtime._clock_sub.unregister()
        # the usual limit of 1,024 open files is enough for the threads of about 17 drivers; see lockstep/processes.py
        setrlimit(RLIMIT_NOFILE, 2 * getrlimit(RLIMIT_NOFILE)[1:])
        self.publisher = rospy.Publisher('/clock', ClockMessage, NoDelay(self.greet_with_time), queue_size=10)
        self.nodes = Watch(self.publisher)
        self.lockstep = Lockstep(self.nodes, self.report, life.end_requested.is_set)
        rospy_connections.gates.append(self.nodes.connecting)
        self.not_in_step: dict[str, str] = {}   # reasons, by the name of the node

    def greet_with_time(self, _: str, publish: Callable[[ClockMessage], None]) -> None:
        if self.time:
            self.nodes.greetings.append((False, lambda: publish(ClockMessage(self.stamp(self.time)))))

    def greet(self, send: Callable[[], None]) -> None:
        self.nodes.greetings.append((True, send))

    def now(self) -> int:
        return self.time

    def stamp(self, instant: int) -> rospy.Time:
        return rospy.Time(0, instant)

    def watch(self, subscriber: Any) -> None:
        self.nodes.commands.append(subscriber.impl)

    def unwatch(self, subscriber: Any) -> None:
        self.nodes.commands.remove(subscriber.impl)

    def receive(self, target: Any, header: dict[str, str], command: Any) -> None:
        self.lockstep.receive(target, header, command)

    def publish(self, publisher: rospy.Publisher, message: Any) -> None:
        self.lockstep.deliver(publisher, message)

    def report(self, name: str, reason: str) -> None:
        """Report that a node is not in step. Raises ROSException if that is an error."""
        if self.strict:
            raise rospy.ROSException(f'strict: {name} {reason}: expected nodes that are in step with /clock')
        self.not_in_step[name] = reason
        rospy.logwarn('%s %s: not in step with /clock. The clock no longer waits for it, and the end pose of the robot '
                      'depends on the speed of the machine. Expected a node that sleeps on simulated time, as '
                      'rospy.Rate does', name, reason)

    def diagnose(self, status: DiagnosticStatus) -> None:
        if self.not_in_step:
            status.mergeSummary(DiagnosticStatus.WARN, f"Not in step with /clock: {', '.join(self.not_in_step)}")
        status.add('Nodes not in step with /clock',
                   '; '.join(f'{name} {reason}' for name, reason in self.not_in_step.items()) or 'none')

    def watch_clocks(self) -> None:
        """Name each node that also publishes /clock."""
        named: set[str] = {rospy.get_name()}
        before: set[str] = set()
        while not life.end_requested.wait(CLOCK_PERIOD):
            try:
                found = set(clock_publishers()) - named
            except Exception:       # the master does not answer
                continue
            for name in found & before:     # not a base that is about to exit
                named.add(name)
                rospy.logerr('%s publishes /clock, too, so that time moves back and forth: expected only this base to '
                             'publish it (rosbag play: without --clock)', name)
            before = found

    def run(self, step: Callable[[], None]) -> None:
        threading.Thread(target=self.watch_clocks, daemon=True).start()
        beat = time.monotonic()
        while not life.end_requested.is_set():
            self.lockstep.begin()
            self.lockstep.apply()
            self.time += self.period
            stamp = self.stamp(self.time)
            rospy.rostime._set_rostime(stamp)
            if self.schedule.due(self.time):
                step()
            self.publish(self.publisher, ClockMessage(stamp))
            self.lockstep.apply()
            beat = max(beat + self.period / SECOND / self.factor, time.monotonic() - CATCH_UP)
            self.lockstep.listen(beat)
