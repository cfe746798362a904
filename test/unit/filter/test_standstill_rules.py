"""Odometry and gyro together decide whether the robot is at rest, is carried, or turns slowly."""
from math import radians

import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.filter.filter import TICK, Filter
from rbx1_nav.filter.pose_errors import BIAS, YAW
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from rbx1_nav.filter.standstill import (
    CARRIED, CREEP, DOUBTFUL, MOVE, SAME, STANDSTILL, STILL, TELLING, TURN, UNDECIDED, WINDOW, Standstill)

STEP = 0.0625       # s, exact
NOISE = 1e-10       # rad^2, of a step


class Robot:
    """A robot whose wheels and gyro report the same in each step."""

    def __init__(self, rested=True):
        self.ekf, self.standstill = Filter(UNKNOWN_FLOOR, ORIGIN), Standstill(radians(10))
        self.pose, self.texts = ORIGIN, []
        self.standstill.leave(ORIGIN, self.ekf)
        if rested:
            self.ekf.learn_bias(0.0, 1e-12)

    def go(self, seconds, rate=0.0, moved=0.0, turned=0.0):
        """Go on for so long with a rate of the gyro (rad/s), while the wheels move (m) and turn (rad) per second;
        return the case."""
        for _ in range(round(seconds / STEP)):
            x, y, yaw = self.pose
            self.pose = Pose(x + moved * STEP, y, yaw + turned * STEP)
            if self.standstill.stands(self.pose, turned * STEP):
                text = self.standstill.add(STEP, (rate * STEP, NOISE), self.pose, self.ekf)
                self.texts += [text] if text else []
            else:
                self.standstill.leave(self.pose, self.ekf)
                self.moving = True
        return self.standstill.case

    def sigma(self):
        """Return 1 sigma of the heading, rad."""
        return self.ekf.covariance[YAW][YAW] ** 0.5


@pytest.mark.parametrize('rate', [radians(9.9), radians(-9.9), 0.0])
def test_the_first_steady_rate_within_the_limit_is_the_bias(rate):
    robot = Robot(rested=False)
    assert robot.go(0.5, rate) == STANDSTILL and not robot.ekf.rested       # too short for a tick of a coarse encoder
    robot.go(STILL * TICK + WINDOW, rate)
    assert robot.ekf.rested and robot.ekf.bias == pytest.approx(rate, abs=1e-5)


def test_a_rate_that_is_no_bias_is_a_robot_that_is_carried():
    robot = Robot(rested=False)
    assert robot.go(0.5, radians(10.1)) == CARRIED and not robot.ekf.rested
    assert robot.go(0.125, 0.0) == STANDSTILL
    robot = Robot(rested=False)     # not steady
    robot.go(0.5, 0.0)
    assert robot.go(STEP, radians(3)) == CARRIED


def test_a_window_counts_when_the_next_one_is_complete_too():
    robot = Robot()
    robot.go(WINDOW, 1e-6)
    assert robot.ekf.bias == 0.0
    robot.go(WINDOW, 0.0)
    assert robot.standstill.case == STANDSTILL and 0.0 < robot.ekf.bias < 1e-6
    # what the robot turns in the last two windows, it may have turned on driving off
    robot.go(2 * WINDOW, 2e-6)
    before = robot.ekf.state.yaw
    assert robot.go(STEP, 1.0, 1.0) is None and robot.ekf.state.yaw > before


@pytest.mark.parametrize('moved, turned, stands', [
    (0.9 * CREEP, 0.0, True), (MOVE * TICK + CREEP, 0.0, False), (0.0, 0.0009, True),
    (0.0, 1.1 * TURN * TICK + 0.001, False)])
def test_a_creep_is_a_rest_and_a_slow_drive_is_none(moved, turned, stands):
    robot = Robot()
    robot.moving = False
    case = robot.go(5.0, 0.0, 4 * moved if not stands else moved, 4 * turned if not stands else turned)
    assert (case == STANDSTILL) == stands and robot.moving is not stands


@pytest.mark.parametrize('phase', range(4))      # steps since a window began
def test_a_robot_that_drives_off_leaves_after_the_same_distance_wherever_its_window_began(phase):
    robot = Robot()
    robot.go(1.0 + phase * STEP)
    steps = 0
    while robot.go(STEP, 0.0, 0.9 * MOVE * TICK / STEP / 3) == STANDSTILL:
        steps += 1
    assert steps == 3


def test_a_slow_turn_is_undecided_until_the_wheels_show_it():
    robot = Robot()
    rate = radians(0.3)
    for _ in range(20):
        robot.go(1.0, rate, 0.0, rate)
    assert abs(robot.ekf.bias) < 1e-7 and robot.ekf.state.yaw == 0.0     # the combined odometry turns the robot
    assert not robot.texts


def test_a_bias_that_has_changed_is_learned_when_the_wheels_have_not_shown_a_turn():
    robot = Robot()
    robot.ekf.moving, robot.ekf.P[BIAS][BIAS] = 100.0, 1e-7
    assert robot.go(0.5, 0.005) == UNDECIDED
    assert robot.go(TELLING / 2 * TICK / 0.005 + 0.25, 0.005) == STANDSTILL
    assert robot.ekf.bias == pytest.approx(0.005, rel=0.1)
    assert robot.texts == ['the bias of imu_data has changed by 0.29 degrees/s since the last rest: the heading is '
                           'uncertain']


def test_a_turn_by_a_hand_or_a_turntable_is_a_doubt_until_the_old_rate_is_back():
    robot = Robot()
    rate = radians(5)
    assert robot.go(DOUBTFUL, rate) == CARRIED and not robot.texts
    robot.go(9.0, rate)
    assert robot.ekf.bias == 0.0 and robot.sigma() == pytest.approx(10 * rate, rel=1e-3)
    assert robot.texts == ['the wheels are at rest, and imu_data turns steadily by 5.0 degrees/s: somebody turns the '
                           'robot, or the bias has changed; the heading is uncertain']
    assert robot.go(1.0) == STANDSTILL and robot.sigma() < 0.01
    # a hand does not turn steadily
    for _ in range(10):
        robot.go(0.5, rate)
        robot.go(0.5, 2 * rate)
    assert len(robot.texts) == 1 and robot.sigma() < 0.2


def test_a_robot_that_drives_off_while_it_is_turned_steadily_may_have_another_bias():
    robot = Robot()
    robot.go(5.0, 0.1)
    robot.go(STEP, 0.1, 1.0)
    assert robot.ekf.bias == 0.0 and robot.ekf.sigma(BIAS) == pytest.approx(0.1, rel=0.01)
    robot.go(3.0, 0.1)      # so this is the bias at the next rest
    assert robot.standstill.case == STANDSTILL and robot.ekf.bias == pytest.approx(0.1, rel=0.05)


def test_the_smallest_turn_that_the_odometry_has_reported_is_its_tick():
    robot = Robot()
    assert robot.standstill.tick == TICK
    robot.go(STEP, 0.0, 1.0, 0.001 / STEP)
    robot.go(STEP, 0.0, 1.0, 0.9 * SAME / STEP)     # rounding
    assert robot.standstill.tick == pytest.approx(0.001)
