"""To and from ROS messages. The only module that knows both what a base is and what a message is."""
from math import cos, pi, sin

from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState

MEASURED = 1e-6     # variance in m^2 or rad^2 (and their squares per second): a millimetre, a milliradian
UNKNOWN = 1e6       # variance of what wheels cannot measure, as diff_drive_controller and robot_pose_ekf have it


def diagonal(*variances):
    """A 6x6 covariance, row by row, from the variances of x, y, z, roll, pitch and yaw."""
    matrix = [0.0] * 36
    matrix[::7] = variances
    return matrix


POSE_COVARIANCE = diagonal(MEASURED, MEASURED, UNKNOWN, UNKNOWN, UNKNOWN, MEASURED)
# a wheel does not roll sideways, so the lateral speed is known
TWIST_COVARIANCE = diagonal(MEASURED, MEASURED, UNKNOWN, UNKNOWN, UNKNOWN, MEASURED)


def from_twist(twist):
    """(linear, angular, others) of a Twist: m/s forward, rad/s to the left, and the four that a differential drive
    cannot follow."""
    return (twist.linear.x, twist.angular.z,
            (twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y))


def quaternion(yaw):
    """The rotation by yaw (rad) about z."""
    return Quaternion(0.0, 0.0, sin(yaw / 2), cos(yaw / 2))


def odometry(stamp, config, pose, linear, angular):
    """An Odometry message: the pose in the odom frame, the velocity (m/s, rad/s) in the base frame."""
    message = Odometry()
    message.header.stamp = stamp
    message.header.frame_id = config.odom_frame_id
    message.child_frame_id = config.base_frame_id
    message.pose.pose.position.x = pose.x
    message.pose.pose.position.y = pose.y
    message.pose.pose.orientation = quaternion(pose.yaw % (2 * pi))
    message.pose.covariance = POSE_COVARIANCE
    message.twist.twist.linear.x = linear
    message.twist.twist.angular.z = angular
    message.twist.covariance = TWIST_COVARIANCE
    return message


def transform(odom):
    """The TransformStamped that says the same as an Odometry message."""
    message = TransformStamped()
    message.header = odom.header
    message.child_frame_id = odom.child_frame_id
    message.transform.translation.x = odom.pose.pose.position.x
    message.transform.translation.y = odom.pose.pose.position.y
    message.transform.rotation = odom.pose.pose.orientation
    return message


def joint_states(stamp, joints, wheels):
    """A JointState. joints: Joint objects; wheels: (name, angle in rad, speed in rad/s) for each."""
    message = JointState()
    message.header.stamp = stamp
    message.name = [joint.name for joint in joints] + [name for name, _, _ in wheels]
    message.position = [joint.position for joint in joints] + [angle for _, angle, _ in wheels]
    message.velocity = [joint.velocity for joint in joints] + [speed for _, _, speed in wheels]
    return message
