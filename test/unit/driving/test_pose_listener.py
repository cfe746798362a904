"""The pose of a driving script: the last transform, extrapolated to the present, or an error."""
from math import cos, pi, sin

from geometry_msgs.msg import TransformStamped
import pytest
import rospy
import tf2_ros

from rbx1_nav.driving import odometry as module
from rbx1_nav.driving.odometry import PoseListener


class Buffer:
    """Transforms from the odometry frame, by child: (stamp in s, x, y, yaw)."""

    def __init__(self):
        self.poses, self.heard = {}, False

    def lookup_transform(self, parent, child, time):
        if parent != 'robot1/odom' or not self.heard or child not in self.poses or time:  # 0: last
            raise tf2_ros.LookupException('no such frame')
        stamp, x, y, yaw = self.poses[child]
        transform = TransformStamped(child_frame_id=child)
        transform.header.stamp = rospy.Time.from_sec(stamp)
        transform.transform.translation.x, transform.transform.translation.y = x, y
        transform.transform.rotation.z, transform.transform.rotation.w = sin(yaw / 2), cos(yaw / 2)
        return transform

    def all_frames_as_yaml(self):
        return ''.join(f'{child}: {{parent: robot1/odom}}\n' for child in self.poses)


@pytest.fixture(name='world')
def fixture_world(monkeypatch):
    """A World whose robot is at rest at the origin."""
    return World(monkeypatch)


class World:
    """A PoseListener of a robot whose speeds are 0.2 m/s and 1 rad/s, and the time (s)."""

    def __init__(self, monkeypatch):
        self.time, self.halts = 0.0, []
        monkeypatch.setattr(tf2_ros, 'Buffer', Buffer)
        monkeypatch.setattr(tf2_ros, 'TransformListener', lambda buffer: setattr(buffer, 'heard', True))
        monkeypatch.setattr(rospy, 'Subscriber', lambda topic, _, function: setattr(self, topic, function))
        monkeypatch.setattr(rospy, 'get_namespace', lambda: '/robot1/')
        monkeypatch.setattr(rospy, 'get_time', lambda: self.time)
        for name in 'loginfo', 'logwarn':
            monkeypatch.setattr(rospy, name, lambda *_: None)
        monkeypatch.setattr(module, 'resolve_frame', lambda name: f'robot1/{name}')
        monkeypatch.setattr(module, 'param', lambda _: 0.0)
        monkeypatch.setattr(module, 'wait_for_tick', lambda: self.halts.append('tick'))
        monkeypatch.setattr(module, 'halt', lambda: self.halts.append(self.time))
        self.listener = PoseListener('/odom', None, 0.2, 1.0)

    def at(self, time, stamp, *pose):
        """The pose at a time, if the last transform is this one."""
        self.time, self.listener.buffer.poses['robot1/base_link'] = time, (stamp, *pose)
        return self.listener.pose()


def test_the_pose_is_extrapolated_forward_from_the_last_two_transforms(world):
    assert world.at(10.04, 10.0, 0.5, -0.3, 3.1) == pytest.approx((0.5, -0.3, 3.1))
    # 0.2 m/s, -0.1 m/s and 0.8 rad/s, through the angle of pi
    last = 10.1, 0.48, -0.31, 3.18 - 2 * pi
    assert world.at(10.1, *last) == pytest.approx(last[1:])
    assert world.at(10.14, *last) == pytest.approx((0.472, -0.314, 3.212 - 2 * pi))
    # a transform from the future is not extrapolated
    assert world.at(10.15, 10.2, 0.46, -0.32, 3.2 - 2 * pi) == pytest.approx((0.46, -0.32, 3.2 - 2 * pi))
    # the robot coasted in a gap, and was stopped
    assert world.at(10.74, 10.7, 0.42, -0.32, 3.2 - 2 * pi) == pytest.approx((0.42, -0.32, 3.2 - 2 * pi))


def test_the_first_base_frame_that_exists_is_kept(world):
    world.at(10.0, 10.0, 0.0, 0.0, 0.0)
    world.listener.buffer.poses['robot1/base_footprint'] = 10.1, 0.02, 0.0, 0.0
    assert world.listener.base_frame == 'robot1/base_link' and world.listener.pose().x == 0


def test_a_transform_that_is_too_old_or_missing(world):
    text = "the robot's pose: There is no transform from robot1/odom to robot1/base_footprint or robot1/base_link"
    with pytest.raises(rospy.ROSException, match=f'Timed out after 0 s waiting for {text}'):
        world.listener.pose()
    world.at(10.0, 10.0, 0.0, 0.0, 0.0)
    world.at(10.5, 10.0, 0.0, 0.0, 0.0)
    for time, text in (10.51, '0.51 s old'), (9.4, '-0.60 s old'):
        with pytest.raises(rospy.ROSException, match=text):
            world.at(time, 10.0, 0.0, 0.0, 0.0)
    assert world.halts == ['tick']      # once, before the first pose
    world.listener.transform_timeout = 0.0      # now the robot waits, stopped
    with pytest.raises(rospy.ROSException, match='Timed out'):
        world.at(10.51, 10.0, 0.0, 0.0, 0.0)
    assert world.halts == ['tick', 10.51]


def test_a_jump_and_a_reset(world):
    world.reset_odometry(None)      # before the run
    world.at(10.0, 10.0, 0.0, 0.0, 0.0)
    with pytest.raises(rospy.ROSException, match=r'jumped from \(0.000 m, 0.000 m, 0.000 rad\) to \(0.000 m, 1.000 m'):
        world.at(10.1, 10.1, 0.0, 1.0, 0.0)
    world.reset_odometry(None)
    with pytest.raises(rospy.ROSException, match='The base was reset'):
        world.at(10.2, 10.2, 0.0, 0.0, 0.0)


@pytest.mark.parametrize('odom, base, text', [
    ('odom', 'base_link', ''), ('odom', 'base', '; frames that exist: robot1/base_link, robot1/odom'),
    ('odo', 'base_link', '; frames that exist: robot1/base_link, robot1/odom'), ('odom_combined', 'base_link',
     '; frames that exist: robot1/base_link, robot1/odom. To start the filter that publishes odom_combined: roslaunch '
     'rbx1_bringup odom_ekf.launch robot:=robot1')])
def test_a_frame_that_does_not_exist(world, odom, base, text):
    assert world.listener._known_frames() == ''     # before the first transform
    world.listener.buffer.poses['robot1/base_link'] = 10.0, 0.0, 0.0, 0.0
    world.listener.odom_frame, world.listener.base_frames = f'robot1/{odom}', [f'robot1/{base}']
    assert world.listener._known_frames() == text
