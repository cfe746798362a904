"""What the calibration scripts share: driving, the base's factors, and the question to the user."""
from __future__ import annotations

import os
import select
import sys
from typing import Callable, TypeVar

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist
import rosgraph
from rosgraph.names import is_legal_name
import rospy

from rbx1_nav.base.calibration_factors import MAX_FACTOR
from rbx1_nav.driving.odometry import PoseListener
from rbx1_nav.exercise.legs import Leg
from rbx1_nav.node.config import ConfigError, Section, YamlValue, show
from rbx1_nav.node.life import end_requested
from rbx1_nav.node.master import call
from rbx1_nav.node.parameters import custom, frame, number

Answer = TypeVar('Answer')


def check_node_name(value: YamlValue) -> str:
    """Return the value of ~base_node, the name of a node. Raises ConfigError."""
    if not (isinstance(value, str) and value and is_legal_name(value)):
        raise ConfigError(f'base_node: {show(value)}: expected the name of a node')
    return value


# parameters of both scripts
COMMON = (
    number('rate', 50, 'Hz', 'commands per second', 2, 1000),
    frame('odom_frame', 'odom', 'frame of the odometry'),
    frame('base_frame', None, 'frame of the robot', shown='base_footprint or base_link, whichever exists'),
    custom('base_node', 'turtlebot_node', 'node whose parameters are calibrated', check_node_name))


def make_publisher() -> rospy.Publisher:
    """Return the publisher of the commands. When the script is shut down, it stops the robot."""
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)

    def shutdown() -> None:
        rospy.loginfo('Stopping the robot...')
        cmd_vel.publish(Twist())
        rospy.sleep(1)
    rospy.on_shutdown(shutdown)
    return cmd_vel


def drive(leg: Leg, poses: PoseListener, cmd_vel: rospy.Publisher, rate: float) -> None:
    """Drive a leg to its goal and come to rest, in a Drive block; leg.done() and leg.last are then valid for the
    stationary robot. rate: commands per second, Hz. Raises StuckError."""
    for rest in leg.rests:
        move_cmd, r = Twist(), rospy.Rate(rate)
        speed = leg.next_speed(poses.pose())
        while speed:
            move_cmd.linear.x, move_cmd.angular.z = leg.velocity(speed)
            cmd_vel.publish(move_cmd)
            r.sleep()
            speed = leg.next_speed(poses.pose())
        cmd_vel.publish(Twist())
        rospy.sleep(rest)
    leg.next_speed(poses.pose())


class Diagnosis:
    """Keeps the latest status that a base reports for one of its parts on /diagnostics."""

    def __init__(self, base_node: str, part: str) -> None:
        """base_node: the name of a node; part: the name of a part, such as Base or Gyro."""
        self.name = f"{rospy.resolve_name(base_node).lstrip('/')}: {part}"
        self.last: DiagnosticStatus | None = None       # None before the first status
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        self.last = next((status for status in message.status if status.name == self.name), self.last)

    def value(self, key: str) -> str | None:
        """Return the last value with this key, a text; None if there is none."""
        return next((each.value for each in self.last.values if each.key == key), None) if self.last else None

    @property
    def error(self) -> str:
        """The message of the last status if it is an error, else ''."""
        return self.last.message if self.last and self.last.level == DiagnosticStatus.ERROR else ''


def factor_set(base_node: str, key: str) -> float:
    """Return the correction factor `key` from the parameters of the base node; 1 if it is not set, or the node
    is not running.

    Raises ROSException if the value is not a valid factor.
    """
    name = rospy.resolve_name(base_node)
    values = rospy.get_param(name, None)
    # a node that has ended leaves its parameters behind
    if not (isinstance(values, dict) and call(rosgraph.get_master_uri(), 'lookupNode', name)):
        rospy.logwarn('%s is not running or has no parameters: assuming 1 for %s. Set _base_node:=NAME if your base '
                      'node has another name', name, key)
        return 1.0
    if key not in values:
        return 1.0
    try:
        return Section(values, name).number(key, 1 / MAX_FACTOR, MAX_FACTOR, what='the correction factor')
    except ConfigError as error:
        raise rospy.ROSException(str(error)) from None


def ask(question: str, check: Callable[[str], Answer]) -> Answer | None:
    """Ask on the terminal until check(text) accepts the answer; return the result of check().

    check() raises ConfigError for an invalid answer. Returns None if there can be no answer: without a terminal, or at
    the end of its input. Raises ROSInterruptException as soon as shutdown is requested, which input() would not notice.
    """
    source, text = sys.stdin.fileno(), b''
    while True:
        print(question, end=' ', flush=True)
        while b'\n' not in text:
            if end_requested.is_set():
                print(flush=True)
                raise rospy.ROSInterruptException('shutdown requested')
            if not select.select([source], [], [], 0.05)[0]:
                continue
            try:
                read = os.read(source, 4096)
            except OSError:         # the terminal belongs to another session, as under roslaunch
                read = b''
            if not read:
                print(flush=True)
                return None
            text += read
        answer, _, text = text.partition(b'\n')
        try:
            return check(answer.decode(errors='replace').strip())
        except ConfigError as error:
            print(error, flush=True)
