"""Lost gyro readings and slow gyros make the heading uncertain."""
import pytest

from rbx1_nav.estimation.inputs import Imu
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact


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


@pytest.mark.parametrize('lost', [4, 20, 40])
def test_a_rate_that_is_a_mean_counts_for_the_whole_gap(lost):
    robot = Robot()
    robot.send(100)
    robot.send(50, angular=1.0)
    robot.send(lost // 2, angular=1.0, odom=False, imu=False)
    robot.send(lost // 2, odom=False, imu=False)
    robot.now += STEP
    robot.combined.add_imu(robot.now, Imu(robot.now, lost / 2 / (lost + 1), 1e-6, is_mean=True))
    robot.combined.add_odom(robot.now, robot.odom())
    estimate = robot.combined.estimate
    assert abs(estimate.pose.yaw - robot.pose.yaw) < 0.01 and not robot.warnings


def robot_with_a_slow_gyro(every, ticks):
    """Return a robot that turns and rests alternately, and whose gyro reports its rate every `every` ticks."""
    robot = Robot()
    robot.send(100)
    rate = 0.0
    for tick in range(1, ticks + 1):
        rate = max(rate - 0.1, 0.0) if tick // 60 % 2 else min(rate + 0.1, 1.0)
        robot.send(angular=rate, imu=False)
        if tick % every == 0:
            robot.combined.add_imu(robot.now, Imu(robot.now, rate, 3e-6))
    return robot


@pytest.mark.parametrize('every', [5, 10])
def test_a_slow_gyro_makes_the_heading_uncertain(every):
    robot = robot_with_a_slow_gyro(every, 3000)
    estimate = robot.combined.estimate
    error = estimate.pose.yaw - robot.pose.yaw
    assert error ** 2 < 9 * estimate.covariance[2, 2] and not robot.warnings
