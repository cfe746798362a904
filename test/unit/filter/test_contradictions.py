"""What is no contradiction of wheels and gyro; what is one is in test_standstill.py."""
import pytest

from rbx1_nav.base.kinematics import arc
from rbx1_nav.filter.inputs import Odom
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
