"""Connects a simulated base with ROS."""
from __future__ import annotations

import threading
from typing import Any, Callable

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import DiagnosticStatusWrapper, Updater
from nav_msgs.msg import Odometry
from std_msgs.msg import Empty
from std_srvs.srv import Empty as EmptyService, EmptyRequest, EmptyResponse

from rbx1_nav.base import messages
from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.command_subscriber import VelocityCommands, subscribe_joints
from rbx1_nav.base.publisher import BasePublisher
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.rospy_connections import NoDelay
from rbx1_nav.node.tf_prefix import with_prefix
from rbx1_nav.simulation.simulated_base import make_base, speed_window
from rbx1_nav.simulation.wheels import IdealWheels


class SimulatedRobot:
    """The topics and services of a simulated base."""

    def __init__(self, robot: Robot, surface: Surface | None, seed: int, clock: Clock, refusals: Refusals,
                 name: str = '', changed_floor: Callable[[], tuple[Surface | None, int] | None] = lambda: None) -> None:
        """surface: None for the ideal floor; seed: of its errors; refusals: of this node; name: namespace of the
        robot, '' for the namespace of this node; changed_floor(): see ChosenFloor."""
        topics, private = (f'/{name}/', f'/{name}/arbotix/') if name else ('', '~')
        if robot.hardware:
            rospy.loginfo('Ignoring %d parameters that apply only to hardware', len(robot.hardware))
        if robot.unknown:
            rospy.logwarn('Ignoring unknown parameters: %s', ', '.join(robot.unknown))
        self.robot = robot
        self.changed_floor = changed_floor
        self.base = make_base(robot, surface, seed)
        self.base.now = clock.now()
        self.clock = clock
        self._name_floor(surface, seed)
        self.lock = threading.Lock()
        self.last_stamp: rospy.Time | None = None
        self.joints_time: int | None = None     # ns, of the last motion of the joints
        self.joint_schedule = Schedule(10)
        self.diagnostics_schedule = Schedule(1)

        self.publisher = BasePublisher(robot, clock.publish, self.greet, topics)
        self.truth_pub = rospy.Publisher(f'{topics}ground_truth', Odometry, NoDelay(), queue_size=10)
        self.reset_pub = rospy.Publisher(f'{topics}reset_odometry', Empty, queue_size=1)
        self.diagnostics = Updater()
        self.diagnostics.setHardwareID('none')
        namespace = self.truth_pub.resolved_name.rpartition('/')[0].lstrip('/')
        self.diagnostics.add(with_prefix(namespace, robot.name), self.diagnose)
        self.reset_service = rospy.Service(f'{private}reset', EmptyService, self.on_reset)
        self.joint_subs = subscribe_joints(robot.joints, self.lock, topics)
        self.commands = VelocityCommands(self.base, self.base.gate, clock, self.lock, topics, refusals)

    def start(self) -> None:
        """Accept commands from now on."""
        self.commands.subscribe()
        rospy.loginfo('Ready: %s is at the origin of %s', self.robot.base_frame_id, self.robot.odom_frame_id)

    def close(self) -> None:
        self.last_stamp = None      # greet no more subscribers of the common topic /tf
        self.commands.close()
        self.reset_service.shutdown()
        for each in (*self.joint_subs, *self.publisher.publishers, self.truth_pub, self.reset_pub,
                     self.diagnostics.publisher):
            each.unregister()

    def step(self) -> None:
        with self.lock:
            now, base = self.clock.now(), self.base
            stamp = self.clock.stamp(now)
            if stamp == self.last_stamp:
                return
            self.last_stamp = stamp
            timed_out = base.advance(now)
            self.commands.bursts.ran = now
            pose, velocity, uncertainty = base.odometry.pose, base.velocity, base.wheels.uncertainty
            true_pose, true_velocity = base.wheels.truth.pose, base.true_velocity
            reading, travel = base.read_gyro(), (base.left, base.right)
            joints_due = self.joint_schedule.due(now)
            if joints_due:
                # if the clock jumped back, no joint moves
                elapsed = 0 if self.joints_time is None else max(0, now - self.joints_time)
                self.joints_time = now
                for joint in self.robot.joints:
                    joint.advance(elapsed / SECOND)
        # in this order, so that a node that receives odometry finds the other messages of this time
        if joints_due:
            self.publisher.publish_joints(stamp, travel, velocity)
        self.publisher.publish_transform(stamp, pose)
        if reading:
            self.publisher.publish_imu(stamp, reading)
        if self.truth_pub.get_num_connections():
            self.clock.publish(self.truth_pub, messages.odometry(
                stamp, self.publisher.frames, true_pose, true_velocity, IdealWheels.uncertainty))
        self.publisher.publish_odometry(stamp, pose, velocity, uncertainty)
        if timed_out:
            self.commands.log_timeout()
        if self.diagnostics_schedule.due(now):
            self.diagnostics.force_update()

    def greet(self, topic: str, publish: Callable[[Any], None]) -> None:
        """Send the current state to a new subscriber of odom or tf: while a simulated clock waits for a node that is
        starting, no other message follows."""
        self.clock.greet(lambda: self.send_state(topic, publish))

    def send_state(self, topic: str, publish: Callable[[Any], None]) -> None:
        if not self.last_stamp or topic == '/tf' and not self.robot.publish_tf:
            return
        with self.lock:
            base, stamp = self.base, self.last_stamp
            pose, velocity, uncertainty = base.odometry.pose, base.velocity, base.wheels.uncertainty
        publish(self.publisher.transform(stamp, pose) if topic == '/tf' else
                messages.odometry(stamp, self.publisher.frames, pose, velocity, uncertainty))

    def _name_floor(self, surface: Surface | None, seed: int) -> None:
        rospy.loginfo('Surface: %s', f'{surface.name}; seed:={seed} repeats this run' if surface else 'ideal')
        self.floor = surface.name if surface else 'ideal', seed

    def on_reset(self, _: EmptyRequest) -> EmptyResponse:
        """Put the robot back at the origin, at rest, and on another floor if its parameters have changed."""
        try:
            floor = self.changed_floor()
        except (ConfigError, OSError, rospy.ROSException) as error:
            rospy.logerr('The floor is still %s: %s', self.floor[0], error)
            floor = None
        with self.lock:
            self.base.advance(self.clock.now())
            if floor:
                self.base.change_floor(*floor, speed_window(self.robot))
            self.base.reset()
        if floor:
            self._name_floor(*floor)
        self.reset_pub.publish()
        rospy.loginfo('Reset: %s is back at the origin of %s', self.robot.base_frame_id, self.robot.odom_frame_id)
        return EmptyResponse()

    def diagnose(self, status: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill in the DiagnosticStatus of the controller."""
        status.summary(DiagnosticStatus.OK, 'Stationary' if self.base.at_rest else 'Moving')
        self.commands.diagnose(status)
        self.clock.diagnose(status)
        return messages.fill_status(status, None, '', dict(zip(('Surface', 'Seed'), self.floor)))
