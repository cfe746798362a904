"""The rate of the robot is found in the readings of an IMU with any mounting, through transforms in both directions."""
from math import cos, pi, sin

from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
import pytest
import rospy
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage

from rbx1_nav.filter import imu_input
from rbx1_nav.filter.imu_input import FrameTree, ImuInput
from rbx1_nav.filter.input_checks import RejectedMessage

S, C = sin(pi / 4), cos(pi / 4)     # for rotations by 90 degrees
ROLLED, PITCHED, YAWED = Quaternion(S, 0.0, 0.0, C), Quaternion(0.0, S, 0.0, C), Quaternion(0.0, 0.0, S, C)


def make_tree(*transforms, node='/robot_state_publisher'):
    """A FrameTree that has heard (parent, child, rotation of the child in its parent)."""
    tree = FrameTree()
    for parent, child, rotation in transforms:
        transform = TransformStamped(child_frame_id=child)
        transform.header.frame_id, transform.transform.rotation = parent, rotation
        message = TFMessage([transform])
        message._connection_header = {'callerid': node}
        tree._on_transforms(message)
    return tree


def make_message():
    message = Imu(angular_velocity=Vector3(0.1, 0.2, 0.3), orientation_covariance=[-1.0] + [0.0] * 8,
                  angular_velocity_covariance=[0.01, 0, 0, 0, 0.04, 0, 0, 0, 0.09])
    message.header.frame_id = 'imu'
    return message


# an axis of the IMU that points up measures the rate; one that points down measures its negative
@pytest.mark.parametrize('transforms, rate, variance', [
    ([('base', 'imu', ROLLED)], 0.2, 0.04), ([('/base', '/imu', PITCHED)], -0.1, 0.01),
    ([('base', 'imu', YAWED)], 0.3, 0.09),
    ([('base', 'mount', ROLLED), ('mount', 'imu', YAWED)], 0.1, 0.01),
    ([('mount', 'imu', ROLLED), ('base', 'mount', YAWED)], 0.2, 0.04),
    ([('imu', 'base', ROLLED)], -0.2, 0.04), ([('imu', 'base', PITCHED)], 0.1, 0.01),
    ([('chassis', 'base', PITCHED), ('chassis', 'imu', ROLLED)], 0.1, 0.01)])
def test_an_imu_turned_by_90_degrees(transforms, rate, variance):
    heard, log = [], []
    imu = ImuInput('imu_data', make_tree(*transforms), log.append)
    imu.read(make_message(), 'base', heard.append)
    assert (heard[0].rate, heard[0].variance) == pytest.approx((rate, variance)) and imu.settled
    assert log[0].endswith(f'vertical axis tilted by {0 if rate == 0.3 else 90} degrees')


def test_readings_wait_for_the_transform_and_are_rejected_after_a_second(monkeypatch):
    now, heard = [50.0], []
    monkeypatch.setattr(imu_input.time, 'monotonic', lambda: now[0])
    # without the node's own transforms
    imu = ImuInput('imu_data', make_tree(('base', 'imu', ROLLED), node=rospy.get_name()), lambda _: None)
    for now[0] in 50.0, 50.99:
        imu.read(make_message(), 'base', heard.append)
    now[0] = 51.01
    with pytest.raises(RejectedMessage, match="header.frame_id: 'imu': expected a transform from base to it"):
        imu.read(make_message(), 'base', heard.append)
    assert not heard and not imu.settled


def test_the_parent_and_the_publisher_of_a_frame():
    tree = make_tree(('odom', 'base', YAWED), ('base', 'imu', ROLLED))
    assert tree.publisher('base') == ('odom', '/robot_state_publisher') and tree.publisher('odom') is None
    tree.forget('base')
    assert tree.publisher('base') is None and tree.publisher('imu') and tree.rotation('odom', 'imu') is None


def test_a_loop_of_frames_has_an_end():
    tree = make_tree(('a', 'b', YAWED), ('b', 'a', ROLLED), ('a', 'c', PITCHED))
    assert tree.rotation('a', 'c') == (0.0, S, 0.0, C) and tree.rotation('a', 'elsewhere') is None
