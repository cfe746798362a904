"""Conversions between the types of the core and ROS messages."""
from __future__ import annotations

from math import atan2, cos, isnan, nan, pi, remainder, sin, sqrt
from typing import Any, Mapping, Sequence

from geometry_msgs.msg import Pose as PoseMessage, PoseWithCovarianceStamped, Quaternion, TransformStamped
from nav_msgs.msg import Odometry
import rospy
from sensor_msgs.msg import Imu, JointState

from rbx1_nav.base.covariances import MEASURED, Reading, Uncertainty
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.robot_parameters import Joint
from rbx1_nav.base.units import Covariance

UNKNOWN = 1e6       # variance of a quantity that is not measured, as in diff_drive_controller and robot_pose_ekf


def diagonal(*variances: float) -> list[float]:
    """Return a 6x6 covariance, row by row, from the variances of x, y, z, roll, pitch and yaw."""
    matrix = [0.0] * 36
    matrix[::7] = variances
    return matrix


def squared_norm(rotation: Quaternion) -> float:
    """Return the squared length of a Quaternion; nan if it is not normalized."""
    # not `** 2`, which raises an OverflowError for huge numbers
    norm = sum(value * value for value in (rotation.x, rotation.y, rotation.z, rotation.w))
    return norm if 0.9 < norm < 1.1 else nan


def unit_quaternion(rotation: Quaternion) -> tuple[float, float, float, float] | None:
    """Return (x, y, z, w) of a Quaternion, scaled to length 1; None if it is not normalized."""
    length = sqrt(squared_norm(rotation))
    if isnan(length):
        return None
    return rotation.x / length, rotation.y / length, rotation.z / length, rotation.w / length


def yaw_of(rotation: Quaternion) -> float:
    """Return the yaw (rad) of a Quaternion; nan if it is not normalized."""
    norm = squared_norm(rotation)
    if isnan(norm):
        return nan
    return atan2(2 * (rotation.w * rotation.z + rotation.x * rotation.y),
                 norm - 2 * (rotation.y ** 2 + rotation.z ** 2))


def quaternion(yaw: float) -> Quaternion:
    """Return the Quaternion of a rotation by yaw (rad) about z. Its w is not negative, so that 2 * atan2(z, w) is an
    angle between -pi and pi."""
    half = remainder(yaw, 2 * pi) / 2
    return Quaternion(0.0, 0.0, sin(half), cos(half))


def planar(covariance: Covariance) -> list[float]:
    """Return a 6x6 covariance, row by row, from the 3x3 covariance of x, y (m) and yaw (rad)."""
    matrix = diagonal(0.0, 0.0, UNKNOWN, UNKNOWN, UNKNOWN, 0.0)
    for row, values in zip((0, 1, 5), covariance):
        for column, value in zip((0, 1, 5), values):
            matrix[6 * row + column] = value
    return matrix


# Any: a message with a header
def _stamped(message: Any, stamp: rospy.Time, frame_id: str, child_frame_id: str | None = None) -> Any:
    """Return a message after filling in its header, and its child frame."""
    message.header.stamp, message.header.frame_id = stamp, frame_id
    if child_frame_id is not None:
        message.child_frame_id = child_frame_id
    return message


def _set_pose(message: PoseMessage, pose: Pose) -> None:
    message.position.x, message.position.y = pose.x, pose.y
    message.orientation = quaternion(pose.yaw)


def odometry(stamp: rospy.Time, frames: tuple[str, str], pose: Pose, velocity: tuple[float, float],
             uncertainty: Uncertainty, covariance: Covariance | None = None) -> Odometry:
    """Return an Odometry message: Pose in the first of the frames, velocity (m/s, rad/s) in the second,
    Uncertainty.

    covariance: the 3x3 covariance of the pose; it replaces the pose variances of the Uncertainty.
    """
    message = _stamped(Odometry(), stamp, *frames)
    _set_pose(message.pose.pose, pose)
    position = uncertainty.position
    message.pose.covariance = (planar(covariance) if covariance is not None else
                               diagonal(position, position, UNKNOWN, UNKNOWN, UNKNOWN, uncertainty.yaw))
    message.twist.twist.linear.x, message.twist.twist.angular.z = velocity
    # wheels do not roll sideways, so the lateral speed is known
    message.twist.covariance = diagonal(
        uncertainty.linear, MEASURED, UNKNOWN, UNKNOWN, UNKNOWN, uncertainty.angular)
    return message


def imu(stamp: rospy.Time, frame_id: str, reading: Reading) -> Imu:
    """Return an Imu message with the Reading of a gyro, which measures only the vertical axis."""
    message = _stamped(Imu(), stamp, frame_id)
    message.orientation = quaternion(reading.yaw)
    message.orientation_covariance = [UNKNOWN, 0, 0, 0, UNKNOWN, 0, 0, 0, reading.yaw_variance]
    message.angular_velocity.z = reading.rate
    message.angular_velocity_covariance = [UNKNOWN, 0, 0, 0, UNKNOWN, 0, 0, 0, reading.rate_variance]
    message.linear_acceleration_covariance[0] = -1      # means not measured, by the definition of the message
    return message


def transform(stamp: rospy.Time, frame_id: str, child_frame_id: str, pose: Pose) -> TransformStamped:
    """Return a TransformStamped with the Pose of the child frame."""
    message = _stamped(TransformStamped(), stamp, frame_id, child_frame_id)
    message.transform.translation.x, message.transform.translation.y = pose.x, pose.y
    message.transform.rotation = quaternion(pose.yaw)
    return message


def joint_states(stamp: rospy.Time, joints: Sequence[Joint], wheels: Sequence[tuple[str, float, float]]) -> JointState:
    """Return a JointState. joints: Joint objects; wheels: (name, angle in rad, speed in rad/s) of each wheel."""
    message = JointState()
    message.header.stamp = stamp
    message.name = [joint.name for joint in joints] + [name for name, _, _ in wheels]
    message.position = [joint.position for joint in joints] + [angle for _, angle, _ in wheels]
    message.velocity = [joint.velocity for joint in joints] + [speed for _, _, speed in wheels]
    return message


def planar_pose(stamp: rospy.Time, frame_id: str, pose: Pose, covariance: Covariance) -> PoseWithCovarianceStamped:
    """Return a PoseWithCovarianceStamped with a Pose and the 3x3 covariance of x, y (m) and yaw (rad)."""
    message = _stamped(PoseWithCovarianceStamped(), stamp, frame_id)
    _set_pose(message.pose.pose, pose)
    message.pose.covariance = planar(covariance)
    return message


# Any: a DiagnosticStatusWrapper
def fill_status(status: Any, level: int | None, text: str, values: Mapping[str, object]) -> Any:
    """Return a DiagnosticStatus after setting its level and text, and adding values. level: None keeps both."""
    if level is not None:
        status.summary(level, text)
    for key, value in values.items():
        status.add(key, value)
    return status
