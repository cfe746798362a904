"""A reset or a restart forgets the estimate but not the stamps, and each restart is reported."""
import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import Odom
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact
from test_contradictions import turn_with_wheels


@pytest.mark.parametrize('offset, counts', [(0, True), (-1, False)])
def test_odometry_from_the_time_of_a_reset_counts(offset, counts):
    robot = Robot(gyro_used=False)
    robot.combined.reset(robot.now + STEP)
    robot.combined.add_odom(robot.now + STEP, Odom(robot.now + STEP + offset, ORIGIN))
    assert bool(robot.combined.estimate) == counts


def test_a_reset_is_soon_over_if_the_clock_of_the_robot_is_behind():
    robot = Robot()
    robot.send(50)
    robot.combined.reset(robot.now + 30 * SECOND)
    assert not robot.send(49) and robot.send(2)


def test_a_reset_forgets_what_was_waited_for_but_not_the_bias():
    robot = Robot()
    robot.send(100, bias=0.05)
    turn_with_wheels(robot, 150, -1.0, bias=0.05)
    robot.combined.set_pose(robot.now + STEP, Pose(5.0, 0.0, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    robot.combined.arrivals.set_timed_out('imu_data')
    assert robot.combined.contradicts and robot.combined.filter.rested
    robot.combined.reset(robot.now)
    assert robot.combined.case is None and not robot.combined.contradicts
    assert robot.combined.timed_out == {'odom': False, 'imu_data': False}
    robot.pose = ORIGIN
    assert exact(robot.send(2, bias=0.05), ORIGIN, 1e-4) and robot.combined.filter.rested
    assert robot.combined.filter.bias == pytest.approx(0.05, abs=1e-4)


def test_a_clock_that_jumped_back_is_reported_with_the_jump():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.now -= 2 * SECOND
    robot.send(2)
    # the next tick is 0.02 s after the jump
    assert robot.warnings == ['The clock jumped back by 1.980 s: restarting at the odometry pose']


def test_a_jump_is_reported_with_both_poses():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.pose = Pose(1.0, -2.0, 0.5)
    robot.send(2)
    assert robot.warnings == [
        'odom: (1.000 m, -2.000 m, 0.500 rad) is too far from (0.000 m, 0.000 m, 0.000 rad) for the 0.020 s between '
        'them (~max_speed, ~max_turn_rate): ignored',
        'odom: jumped from (0.000 m, 0.000 m, 0.000 rad) to (1.000 m, -2.000 m, 0.500 rad): restarting at the odometry '
        'pose']
    assert exact(robot.combined.estimate, robot.pose)


def test_jumps_that_do_not_agree_with_each_other_are_outliers():
    robot = Robot(IDEAL)
    robot.send(50)
    before = robot.combined.estimate
    for x in 5.0, -5.0, 5.0:
        robot.pose = Pose(x, 0.0, 0.0)
        robot.send(1)
        assert robot.combined.case is None
    assert robot.combined.estimate is before
    robot.pose = ORIGIN
    assert exact(robot.send(2), ORIGIN) and robot.combined.case == 'standstill'
    assert len(robot.warnings) == 3 and all('ignored' in text for text in robot.warnings)
