"""The estimate is published as a pose and as a transform to the frame that has no other parent."""
from math import pi
from types import SimpleNamespace

import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.messages import diagonal
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter import estimate_publisher as module
from rbx1_nav.filter.combined_odometry import Estimate
from rbx1_nav.filter.estimate_publisher import EstimatePublisher
from rbx1_nav.filter.imu_input import FrameTree
from rbx1_nav.filter.input_checks import Odom
from rbx1_nav.filter.velocity import Velocity
from fake_topics import replace_topics

COVARIANCE = (0.01, 0.0, 0.0), (0.0, 0.04, 0.0), (0.0, 0.0, 0.09)


@pytest.fixture(name='world')
def fixture_world(monkeypatch):
    """A function that makes an EstimatePublisher; world.seconds: wall time."""
    replace_topics(monkeypatch)
    monkeypatch.setattr(module.time, 'monotonic', lambda: make.seconds)

    def make(output_frame='combined', publish_tf=True, freq=10.0):
        make.log = []
        parameters = SimpleNamespace(output_frame=output_frame, publish_tf=publish_tf, freq=freq)
        return EstimatePublisher(parameters, FrameTree(), make.log.append)
    make.seconds = 100.0
    return make


def update(publisher, seconds, pose=Pose(1.0, 2.0, pi / 2), odom=Pose(3.0, 0.0, 0.0), velocity=None):
    """Publish an Estimate at a time, s; return the last transform, as (parent, child, x, y)."""
    stamp = round(seconds * SECOND)
    estimate = Estimate(stamp=stamp, pose=pose, covariance=COVARIANCE, odom=Odom(stamp, odom))
    publisher.update(SimpleNamespace(estimate=estimate, velocity=velocity), 'odom', 'base')
    if not publisher.tf_pub.sent:
        return None
    transform, = publisher.tf_pub.sent[-1]
    place = transform.transform.translation
    return transform.header.frame_id, transform.child_frame_id, place.x, place.y


def test_the_transform_is_to_the_robot_if_nobody_else_publishes_one(world):
    publisher = world()
    assert update(publisher, 10.0) is None
    world.seconds += 1.1
    assert update(publisher, 11.9) is None      # less than 2 s of ROS time
    world.seconds -= 0.2
    assert update(publisher, 12.1) is None      # less than 1 s of wall time
    world.seconds += 0.2
    assert update(publisher, 12.2) == ('combined', 'base', 1.0, 2.0) and not publisher.settled
    # later, another node does
    publisher.tree.frames['base'] = 'odom', '/base_node', (0.0, 0.0, 0.0, 1.0)
    assert update(publisher, 12.3)[:2] == ('combined', 'odom') and publisher.settled
    assert world.log == ['Publishing the transform combined -> base (no other node publishes a transform to base)',
                         'Publishing the transform combined -> odom (/base_node already publishes odom -> base)']


def test_the_transform_to_the_odometry_frame_places_the_robot_at_the_estimate(world):
    publisher = world()
    publisher.tree.frames['base'] = 'odom', '/base_node', (0.0, 0.0, 0.0, 1.0)
    assert update(publisher, 9.9) is None       # the frames are new: other nodes' transforms are read again
    publisher.tree.frames['base'] = 'odom', '/base_node', (0.0, 0.0, 0.0, 1.0)
    # in its odometry frame, the robot is 3 m ahead, which is to the left in the output frame
    assert update(publisher, 10.0) == ('combined', 'odom', pytest.approx(1.0), pytest.approx(-1.0))


def test_an_output_in_the_frame_of_the_odometry_is_to_the_robot_at_once(world):
    publisher = world(output_frame='odom')
    assert update(publisher, 10.0) == ('odom', 'base', 1.0, 2.0) and publisher.settled


def test_poses_have_their_rate_and_their_covariance(world):
    publisher = world(publish_tf=False)
    for tick in range(50):
        update(publisher, 10 + tick / 50)
    poses = publisher.pose_pub.sent
    assert len(poses) == publisher.published == 10 and not publisher.tf_pub.sent and publisher.settled
    assert poses[-1].header.stamp.to_sec() == 10.9
    assert poses[-1].header.frame_id == 'combined' and poses[-1].pose.covariance[::7][:2] == [0.01, 0.04]
    assert poses[-1].pose.pose.position.y == 2.0 and poses[-1].pose.covariance[35] == 0.09
    assert publisher.odometry_pub.sent[-1].child_frame_id == 'base'


@pytest.mark.parametrize('velocity', [None, Velocity(1.0, 2.0, 3.0, 0.4, 0.5, 0.6)])
def test_an_odometry_message_has_the_velocity_and_is_only_made_for_a_subscriber(world, velocity):
    publisher = world(publish_tf=False)
    update(publisher, 10.0, velocity=velocity)
    twist = publisher.odometry_pub.sent[-1].twist
    linear, angular = twist.twist.linear, twist.twist.angular
    assert (linear.x, linear.y, angular.z) == (velocity[:3] if velocity else (0, 0, 0))
    assert list(twist.covariance) == diagonal(*(0.4, 0.5, 1e6, 1e6, 1e6, 0.6) if velocity else [1e6] * 6)
    publisher.odometry_pub.connections = 0
    update(publisher, 11.0)
    assert len(publisher.odometry_pub.sent) == 1 and publisher.published == 2
