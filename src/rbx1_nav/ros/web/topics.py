"""The subscriptions of the web view, and its command publisher. The load from each topic is bounded."""
from __future__ import annotations

from collections import deque
import time
from typing import Any, Callable

from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
import rospy
from std_msgs.msg import Empty

from rbx1_nav.ros import messages
from rbx1_nav.ros.web.state import BY_HAND, Motion, State

TOPICS = {'truth': 'ground_truth', 'odometry': 'odom', 'estimate': 'odom_ekf'}
PERIOD = 0.02       # s: only the latest of the messages that arrive in this time is read
COMMANDS = 'cmd_vel'     # rospy.resolve_name() applies the namespace and a remapping
COMMAND_PERIOD = 0.01   # s; short, because a driving script detects a subscriber that does not read
LOG_PERIOD = 0.02   # s
BUFFER = 2 ** 20    # bytes: more than arrives in PERIOD at 50 times real time


class Topics:
    """The subscriptions."""

    def __init__(self, state: State, on_seed: Callable[[str, str], None], namespace: str = '') -> None:
        """on_seed(surface, seed): called with the values that a simulated base publishes in /diagnostics; namespace: of
        the robot, with a slash at the end, '' for that of this node."""
        self.state = state
        self.namespace = namespace or rospy.get_namespace()
        self.on_seed = on_seed
        self.base: str | None = None    # the node that publishes the odometry
        self.connections: deque[object] = deque(maxlen=10)  # the latest ones to publishers of odometry
        self.truth: str | None = None   # the node that publishes the ground truth
        self.subscribers = [
            *(subscribe(f'{namespace}{topic}', Odometry, self.on_odometry, source) for source, topic in TOPICS.items()),
            subscribe(f'{namespace}{COMMANDS}', Twist, self.on_command),
            subscribe(f'{namespace}reset_odometry', Empty, self.on_reset),
            subscribe('/diagnostics', DiagnosticArray, self.on_diagnostics, queue_size=5),
            # the log of all nodes, over one connection to rosout instead of one to each node
            subscribe('/rosout_agg', Log, self.on_log, queue_size=50)]

    def on_odometry(self, message: Odometry, source: str) -> None:
        """Process a pose and a velocity."""
        pose, twist = message.pose.pose, message.twist.twist
        sender = message._connection_header['callerid']
        if source == 'odometry':
            self.base = sender
            connection = message._connection_header     # one object per connection
            if all(connection is not each for each in self.connections):
                self.connections.append(connection)
                self.state.connected()
        elif source == 'truth':
            self.truth = sender
        self.state.move(source, Motion(
            message.header.stamp.to_sec(), (pose.position.x, pose.position.y, messages.yaw_of(pose.orientation)),
            twist.linear.x, twist.angular.z), time.monotonic())
        time.sleep(PERIOD)

    def on_command(self, twist: Twist) -> None:
        """Process a command to the base."""
        sender = twist._connection_header['callerid']
        self.state.command(twist.linear.x, twist.angular.z, BY_HAND if sender == rospy.get_name() else sender,
                           time.monotonic())
        time.sleep(COMMAND_PERIOD)

    def on_reset(self, _: Empty) -> None:
        """Process a reset of the base."""
        self.state.reset(time.monotonic())

    def on_diagnostics(self, array: DiagnosticArray) -> None:
        """Process the diagnostics of a base, which arrive once per second."""
        for status in array.status:
            if f"/{status.name.rpartition('/')[0]}".rstrip('/') != self.namespace.rstrip('/'):
                continue        # it belongs to another robot
            values = {each.key: each.value for each in status.values}
            if 'Surface' in values and 'Seed' in values:
                self.on_seed(values['Surface'], values['Seed'])
        time.sleep(PERIOD)

    def on_log(self, line: Log) -> None:
        """Process a log message."""
        if line.level >= Log.INFO:
            self.state.log_line(line.level, line.header.stamp.to_sec(), line.name, line.msg)
        time.sleep(LOG_PERIOD)


def subscribe(topic: str, kind: type, callback: Callable[..., None], args: Any = None,
              queue_size: int = 1) -> rospy.Subscriber:
    """Subscribe to a topic. The callbacks may sleep: rospy has one thread for each connection, and drops messages
    that are not read in time, so neither other topics nor the publishers are delayed."""
    return rospy.Subscriber(topic, kind, callback, args, queue_size=queue_size, buff_size=BUFFER, tcp_nodelay=True)


class CommandPublisher:
    """Publishes /cmd_vel. It stays registered, because a subscriber of rospy that connects while a publisher
    unregisters may keep a dead connection to it."""

    def __init__(self, namespace: str = '') -> None:
        """namespace: see Topics."""
        self.publisher = rospy.Publisher(f'{namespace}{COMMANDS}', Twist, queue_size=5, tcp_nodelay=True)

    def publish(self, linear: float, angular: float) -> None:
        """Send a command, m/s and rad/s."""
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        try:
            self.publisher.publish(command)
        except rospy.ROSException:
            pass    # closed by the shutdown of the node, which sends its own stop

    def connected(self) -> set[str]:
        """Return the names of the nodes that receive the commands."""
        return {connection.endpoint_id for connection in self.publisher.impl.connections}
