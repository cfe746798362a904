"""A simulated base publishes its state in order, greets new subscribers, and is never changed while it is read."""
from math import degrees

import pytest
import rospy
from std_srvs.srv import EmptyRequest

from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation import simulated_base_node as module
from rbx1_nav.simulation.simulated_base_node import SimulatedRobot
from fake_topics import replace_topics


class Time(Clock):
    """A simulated clock, and what is published on it."""

    time = 0

    def __init__(self):
        self.sent = []

    def now(self):
        return self.time

    def stamp(self, instant):
        return rospy.Time(0, instant)

    def greet(self, send):
        send()

    def publish(self, publisher, message):
        self.sent.append((publisher.name, message))


@pytest.fixture(name='robot')
def fixture_robot(monkeypatch):
    replace_topics(monkeypatch)
    monkeypatch.setattr(module, 'Updater', lambda: type('Updater', (), dict.fromkeys(
        ('setHardwareID', 'add', 'force_update'), lambda *_: None)))
    controller = dict(type='diff_controller', base_width=0.4, timeout=0.5)
    params = dict(controllers={'base': controller}, joints={'pan': {'max_speed': degrees(0.25)}})
    return SimulatedRobot(read_robot(params), None, 0, Time(), Refusals(), 'r')


def test_the_messages_of_a_step(robot):
    robot.base.command(0, 0.2, -0.5)
    robot.clock.time = SECOND // 10
    robot.step()
    robot.step()        # at the same time, nothing is new
    # the gyro has nothing to report before the second step
    assert [name for name, _ in robot.clock.sent] == ['/r/joint_states', '/tf', '/r/ground_truth', '/r/odom']
    odometry = robot.clock.sent[-1][1]
    # 0.1 s through 0.05 rad: the chord is shorter by a factor of 1e-4
    assert odometry.twist.twist.linear.x == 0.2 and odometry.pose.pose.position.x == pytest.approx(0.02, rel=1e-3)
    robot.clock.time = SECOND * 2 // 10
    robot.step()
    assert [name for name, _ in robot.clock.sent[5:]] == ['/tf', '/r/imu/data', '/r/ground_truth', '/r/odom']


def test_the_joints_move_by_the_elapsed_time_and_not_if_the_clock_jumps_back(robot):
    joint, = robot.robot.joints
    joint.command(1.0)
    positions = []
    for time in 1000, 1001, 1002, 5, 6:     # the first step has no previous time
        robot.clock.time = time * SECOND
        robot.step()
        positions.append(joint.position)
    assert positions == pytest.approx([0.0, 0.25, 0.5, 0.5, 0.75])


def test_a_new_subscriber_is_greeted_with_the_last_state(robot):
    heard = []
    robot.greet('/r/odom', heard.append)
    assert not heard
    robot.clock.time = SECOND // 10
    robot.step()
    robot.greet('/r/odom', heard.append)
    robot.greet('/tf', heard.append)
    assert [each._type for each in heard] == ['nav_msgs/Odometry', 'tf2_msgs/TFMessage']
    assert heard[0].header.stamp == heard[1].transforms[0].header.stamp == rospy.Time(0, SECOND // 10)


class Guarded:
    """A base that is used only while its lock is held."""

    def __init__(self, robot):
        self.robot, self.base, self.used = robot, robot.base, 0

    def __getattr__(self, name):
        assert self.robot.lock.locked(), name
        self.used += 1
        return getattr(self.base, name)


def test_no_command_changes_the_base_while_a_message_is_made(robot):
    robot.base = Guarded(robot)
    robot.clock.time = SECOND // 10
    for use in robot.step, lambda: robot.greet('/tf', lambda _: None), lambda: robot.on_reset(EmptyRequest()):
        used, _ = robot.base.used, use()
        assert robot.base.used > used
