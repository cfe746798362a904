"""What a step of the combined odometry adds to the uncertainty, and which odometry it is based on."""
from math import pi

import numpy
import pytest

from rbx1_nav.estimation.inputs import Imu, Odom
from rbx1_nav.estimation.model import X, Y, YAW
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.units import SECOND
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact
from test_inputs import VARIANCES


def drive(robot, step, pose, linear, angular=1e-9, rate=None):
    """Send odometry (and a rate of the gyro) after a step (ns); return the Estimate."""
    robot.now += step
    robot.pose = pose
    if rate is not None:
        robot.combined.add_imu(robot.now, Imu(robot.now, rate, 1e-9))
    robot.combined.add_odom(robot.now, Odom(robot.now, pose, linear, angular), VARIANCES)
    return robot.combined.estimate


@pytest.mark.parametrize('step', [STEP, SECOND // 4])
def test_the_variance_of_a_speed_is_a_variance_of_the_distance_by_the_square_of_the_time(step):
    robot = Robot(IDEAL, gyro_used=False)
    before = drive(robot, step, ORIGIN, 0.01)
    robot.combined.filter.P.root[3:] = 0.0      # no slip
    after = drive(robot, step, Pose(0.01, 0.0, 0.0), 0.01)
    growth = after.covariance - before.covariance
    assert growth[X, X] == pytest.approx(0.01 * (step / SECOND) ** 2, rel=1e-6)
    assert growth[Y, Y] == pytest.approx(0.0, abs=1e-9)
    assert growth[YAW, YAW] == pytest.approx(1e-9 * (step / SECOND) ** 2, rel=1e-3)
    assert after.odom == Odom(robot.now, robot.pose, 0.01, 1e-9) and after.stamp == robot.now


@pytest.mark.parametrize('linear, angular, used', [
    (0.1, 0.2, (0.1, 0.2)), (0.0, 0.2, (0.3, 0.5)), (0.1, 0.0, (0.3, 0.5)), (0.0, 0.0, (0.3, 0.5))])
def test_if_one_variance_of_the_speeds_is_missing_both_are_those_of_the_pose(linear, angular, used):
    robot = Robot(IDEAL, gyro_used=False)
    robot.combined.add_odom(robot.now, Odom(robot.now, ORIGIN, linear, angular), (0.3, 0.4, 0.5))
    odom = robot.combined.estimate.odom
    assert (odom.linear_variance, odom.angular_variance) == used


def test_while_no_odometry_arrives_the_robot_may_drive_at_half_a_metre_per_second():
    robot = Robot(IDEAL)
    before = robot.send(50)
    for ticks, elapsed in (75, 1.5), (50, 2.5):
        estimate = robot.send(ticks, odom=False)
        growth = estimate.covariance - before.covariance
        # the heading is uncertain by much less than 1 mm of the position
        assert growth[X, X] == growth[Y, Y] == pytest.approx((0.5 * elapsed) ** 2, rel=1e-6)
        assert abs(growth[X, Y]) < 1e-9 and estimate.odom == before.odom and estimate.stamp == robot.now


@pytest.mark.parametrize('pause, covered', [(SECOND, True), (SECOND + STEP, False)])
def test_the_first_reading_after_more_than_the_timeout_is_not_used(pause, covered):
    robot = Robot(IDEAL)
    robot.send(50)
    # the wheels do not report that the robot turns, and are far less certain than the gyro
    estimate = drive(robot, pause, Pose(0.01, 0.0, 0.0), 1e-6, 1e4, rate=0.5)
    expected = 0.25 * pause / SECOND if covered else 0.0        # the mean of 0 and 0.5 rad/s
    assert estimate.pose.yaw == pytest.approx(expected, abs=1e-3)


def test_the_travel_of_a_step_in_which_the_pose_was_set_counts_in_part():
    robot = Robot(IDEAL, gyro_used=False)
    robot.send(10, imu=False)
    robot.combined.set_pose(robot.now, Pose(0.0, 0.0, pi / 2), 0.01 * numpy.eye(3))
    assert exact(robot.combined.estimate, Pose(0.0, 0.0, pi / 2))
    robot.combined.set_pose(robot.now + STEP // 4, Pose(1.0, 1.0, pi / 2), 0.01 * numpy.eye(3))
    # three quarters of the step are after it
    estimate = drive(robot, STEP, Pose(0.04, 0.0, 0.0), 1e-6)
    assert exact(estimate, Pose(1.0, 1.03, pi / 2))
    # and all of the next one
    assert exact(drive(robot, STEP, Pose(0.08, 0.0, 0.0), 1e-6), Pose(1.0, 1.07, pi / 2))


@pytest.mark.parametrize('offset, at_once', [(0, True), (-1, True), (1, False)])
def test_a_pose_takes_effect_at_its_time(offset, at_once):
    robot = Robot(IDEAL)
    robot.send(10)
    robot.combined.set_pose(robot.now + offset, Pose(5.0, 6.0, 0.0), 0.25 * numpy.eye(3))
    assert exact(robot.combined.estimate, Pose(5.0, 6.0, 0.0)) == at_once
    estimate = robot.send(1)
    assert exact(estimate, Pose(5.0, 6.0, 0.0)) and estimate.covariance[X, X] == pytest.approx(0.25, rel=1e-3)


def test_the_cases_of_a_step():
    robot = Robot()
    assert robot.combined.case is None      # no message
    robot.send(5, 0.2)
    assert robot.combined.case == 'agreement'
    robot.send(75)
    assert robot.combined.case == 'standstill'
    robot.send(5, 0.2)
    assert robot.combined.case == 'agreement'
    robot.send(60, 0.2, imu=False)
    assert robot.combined.timed_out['imu_data'] and robot.combined.case is None
    without = Robot(gyro_used=False)
    without.send(50, imu=False)
    assert without.combined.case is None


def test_a_turn_that_begins_before_the_wheels_report_it_is_not_lost():
    robot = Robot(IDEAL)
    robot.send(100)
    # the gyro has measured 0.04 s of a turn when the wheels still report the old pose
    robot.send(2, angular=0.5)
    turned = robot.pose
    robot.pose = ORIGIN
    for _ in range(2):
        robot.now += STEP
        robot.combined.add_imu(robot.now, Imu(robot.now, 0.5, 3e-6))
        robot.combined.add_odom(robot.now, Odom(robot.now, turned, 1e-6, 1e-2), VARIANCES)
    assert robot.combined.estimate.pose.yaw == pytest.approx(4 * 0.02 * 0.5, abs=2e-3)
