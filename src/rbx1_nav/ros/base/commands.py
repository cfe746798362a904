"""The commands that a base subscribes to, on their way through its gate."""
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist
from std_msgs.msg import Float64

from rbx1_nav.control.contradiction import Senders
from rbx1_nav.control.gate import RefusedCommand, RejectedCommand
from rbx1_nav.ros import messages
from rbx1_nav.ros.network.refusals import Refusals
from rbx1_nav.units import SECOND

RECENT = SECOND * 3 // 2    # ns: a node whose last command is older than that does not drive; rests last 1 s


class VelocityCommands:
    """The subscription to cmd_vel: logs what the gate does to a command, and tells a sender that the base refuses
    it."""

    def __init__(self, base, gate, clock, lock):
        """base: has command(now, linear, angular, others, sender); gate: its CommandGate; clock: see clocks.py; lock:
        of the base."""
        self.base = base
        self.gate = gate
        self.clock = clock
        self.lock = lock
        self.topic = rospy.resolve_name('cmd_vel')
        self.senders = Senders()
        self.sender = None          # the connection header of the last command
        self.subscriber = None
        self.refusals = Refusals()
        clock.set_driver(self.apply, self.connections)

    def subscribe(self):
        """Accept commands from now on."""
        if not self.subscriber:
            self.subscriber = rospy.Subscriber('cmd_vel', Twist, self.on_twist, queue_size=None, tcp_nodelay=True)

    def connections(self):
        """rospy's present connections to publishers of cmd_vel."""
        return self.subscriber.impl.connections if self.subscriber else []

    def on_twist(self, twist):
        """A command arrives: the clock decides when it is put in force."""
        self.sender = header = twist._connection_header
        command = messages.from_twist(twist)
        text = self.senders.contradiction(self.clock.now(), header, header['callerid'], command[:2],
                                          lambda: [connection.header for connection in self.connections()])
        if text:
            rospy.logwarn_throttle(5, '%s: %s: expected one node that drives' % (self.topic, text))
        self.clock.command(twist, command + (header['callerid'],))

    def apply(self, command):
        """Put a command in force: (linear in m/s, angular in rad/s, the velocities that the base cannot follow, the
        name of its sender)."""
        sender = command[3]
        try:
            with self.lock:
                clamped = self.base.command(self.clock.now(), *command)
        except RejectedCommand as error:
            rospy.logerr_throttle(1, '%s: %s; rejected, and the base stopped' % (self.topic, error))
            self.refusals.add(sender, str(error))
            return
        except RefusedCommand as error:
            rospy.logwarn_throttle(5, '%s: refused a command of %s: %s' % (self.topic, sender, error))
            self.refusals.add(sender, str(error))
            return
        if clamped:
            rospy.logwarn_throttle(5, '%s: %g m/s, %g rad/s: expected at most %g and %g; clamped'
                                   % ((self.topic,) + command[:2] + self.gate.limits))
        if any(command[2]):
            rospy.logwarn_throttle(5, '%s: linear.y, linear.z, angular.x, angular.y = %s: a differential drive cannot '
                                      'follow these, expected 0; ignored' % (self.topic, command[2]))

    def driver(self):
        """The name of the node that drives the base now, also while it rests between two motions; None if none does."""
        last = self.gate.command_time
        if last is None or self.clock.now() - last > RECENT:
            return None
        return next((connection.header['callerid'] for connection in self.connections()
                     if connection.header is self.sender), None)

    def log_timeout(self):
        """Log that the command in force timed out."""
        rospy.logwarn_throttle(10, '%s: no command for %g s: stopped' % (self.topic, self.gate.timeout / SECOND))

    def diagnose(self, status):
        """Add the gate's values to a DiagnosticStatus."""
        gate, now = self.gate, self.clock.now()
        age = 'never' if gate.command_time is None else '%.3f' % ((now - gate.command_time) / SECOND)
        text = self.senders.recent(now, RECENT)
        if text:
            status.summary(DiagnosticStatus.WARN, 'Contradictory commands: ' + text)
        status.add('dX', gate.linear)
        status.add('dR', gate.angular)
        status.add('Age of the last command (s)', age)
        status.add('Rejected commands', gate.rejected)
        status.add('Refused commands', self.refusals.count)
        status.add('Clamped commands', gate.clamped)
        status.add('Contradictory commands', self.senders.contradictions)


def subscribe_joints(joints, lock):
    """Subscribe to the goals of Joint objects: <joint>/command, in rad. lock: held while a goal is set."""
    for joint in joints:
        rospy.Subscriber(joint.name + '/command', Float64, _on_goal, (joint, lock), queue_size=10)


def _on_goal(message, joint_and_lock):
    joint, lock = joint_and_lock
    try:
        with lock:
            joint.command(message.data)
    except ValueError as error:
        rospy.logerr_throttle(1, '%s: %s; rejected' % (rospy.resolve_name(joint.name + '/command'), error))
