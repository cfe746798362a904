"""Messages are converted for the filter, each value from its own field; invalid poses are rejected."""
from math import cos, inf, nan, sin

from geometry_msgs.msg import PoseWithCovarianceStamped, Vector3
from nav_msgs.msg import Odometry
import pytest
import rospy
from sensor_msgs.msg import Imu

from rbx1_nav.filter.conversions import from_imu, from_odometry, from_set_pose
from rbx1_nav.filter.imu_mounting import ImuData
from rbx1_nav.filter.input_checks import Odom, RejectedMessage

STAMP = rospy.Time(7, 250)
YAW = sin(1.5), cos(1.5)        # z and w of a rotation by 3 rad


def make(frame_id='odom_combined', **changes):
    """Return a message at (1 m, 2 m, 0.5 rad). changes: covariance elements, as c0=..., or fields of the pose."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id = frame_id
    point, rotation = message.pose.pose.position, message.pose.pose.orientation
    point.x, point.y, rotation.z, rotation.w = 1.0, 2.0, sin(0.25), cos(0.25)
    covariance = [0.0] * 36
    covariance[0], covariance[7], covariance[35] = 0.04, 0.09, 0.01
    for key, value in changes.items():
        if key[0] == 'c':
            covariance[int(key[1:])] = value
        else:
            setattr(rotation if key in 'zw' else point, key, value)
    message.pose.covariance = covariance
    return message


@pytest.mark.parametrize('frame_id', ['odom_combined', '/odom_combined', ''])
def test_pose_and_covariance(frame_id):
    pose, covariance = from_set_pose(make(frame_id, c1=0.03, c6=0.03, c5=-0.01, c30=-0.01), 'odom_combined')
    assert pose == pytest.approx((1.0, 2.0, 0.5))
    assert covariance == ((0.04, 0.03, -0.01), (0.03, 0.09, 0.0), (-0.01, 0.0, 0.01))


@pytest.mark.parametrize('message, text', [
    (make('map'), "header.frame_id: 'map': expected odom_combined, the output_frame"),
    (make(x=nan), 'pose.pose.position.x: nan: expected a number of at most 1e.06'),
    (make(y=-inf), 'pose.pose.position.y: -inf: expected a number'),
    (make(x=1e7), 'pose.pose.position.x: 10000000.0: expected a number'),
    (make(w=0.0, z=0.0), r'pose.pose.orientation: \(0, 0, 0, 0\): expected a normalized quaternion'),
    (make(c0=0.0), r'pose.covariance\[0\]: 0.0: expected a variance above 0'),
    (make(c7=nan), r'pose.covariance\[7\]: nan: expected a variance above 0'),
    (make(c35=-0.1), r'pose.covariance\[35\]: -0.1: expected a variance above 0'),
    (make(c1=0.07, c6=0.07),
     r'pose.covariance: \[\[0.04, 0.07, .*: expected a covariance: symmetric, no correlation above'),
    (make(c1=0.03), r'pose.covariance: \[\[0.04, 0.03, .*: expected a covariance: symmetric'),
    (make(c5=nan, c30=nan), 'pose.covariance: .*nan.*: expected a covariance'),
    (make(c5=inf, c30=inf), 'pose.covariance: .*inf.*: expected a covariance'),
    # each pair may have this correlation, but not all three
    (make(c1=-0.054, c6=-0.054, c5=-0.018, c30=-0.018, c11=-0.027, c31=-0.027), 'pose.covariance: .*expected a '
                                                                                'covariance')])
@pytest.mark.filterwarnings('error')
def test_a_rejected_message_is_named_by_its_field(message, text):
    with pytest.raises(RejectedMessage, match=text):
        from_set_pose(message, 'odom_combined')


@pytest.mark.parametrize('of_twist, expected', [
    ([0.5, 0.6], (0.5, 0.6)), ([0.0, 0.6], (0.1, 0.6)), ([0.5, 0.0], (0.5, 0.2)), ([1e13, -1.0], (0.0, 0.0))])
def test_odometry_for_the_filter(of_twist, expected):
    message = Odometry()
    message.header.stamp = STAMP
    point, rotation = message.pose.pose.position, message.pose.pose.orientation
    point.x, point.y, rotation.z, rotation.w = 1.0, -2.0, *YAW
    # pose.covariance: x, y and yaw; twist.covariance: x and yaw
    message.pose.covariance[::7] = [0.1, 0.3, 0.0, 0.0, 0.0, 0.2]
    message.twist.covariance[0], message.twist.covariance[35] = of_twist
    linear, angular = expected
    odom = from_odometry(message)
    assert odom.pose == pytest.approx((1.0, -2.0, 3.0))
    assert odom == Odom(stamp=7 * 10 ** 9 + 250, pose=odom.pose, linear_variance=linear, angular_variance=angular)


def test_an_imu_for_the_filter():
    message = Imu(angular_velocity=Vector3(0.1, 0.2, 0.3), angular_velocity_covariance=range(1, 10),
                  orientation_covariance=range(11, 20))
    message.header.stamp = STAMP
    message.orientation.z, message.orientation.w = YAW
    data = from_imu(message)
    assert data.orientation == pytest.approx((0.0, 0.0, *YAW))
    assert data == ImuData(stamp=7 * 10 ** 9 + 250, rates=(0.1, 0.2, 0.3), rate_variances=range(1, 10, 4),
                           orientation=data.orientation, yaw_variance=19)
    message.angular_velocity_covariance = [-1.0] + [0.0] * 8
    assert from_imu(message).rates is None and from_imu(message).orientation
    message.orientation_covariance = [-1.0] + [0.0] * 8
    assert from_imu(message).orientation is None
