"""odom_out_and_back.py drives out and back by the pose, rests twice in each motion, and reports the error."""
from contextlib import nullcontext
from math import cos, pi, sin

import pytest
import rospy

from rbx1_nav.base.kinematics import Pose
from loaded_nodes import load, without_master


@pytest.fixture(name='drive')
def fixture_drive(monkeypatch):
    """Runs the script with parameters; returns (its path, its rests, its log, its last command)."""
    node = load('odom_out_and_back')
    topics, log = without_master(monkeypatch)

    class Robot:
        """Follows the last command for each period of the rate; its odometry reports a final drift."""

        odom_frame = 'odom'

        def __init__(self, *_):
            self.path = [Pose(1.0, 2.0, 3.0)]

        def pose(self):
            return self.path[-1]

        def move(self, rate):
            x, y, yaw = self.path[-1]
            command = topics['cmd_vel'].sent[-1]
            travel, angle = command.linear.x / rate, command.angular.z / rate
            self.path.append(Pose(x + travel * cos(yaw + angle / 2), y + travel * sin(yaw + angle / 2), yaw + angle))

    def drive(**params):
        robot, rests = Robot(), []
        monkeypatch.setattr(node, 'PoseListener', lambda *_: robot)
        monkeypatch.setattr(node, 'Drive', lambda publisher, timed: nullcontext())
        monkeypatch.setattr(rospy, 'init_node', lambda *_, **__: None)
        monkeypatch.setattr(rospy, 'on_shutdown', lambda _: None)
        monkeypatch.setattr(rospy, 'get_param', lambda name, default: params.get(name[1:], default))
        monkeypatch.setattr(rospy, 'Rate', lambda rate: type('Rate', (), {'sleep': lambda _: robot.move(rate)})())
        monkeypatch.setattr(rospy, 'sleep', rests.append)
        node.OutAndBack()
        return robot.path, rests, log, topics['cmd_vel'].sent
    return drive


def test_the_path_out_and_back(drive):
    path, rests, log, sent = drive(goal_distance=0.5, goal_angle=pi)
    farthest = max(path, key=lambda pose: abs(pose.x - 1.0))
    # 3 rad: away from the y axis, and slightly to the left
    assert (farthest.x - 1.0, farthest.y - 2.0) == pytest.approx((0.5 * cos(3), 0.5 * sin(3)), abs=0.01)
    assert (path[-1].x, path[-1].y) == pytest.approx((1.0, 2.0), abs=0.02)
    assert path[-1].yaw == pytest.approx(3 + 2 * pi, abs=0.05)
    assert len(rests) == 8 and all(rest > 0 for rest in rests) and rests[0::2] == [rests[0]] * 4
    assert not sent[-1].linear.x and not sent[-1].angular.z


def test_the_last_line_is_the_error_of_place_and_heading(drive):
    path, _, log, _ = drive(goal_angle=pi / 2, goal_distance=0.3)
    end = path[-1]
    distance = ((end.x - 1.0) ** 2 + (end.y - 2.0) ** 2) ** 0.5
    assert log[-1] == ('info', f'Measured in odom, the robot is {distance:.3f} m from its start and 180.0 degrees off '
                               'its initial heading')
