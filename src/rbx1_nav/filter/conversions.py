"""Conversions of the messages that the filter receives."""
from __future__ import annotations

from math import isfinite, isnan, sqrt
from types import SimpleNamespace

from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.messages import unit_quaternion, yaw_of
from rbx1_nav.base.units import Covariance
from rbx1_nav.filter.imu_mounting import ImuData
from rbx1_nav.filter.input_checks import MAX_VARIANCE, Odom, check, check_number, check_variance
from rbx1_nav.node.config import show

ROUNDING = 1e-6     # tolerance for rounding errors of a received correlation


def from_odometry(message: Odometry) -> Odom:
    """Return the Odom of an Odometry message, for the filter. Without variances of the speeds, the variances of the
    pose are used for one second's travel, as in robot_pose_ekf."""
    pose, twist = message.pose, message.twist
    linear, angular = (twist.covariance[index] or pose.covariance[index] for index in (0, 35))
    return Odom(message.header.stamp.to_nsec(),
                Pose(pose.pose.position.x, pose.pose.position.y, yaw_of(pose.pose.orientation)),
                *(value if 0 < value < MAX_VARIANCE else 0.0 for value in (linear, angular)))


def from_imu(message: Imu) -> ImuData:
    """Return the ImuData of an Imu message. By its definition, a first variance of -1 means not measured."""
    rate = message.angular_velocity
    has_rates, has_orientation = (covariance[0] != -1 for covariance in (
        message.angular_velocity_covariance, message.orientation_covariance))
    return ImuData(message.header.stamp.to_nsec(), (rate.x, rate.y, rate.z) if has_rates else None,
                   message.angular_velocity_covariance[::4],
                   unit_quaternion(message.orientation) if has_orientation else None,
                   message.orientation_covariance[8])


def from_set_pose(message: PoseWithCovarianceStamped, output_frame: str) -> tuple[Pose, Covariance]:
    """Return (Pose, 3x3 covariance of x, y and yaw) of a message on set_pose. Raises RejectedMessage.

    output_frame: the required frame of the pose; an empty frame_id stands for this frame.
    """
    frame = message.header.frame_id.lstrip('/')
    check('header.frame_id', show(frame), frame in ('', output_frame), f'{output_frame}, the output_frame')
    point = message.pose.pose.position
    orientation = message.pose.pose.orientation
    pose = Pose(point.x, point.y, yaw_of(orientation))
    check('pose.pose.orientation', f'({orientation.x:g}, {orientation.y:g}, {orientation.z:g}, {orientation.w:g})',
          not isnan(pose.yaw), 'a normalized quaternion (x, y, z, w)')
    for field, value in zip(('position.x', 'position.y'), pose):
        check_number(f'pose.pose.{field}', value)
    rows = [[message.pose.covariance[6 * row + column] for column in (0, 1, 5)] for row in (0, 1, 5)]
    for index, value in zip((0, 7, 35), (rows[0][0], rows[1][1], rows[2][2])):
        check_variance(f'pose.covariance[{index}]', value)
    # correlations
    a, b, c = (rows[i][j] / sqrt(rows[i][i] * rows[j][j]) for i, j in ((0, 1), (0, 2), (1, 2)))
    differences = (rows[i][j] / sqrt(rows[i][i] * rows[j][j]) - value
                   for (i, j), value in zip(((1, 0), (2, 0), (2, 1)), (a, b, c)))
    # positive semidefinite: no negative principal minor
    good = (all(isfinite(value) for row in rows for value in row)
            and all(abs(each) < ROUNDING for each in differences)
            and min(1 - a * a, 1 - b * b, 1 - c * c, 1 + 2 * a * b * c - a * a - b * b - c * c) > -ROUNDING)
    check('pose.covariance', show(rows), good, 'a covariance: symmetric, no correlation above 1')
    xx, xy, x_yaw, yy, y_yaw, yaw = ((rows[i][j] + rows[j][i]) / 2
                                     for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)))
    return pose, ((xx, xy, x_yaw), (xy, yy, y_yaw), (x_yaw, y_yaw, yaw))


def frames_of(message: Odometry, parameters: SimpleNamespace) -> tuple[str, str]:
    """Return the frames of an Odometry message and of the robot, without leading slashes. Raises RejectedMessage.

    parameters: see read_parameters(). The frame of the robot must differ from output_frame.
    """
    base_frame = parameters.base_footprint_frame or message.child_frame_id.lstrip('/') or (
        parameters.default_base_frame)
    frames = message.header.frame_id.lstrip('/'), base_frame
    for field, name in zip(('header.frame_id', 'child_frame_id'), frames):
        check(field, show(name), name, 'the name of a frame')
    check('child_frame_id', show(frames[1]), frames[1] != parameters.output_frame, 'a frame other than output_frame')
    return frames
