"""A displacement has the direction halfway between the estimated headings, not between the headings of the wheels."""
from math import cos, sin

import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose, arc
from rbx1_nav.filter.inputs import Imu
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact


def test_a_turn_before_the_wheels_move_changes_the_direction_in_which_they_move():
    robot = Robot(IDEAL)
    robot.send(100)
    for _ in range(4):      # the wheels are still at rest
        robot.now += STEP
        robot.combined.add_imu(robot.now, Imu(robot.now, 0.5, 3e-6))
        robot.combined.add_odom(robot.now, robot.odom())
    robot.pose = Pose(0.05, 0.0, 0.0)
    # turned by 0.04 rad; the noise of the wheels has some weight in the last step
    assert exact(robot.send(1), Pose(0.05 * cos(0.04), 0.05 * sin(0.04), 0.04), abs=2e-4)


@pytest.mark.parametrize('slip', [2.0, -1.0])
def test_wheels_that_slip_move_the_robot_along_the_turn_of_the_gyro(slip):
    robot = Robot(IDEAL)
    robot.send(3)
    # 0.5 rad in 0.2 s, in which the wheels report a multiple; that is too much to be used
    robot.send(10, angular=2.5, odom=False)
    robot.pose = arc(ORIGIN, 0.1, 0.5 * slip)
    robot.combined.add_odom(robot.now, robot.odom())
    chord = 0.1 * sin(0.25 * slip) / (0.25 * slip)
    # the first 3 steps have taught the filter a bias and a slip of rounding errors
    assert exact(robot.combined.estimate, Pose(chord * cos(0.25), chord * sin(0.25), 0.5), abs=1e-6)
