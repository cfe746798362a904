"""A base publishes the state of each wheel, and only what somebody receives."""
import pytest
import rospy

from rbx1_nav.base.covariances import Reading, Uncertainty
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.publisher import BasePublisher
from rbx1_nav.base.robot_parameters import read_robot
from fake_topics import Topic, replace_topics

CONTROLLER = dict(type='diff_controller', base_width=0.4, wheel_radius=0.05, left_wheel='left', right_wheel='right',
                  base_frame_id='base', odom_frame_id='world')
STAMP = rospy.Time(7)


@pytest.fixture(name='make')
def fixture_make(monkeypatch):
    """Return a function that makes a BasePublisher, and the messages that it publishes, by topic."""
    replace_topics(monkeypatch)

    def make(**params):
        sent = {}
        robot = read_robot(dict(controllers={'base': CONTROLLER}, **params))
        return BasePublisher(robot, lambda publisher, message: sent.update({publisher.name: message}),
                             namespace='/r/'), sent
    return make


def publish_all(publisher):
    publisher.publish_odometry(STAMP, Pose(1.0, 2.0, 0.0), (0.3, 0.4), Uncertainty(0.1, 0.2, 0.3, 0.4))
    publisher.publish_transform(STAMP, Pose(1.0, 2.0, 0.0))
    publisher.publish_imu(STAMP, Reading(0.1, 0.2, 0.3, 0.4))
    publisher.publish_joints(STAMP, (0.5, 0.6), (0.3, 0.4))


def test_each_wheel_has_its_own_angle_and_speed(make):
    publisher, sent = make()
    publish_all(publisher)
    message = sent['/r/joint_states']
    assert message.name == ['left', 'right'] and message.position == pytest.approx([10.0, 12.0])
    # 0.3 m/s less and plus 0.4 rad/s * 0.2 m, in rad/s of a wheel with a radius of 0.05 m
    assert message.velocity == pytest.approx([4.4, 7.6])


def test_frames_and_topics(make):
    publisher, sent = make()
    publish_all(publisher)
    assert sorted(sent) == ['/r/imu/data', '/r/joint_states', '/r/odom', '/tf']
    for message in sent['/r/odom'], sent['/tf'].transforms[0]:
        assert (message.header.frame_id, message.child_frame_id) == ('world', 'base')
    assert sent['/r/imu/data'].header.frame_id == 'base' and sent['/r/imu/data'].angular_velocity.z == 0.1


def test_what_is_not_wanted_is_not_published(make, monkeypatch):
    publisher, sent = make(publish_tf=False)
    publish_all(publisher)
    assert '/tf' not in sent and len(sent) == 3
    sent.clear()
    monkeypatch.setattr(Topic, 'connections', 0)
    publish_all(publisher)
    assert not sent
