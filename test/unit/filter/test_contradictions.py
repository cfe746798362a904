"""What is no contradiction of wheels and gyro; what is one is in test_standstill.py."""
import pytest

from rbx1_nav.base.kinematics import arc
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from sample_robot import Robot


def turn_with_wheels(robot, ticks, factor, linear=0.0, angular=1.0, bias=0.0):
    """Drive a robot whose odometry reports a multiple of each turn; return the last Estimate."""
    wheels = robot.pose
    for _ in range(ticks):
        robot.send(1, linear, angular, odom=False, bias=bias)
        wheels = arc(wheels, linear * 0.02, factor * angular * 0.02)
        robot.combined.add_odom(robot.now, Odom(robot.now, wheels))
    robot.pose = wheels
    return robot.combined.estimate


@pytest.mark.parametrize('motion', [
    # the gyro reports -0.04 rad/s at standstill, and 0.01 rad/s in a turn at 0.05 rad/s
    dict(factor=1.0, angular=0.05, bias=-0.04),
    # a curve of 60 m, in which unequal wheels may turn the robot by 0.066 rad times the square root of the distance
    dict(factor=1.6, linear=0.5, angular=0.06)])
def test_neither_a_bias_in_a_slow_turn_nor_unequal_wheels_in_a_long_curve_are_a_contradiction(motion):
    robot = Robot(UNKNOWN_FLOOR)
    robot.send(500, bias=motion.get('bias', 0.0))
    turn_with_wheels(robot, 6000, **motion)
    assert not robot.warnings


def test_a_gyro_that_has_never_changed_is_left_when_the_wheels_have_turned():
    robot = Robot(UNKNOWN_FLOOR)
    robot.send(200)
    angle = 0.0
    for count, left in (4, False), (2, True), (100, True):      # 0.02 rad each: 0.1 rad is enough
        angle += count * 0.02
        for _ in range(count):
            robot.send(1, imu=False, angular=1.0, odom=False)
            robot.combined.add_imu(robot.now, Imu(robot.now, 0.0, 3e-6))
            robot.combined.add_odom(robot.now, robot.odom())
        ekf = robot.combined.filter
        # by the wheels, from the first step on
        assert ekf.gyro_left == left and robot.combined.pose.yaw == pytest.approx(angle)
    assert len(robot.warnings) == 1 and ekf.doubted == 'gyro'
    robot.send(50, 0.0, 0.5)
    assert not ekf.gyro_left and robot.warnings[1:] == ['odom and imu_data agree again'] and ekf.doubted == 'nothing'
