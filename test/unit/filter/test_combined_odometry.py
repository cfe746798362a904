"""The combined odometry: the order of messages, and set_pose."""
from math import cos, pi, sin

import numpy
import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose, arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.filter import FIRST_NOISE
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact

SMALL = (0.01, 0.0, 0.0), (0.0, 0.01, 0.0), (0.0, 0.0, 0.01)


def test_the_estimate_follows_sensors_without_errors_exactly():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.send(100, 0.2, 0.5)
    robot.send(100, -0.1, -1.0)
    assert exact(robot.combined.estimate, robot.pose) and robot.combined.pose == robot.combined.estimate.pose


def test_the_variances_of_the_speeds_count_for_the_time_of_a_step():
    robot = Robot(IDEAL, gyro_used=False)
    robot.send(1, imu=False)
    robot.now, robot.pose = robot.now + SECOND // 2, Pose(1.0, 0.0, 0.0)
    robot.combined.add_odom(robot.now, Odom(robot.now, robot.pose, 0.004, 0.01))
    # in half a second; and 0.02 of slip in straight motion, 0.02 rad/m of curvature
    (xx, *_), _, (_, _, yaw) = robot.combined.estimate.covariance
    assert (xx, yaw) == pytest.approx((0.004 / 4 + 0.02 ** 2, 0.01 / 4 + 0.02 ** 2), rel=0.01)  # the first pose


@pytest.mark.parametrize('ticks, rates, direction', [
    (2, (0.0, 3.0), 0.03), (50, (3.0, 0.0), 0.06)])     # after a rest, the gyro may report the turn first
def test_the_path_turns_as_the_gyro_measures_and_not_as_the_wheels(ticks, rates, direction):
    robot = Robot(IDEAL)
    robot.send(ticks)
    for rate, pose in zip(rates, (ORIGIN, Pose(0.1 * cos(0.06), 0.1 * sin(0.06), 0.12))):
        robot.now += STEP
        robot.combined.add_imu(robot.now, Imu(robot.now, rate, 3e-6))
        robot.combined.add_odom(robot.now, Odom(robot.now, pose))
    assert exact(robot.combined.estimate, Pose(0.1 * cos(direction), 0.1 * sin(direction), 0.06))


# the order of messages

@pytest.mark.parametrize('rate', [20, 73, 100])
def test_a_gyro_may_have_another_rate(rate):
    robot, poses = Robot(IDEAL), {}
    next_reading = robot.now
    for _ in range(200):
        robot.now += STEP
        robot.pose = poses[robot.now] = arc(robot.pose, 0.004, 0.01)
        robot.combined.add_odom(robot.now, robot.odom())
        while next_reading <= robot.now:
            robot.combined.add_imu(robot.now, Imu(next_reading, 0.5, 3e-6))
            next_reading += SECOND // rate
    stamp = robot.combined.estimate.stamp
    # at most one reading and one message late
    assert 0 <= (robot.now - stamp) / SECOND <= 1.1 / rate + 0.02 and exact(robot.combined.estimate, poses[stamp])


# set_pose

def test_set_pose_puts_the_robot_there_and_keeps_what_was_learned():
    robot = Robot()
    robot.send(200, bias=0.05)
    covariance = ((0.04, 0.01, 0.0), (0.01, 0.09, 0.0), (0.0, 0.0, 0.01))
    robot.combined.set_pose(robot.now, Pose(3.0, -2.0, pi / 2), covariance)
    assert exact(robot.combined.estimate, Pose(3.0, -2.0, pi / 2))
    numpy.testing.assert_allclose(robot.combined.estimate.covariance, covariance, atol=1e-8)
    assert robot.combined.filter.bias == pytest.approx(0.05, abs=1e-4)
    robot.pose = ORIGIN
    estimate = robot.send(100, 0.1, bias=0.05)
    # 0.2 m, of which 2 % slip, in the new direction
    assert exact(estimate, Pose(3.0, -2.0 + 0.2 * 0.98, pi / 2), abs=1e-3)


def test_set_pose_takes_effect_while_the_odometry_has_timed_out():
    robot = Robot(IDEAL)
    robot.send(100, 0.2)
    last = robot.now
    robot.send(75, 0.2, odom=False)
    robot.combined.set_pose(last, Pose(0.0, 0.0, pi / 2), SMALL)
    assert robot.combined.timed_out['odom'] and exact(robot.combined.estimate, Pose(0.0, 0.0, pi / 2), abs=1e-6)
    assert exact(robot.send(1, 0.2), Pose(0.0, 76 * 0.004, pi / 2), abs=1e-6)


def test_set_pose_waits_for_the_step_to_its_time():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.send(4, imu=False)
    robot.combined.set_pose(robot.now, Pose(5.0, 0.0, 0.0), SMALL)
    assert exact(robot.combined.estimate, ORIGIN)
    robot.combined.add_imu(robot.now, Imu(robot.now, 0.0, 3e-6))
    assert exact(robot.send(1, 0.2), Pose(5.004, 0.0, 0.0), abs=1e-6)


def test_set_pose_does_not_depend_on_the_order_of_the_messages():
    results = []
    for late in False, True:
        robot = Robot()
        robot.send(100, 0.2, 0.5)
        at = robot.now + 5 * STEP
        if not late:
            robot.combined.set_pose(at, ORIGIN, SMALL)
        robot.send(5, 0.2, 0.5)
        if late:
            robot.combined.set_pose(at, ORIGIN, SMALL)
        results.append(robot.send(20, 0.2, 0.5).pose)
    assert results[0] == pytest.approx(results[1], abs=1e-9)


def test_a_slow_drive_is_compared_in_all_steps():
    robot = Robot(UNKNOWN_FLOOR)
    robot.send(501, 0.06, 0.1)      # 1.2 mm in a step, which may be a tick of a robot at rest
    assert robot.combined.filter.noise[1] == pytest.approx(FIRST_NOISE + 20)     # 10 s
