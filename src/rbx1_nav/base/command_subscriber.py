"""Receives the commands of a base and passes them through its gate."""
from __future__ import annotations

from math import inf
from threading import Lock
from typing import Any, Iterable, NamedTuple, Protocol, Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper
from geometry_msgs.msg import Twist
from std_msgs.msg import Float64

from rbx1_nav.base import messages
from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.command_gate import CommandGate, RefusedCommand, RejectedCommand
from rbx1_nav.base.conflicting_commands import Senders
from rbx1_nav.base.late_commands import Bursts
from rbx1_nav.base.robot_parameters import Joint
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.base.units import SECOND

RECENT = SECOND * 3 // 2    # ns: an older contradiction is not shown


class VelocityCommand(NamedTuple):
    """The contents of a Twist, and who sent it."""

    linear: float       # m/s
    angular: float      # rad/s
    others: tuple[float, float, float, float]       # velocities that a differential drive cannot follow
    sender: str         # name of the node


class Base(Protocol):
    """Interface of a base that follows commands."""

    def command(self, now: int, linear: float, angular: float, others: Sequence[float], sender: str) -> bool:
        """Put a command in force at `now` (ns); return whether it was clamped. Raises RejectedCommand,
        RefusedCommand."""


class VelocityCommands:
    """Subscribes to cmd_vel, logs what the gate does with a command, and informs the sender of a refused command."""

    def __init__(self, base: Base, gate: CommandGate, clock: Clock, lock: Lock, namespace: str = '',
                 refusals: Refusals | None = None, wheel_limit: float = inf) -> None:
        """gate, lock: the CommandGate and the lock of the base; namespace: of the topic, with a slash at the end, ''
        for the namespace of this node; refusals: of this node, if it has several bases; wheel_limit: m/s."""
        self.base = base
        self.gate = gate
        self.clock = clock
        self.lock = lock
        self.namespace = namespace
        self.topic = rospy.resolve_name(f'{namespace}cmd_vel')
        self.wheel_limit = wheel_limit
        self.senders = Senders()
        self.bursts = Bursts(gate.timeout)
        self.subscriber: rospy.Subscriber | None = None
        self.refusals = refusals or Refusals()
        self.sender = ''        # of the command in force

    def subscribe(self) -> None:
        """Accept commands from now on."""
        if not self.subscriber:
            self.subscriber = rospy.Subscriber(f'{self.namespace}cmd_vel', Twist, self.on_twist, queue_size=None,
                                               tcp_nodelay=True)
            self.clock.watch(self.subscriber)

    def close(self) -> None:
        """Accept no more commands."""
        if self.subscriber:
            self.clock.unwatch(self.subscriber)
            self.subscriber.unregister()

    # Any: rospy has no types
    def connections(self) -> list[Any]:
        """Return rospy's current connections to publishers of cmd_vel."""
        return self.subscriber.impl.connections if self.subscriber else []

    def on_twist(self, twist: Twist) -> None:
        """Process a command, which takes effect now or when the clock applies it."""
        header = twist._connection_header       # one object for each connection
        command = VelocityCommand(
            linear=twist.linear.x, angular=twist.angular.z, sender=header['callerid'],
            others=(twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y))
        text = self.senders.contradiction(
            self.clock.now(), header, command.sender, (command.linear, command.angular),
            lambda: [connection.header for connection in self.connections()])
        if text:
            rospy.logwarn_throttle(5, f'{self.topic}: contradictory commands: {text}: expected only one driving node')
        self.clock.receive(self, header, command)

    def apply(self, command: VelocityCommand) -> None:
        """Put a command in force, or stop the base if the command belongs to a burst."""
        now = self.clock.now()
        if (command.linear or command.angular) and self.bursts.drops(now, command.sender):
            if self.sender != command.sender:
                return
            command = command._replace(linear=0.0, angular=0.0)
            rospy.logwarn_throttle(5, f'{self.topic}: the commands of {command.sender} arrive all at once after a '
                                      'silence: dropped until they arrive as usual')
        try:
            with self.lock:
                clamped = self.base.command(now, command.linear, command.angular, command.others, command.sender)
        except (RejectedCommand, RefusedCommand) as error:
            if isinstance(error, RejectedCommand):
                rospy.logerr_throttle(1, f'{self.topic}: {error}; rejected, base stopped')
            else:
                rospy.logwarn_throttle(5, f'{self.topic}: refused a command from {command.sender}: {error}')
            self.refusals.add(command.sender, str(error))
            return
        self.sender = command.sender
        if clamped:
            limits = ((self.gate.limits.linear, 'm/s'), (self.gate.limits.angular, 'rad/s'),
                      (self.wheel_limit, 'm/s at each wheel'))
            expected = ', '.join(f'{limit:g} {unit}' for limit, unit in limits if limit < inf)
            text = f'{command.linear:g} m/s, {command.angular:g} rad/s: expected at most {expected}'
            rospy.logwarn_throttle(5, f'{self.topic}: {text}; clamped')
            self.refusals.add(command.sender, text, refused=False)
        if any(command.others):
            rospy.logwarn_throttle(5, f'{self.topic}: linear.y, linear.z, angular.x, angular.y = {command.others}: a '
                                      'differential drive cannot follow these, expected 0; ignored')

    def log_timeout(self) -> None:
        text = f'no command for {self.gate.timeout / SECOND:g} s: stopped'
        rospy.logwarn_throttle(10, f'{self.topic}: {text}')
        self.refusals.add(self.sender, text, refused=False)

    def diagnose(self, status: DiagnosticStatusWrapper) -> None:
        """Add the values of the gate to a DiagnosticStatus."""
        gate, now = self.gate, self.clock.now()
        age = 'never' if gate.command_time is None else f'{(now - gate.command_time) / SECOND:.3f}'
        text = self.senders.recent(now, RECENT)
        messages.fill_status(status, DiagnosticStatus.WARN if text else None, f'Contradictory commands: {text}', {
            'dX': gate.linear,
            'dR': gate.angular,
            'Age of the last command (s)': age,
            'Rejected commands': gate.rejected,
            'Refused commands': self.refusals.count,
            'Clamped commands': gate.clamped,
            'Dropped commands': self.bursts.dropped,
            'Contradictory commands': self.senders.contradictions})


# Any: rospy has no types
def subscribe_joints(joints: Iterable[Joint], lock: Lock, namespace: str = '') -> list[Any]:
    """Subscribe to the goals of joints: <joint>/command, in rad. lock: held while a goal is set; namespace: see
    VelocityCommands."""
    return [rospy.Subscriber(f'{namespace}{joint.name}/command', Float64, _on_goal, (joint, lock), queue_size=10)
            for joint in joints]


def _on_goal(message: Float64, joint_and_lock: tuple[Joint, Lock]) -> None:
    joint, lock = joint_and_lock
    try:
        with lock:
            joint.command(message.data)
    except ValueError as error:
        topic = rospy.resolve_name(f'{joint.name}/command')
        rospy.logerr_throttle(1, f'{topic}: {error}; rejected')
