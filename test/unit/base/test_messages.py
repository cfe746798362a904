"""Each value of a message is converted to its own field: no two values of these messages are equal."""
from math import atan2, cos, isnan, pi, sin

import numpy
import pytest
import rospy

from rbx1_nav.base import messages
from rbx1_nav.base.covariances import Reading, Uncertainty
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.messages import UNKNOWN
from rbx1_nav.base.robot_parameters import Joint

STAMP = rospy.Time(7, 250)
POSE = Pose(1.0, -2.0, 3.0 + 4 * pi)    # rotated by 3 rad, after two turns
YAW = sin(1.5), cos(1.5)                # z and w of this rotation
COVARIANCE = numpy.array([[0.04, 0.01, 0.02], [0.01, 0.09, 0.03], [0.02, 0.03, 0.16]])


def xyz(vector):
    return vector.x, vector.y, vector.z


def is_at_pose(point, rotation):
    """Whether a message has the point and the quaternion of POSE."""
    return xyz(point) == (1.0, -2.0, 0.0) and (rotation.x, rotation.y, rotation.z, rotation.w) == pytest.approx(
        (0.0, 0.0, *YAW))


def elements(covariance):
    """The elements of a 6x6 covariance that are not 0, by their row and column."""
    return {divmod(index, 6): value for index, value in enumerate(covariance) if value}


def test_odometry():
    uncertainty = Uncertainty(position=0.1, yaw=0.2, linear=0.3, angular=0.4)
    message = messages.odometry(STAMP, ('odom', 'base_link'), POSE, (0.5, -0.6), uncertainty)
    assert (message.header.stamp, message.header.frame_id, message.child_frame_id) == (STAMP, 'odom', 'base_link')
    assert is_at_pose(message.pose.pose.position, message.pose.pose.orientation)
    assert (xyz(message.twist.twist.linear), xyz(message.twist.twist.angular)) == ((0.5, 0.0, 0.0), (0.0, 0.0, -0.6))
    others = {(2, 2): UNKNOWN, (3, 3): UNKNOWN, (4, 4): UNKNOWN}
    assert elements(message.pose.covariance) == {(0, 0): 0.1, (1, 1): 0.1, (5, 5): 0.2, **others}
    assert elements(message.twist.covariance) == {(0, 0): 0.3, (1, 1): messages.MEASURED, (5, 5): 0.4, **others}
    both = {(0, 0): 0.04, (0, 1): 0.01, (0, 5): 0.02, (1, 0): 0.01, (1, 1): 0.09, (1, 5): 0.03,
            (5, 0): 0.02, (5, 1): 0.03, (5, 5): 0.16, **others}
    message = messages.odometry(STAMP, ('odom', 'base_link'), POSE, (0.5, -0.6), uncertainty, COVARIANCE)
    assert elements(message.pose.covariance) == both
    message = messages.planar_pose(STAMP, 'map', POSE, COVARIANCE)
    assert (message.header.stamp, message.header.frame_id) == (STAMP, 'map')
    assert is_at_pose(message.pose.pose.position, message.pose.pose.orientation)
    assert elements(message.pose.covariance) == both


def test_a_reading_of_the_gyro():
    message = messages.imu(STAMP, 'gyro', Reading(rate=0.1, rate_variance=0.2, yaw=POSE.yaw, yaw_variance=0.4))
    assert (message.header.stamp, message.header.frame_id) == (STAMP, 'gyro')
    assert (message.orientation.z, message.orientation.w) == pytest.approx(YAW)
    assert xyz(message.angular_velocity) == (0.0, 0.0, 0.1)
    assert message.angular_velocity_covariance == [UNKNOWN, 0, 0, 0, UNKNOWN, 0, 0, 0, 0.2]
    assert message.orientation_covariance == [UNKNOWN, 0, 0, 0, UNKNOWN, 0, 0, 0, 0.4]
    assert message.linear_acceleration_covariance[0] == -1


def test_a_transform():
    message = messages.transform(STAMP, 'odom', 'base_link', POSE)
    assert (message.header.stamp, message.header.frame_id, message.child_frame_id) == (STAMP, 'odom', 'base_link')
    assert is_at_pose(message.transform.translation, message.transform.rotation)


def test_joints_and_wheels():
    arm = Joint('arm', -2.0, 2.0, 0.5)
    arm.command(1.0)
    arm.advance(0.5)
    message = messages.joint_states(STAMP, [arm], [('left', 3.0, 4.0), ('right', 5.0, 6.0)])
    assert message.header.stamp == STAMP
    assert list(zip(message.name, message.position, message.velocity)) == [
        ('arm', 0.25, 0.5), ('left', 3.0, 4.0), ('right', 5.0, 6.0)]


@pytest.mark.parametrize('yaw, heading', [(-1e-9, -1e-9), (-3.0, -3.0), (4.0, 4.0 - 2 * pi), (-4.0, 2 * pi - 4.0)])
def test_the_usual_formula_for_the_heading_gives_no_extra_turn(yaw, heading):
    rotation = messages.transform(STAMP, 'odom', 'base_link', POSE._replace(yaw=yaw)).transform.rotation
    assert 2 * atan2(rotation.z, rotation.w) == pytest.approx(heading)


def test_the_yaw_of_a_robot_on_a_slope():
    """A quaternion with roll, pitch and yaw, not quite of length 1."""
    roll, pitch, yaw, scale = 0.1, -0.2, 2.0, 1.01
    (a, b), (c, d), (e, f) = ((sin(angle / 2), cos(angle / 2)) for angle in (roll, pitch, yaw))
    rotation = messages.Quaternion(a * d * f - b * c * e, b * c * f + a * d * e, b * d * e - a * c * f,
                                   b * d * f + a * c * e)      # roll, then pitch, then yaw, about fixed axes
    for name in 'xyzw':
        setattr(rotation, name, scale * getattr(rotation, name))
    assert messages.yaw_of(rotation) == pytest.approx(yaw)
    # of another length
    for wrong in messages.Quaternion(0, 0, 0.8, 0.5), messages.Quaternion(0, 0, 0.8, 0.7), messages.Quaternion(w=1e308):
        assert isnan(messages.yaw_of(wrong)) and messages.unit_quaternion(wrong) is None
    x, y, z, w = messages.unit_quaternion(rotation)
    assert x * x + y * y + z * z + w * w == pytest.approx(1)
    assert atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) == pytest.approx(yaw)
