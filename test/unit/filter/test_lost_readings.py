"""Lost gyro readings and slow gyros make the heading uncertain."""
import pytest

from sample_priors import IDEAL
from sample_robot import Robot, exact


@pytest.mark.parametrize('lost', [4, 10, 20, 40])
@pytest.mark.parametrize('odom', [True, False])
def test_readings_of_the_gyro_that_are_lost_make_the_heading_uncertain(lost, odom):
    robot = Robot()
    robot.send(100)
    robot.send(50, angular=1.0)
    before = robot.combined.estimate.covariance[2, 2]
    robot.send(lost // 2, angular=1.0, odom=odom, imu=False)    # the robot stops in the middle
    robot.send(lost // 2, odom=odom, imu=False)
    estimate = robot.send(10)
    error = abs(estimate.pose.yaw - robot.pose.yaw)
    # the wheels of this floor slip by 3 +- 5 %
    assert error < 0.015 and error ** 2 < 9 * estimate.covariance[2, 2] and estimate.covariance[2, 2] > 1.5 * before
    assert not robot.warnings


def test_a_steady_turn_needs_no_reading_of_the_gyro():
    robot = Robot(IDEAL)
    robot.send(50, 0.1, 0.5)
    robot.send(40, 0.1, 0.5, imu=False)
    assert exact(robot.send(10, 0.1, 0.5), robot.pose)
