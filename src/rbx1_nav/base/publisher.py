"""Publishes the outputs of every base: odometry and its transform, gyro readings, and joint states."""
from __future__ import annotations

from typing import Any, Callable

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage

from rbx1_nav.base import messages
from rbx1_nav.base.covariances import Reading, Uncertainty
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.units import Covariance
from rbx1_nav.node.rospy_connections import NoDelay


class BasePublisher:
    """The publishers of a base. Creating a message costs more than sending it, so none is created without a
    subscriber."""

    # Any: rospy has no types
    def __init__(self, robot: Robot, publish: Callable[[rospy.Publisher, Any], None] = rospy.Publisher.publish,
                 greet: Callable[[str, Callable[[Any], None]], None] | None = None, namespace: str = '') -> None:
        """publish(publisher, message): publishes a message; greet: of new subscribers of odom and tf, see NoDelay;
        namespace: of the topics, with a slash at the end, '' for the namespace of this node."""
        self.robot = robot
        self.frames = robot.odom_frame_id, robot.base_frame_id
        self.publish = publish
        # simulated time may produce many messages at once
        self.odom = rospy.Publisher(f'{namespace}odom', Odometry, NoDelay(greet), queue_size=100)
        self.imu = rospy.Publisher(f'{namespace}imu/data', Imu, NoDelay(), queue_size=100)
        # the broadcaster of tf2_ros does only this, and needs 5 MB more
        self.tf = rospy.Publisher('/tf', TFMessage, NoDelay(greet), queue_size=100)
        self.joint_states = rospy.Publisher(f'{namespace}joint_states', JointState, queue_size=10)
        self.publishers = self.odom, self.imu, self.tf, self.joint_states

    def publish_odometry(self, stamp: rospy.Time, pose: Pose, velocity: tuple[float, float], uncertainty: Uncertainty,
                         covariance: Covariance | None = None) -> None:
        """Publish odometry; for the arguments, see messages.odometry()."""
        if self.odom.get_num_connections():
            self.publish(self.odom, messages.odometry(stamp, self.frames, pose, velocity, uncertainty, covariance))

    def publish_transform(self, stamp: rospy.Time, pose: Pose) -> None:
        if self.robot.publish_tf and self.tf.get_num_connections():
            self.publish(self.tf, self.transform(stamp, pose))

    def transform(self, stamp: rospy.Time, pose: Pose) -> TFMessage:
        """Return the pose of the odometry as a transform."""
        return TFMessage([messages.transform(stamp, *self.frames, pose)])

    def publish_imu(self, stamp: rospy.Time, reading: Reading) -> None:
        if self.imu.get_num_connections():
            self.publish(self.imu, messages.imu(stamp, self.robot.base_frame_id, reading))

    def publish_joints(self, stamp: rospy.Time, travel: tuple[float, float], velocity: tuple[float, float]) -> None:
        """Publish the joints, and the angles of the wheels from their travel (left, right; m) and velocity (m/s,
        rad/s)."""
        if not self.joint_states.get_num_connections():
            return
        linear, angular = velocity
        difference = angular * self.robot.base_width / 2
        wheels = [(name, distance / self.robot.wheel_radius, speed / self.robot.wheel_radius) for name, distance, speed
                  in zip(self.robot.wheel_joints, travel, (linear - difference, linear + difference))]
        self.publish(self.joint_states, messages.joint_states(stamp, self.robot.joints, wheels))


def with_frames(robot: Robot, resolve: Callable[[str], str]) -> Robot:
    """Return a Robot whose frames have the names that resolve(frame) returns."""
    return robot._replace(odom_frame_id=resolve(robot.odom_frame_id), base_frame_id=resolve(robot.base_frame_id))
