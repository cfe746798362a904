"""The four named cases: standstill, agreement, contradiction, carried."""
from math import degrees, hypot, radians, sqrt

import numpy
import pytest

from rbx1_nav.base.kinematics import ORIGIN, arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR

ODOM_STEP, IMU_STEP = SECOND // 25, SECOND // 50
NOISE = radians(0.1)    # rad/s, of a reading


class Robot:
    """A robot with a noisy gyro, which is driven and carried."""

    def __init__(self, imu_variance=NOISE ** 2):
        self.warnings = []
        self.combined = CombinedOdometry(UNKNOWN_FLOOR, SECOND, warn=self.warnings.append)
        self.generator = numpy.random.default_rng(1)
        self.imu_variance = imu_variance
        self.now = 1000 * SECOND
        self.wheels, self.yaw, self.bias = ORIGIN, 0.0, 0.0

    def go(self, time, linear=0.0, angular=0.0, carried=0.0, ratio=1.0):
        """Drive for a time (s), and return the error of the heading and its sigma, degrees.

        carried: rad/s, by which a hand turns the robot; ratio: turn that the wheels report / true turn.
        """
        end = self.now + round(time * SECOND)
        while self.now < end:
            self.now += IMU_STEP
            turn = angular * IMU_STEP / SECOND
            self.wheels = arc(self.wheels, linear * IMU_STEP / SECOND, ratio * turn)
            self.yaw += turn + carried * IMU_STEP / SECOND
            rate = angular + carried + self.bias + self.generator.normal(0, NOISE)
            self.combined.add_imu(self.now, Imu(self.now, rate, self.imu_variance))
            if self.now % ODOM_STEP == 0:
                self.combined.add_odom(self.now, Odom(self.now, self.wheels))
        estimate = self.combined.estimate
        return degrees(estimate.pose.yaw - self.yaw), degrees(sqrt(estimate.covariance[2][2]))

    @property
    def case(self):
        return self.combined.case


@pytest.mark.parametrize('bias', [-6.0, 0.5, 3.0, 6.0])
def test_standstill_any_bias_is_learned_in_3_seconds(bias):
    robot = Robot()
    robot.bias = radians(bias)
    robot.go(3.0)
    assert robot.case == 'standstill'
    # 0.1 degrees/s at 50 Hz, averaged over the last 2.5 s without the parts not used yet: 0.01 degrees/s, 4 sigma
    assert degrees(robot.combined.filter.bias) == pytest.approx(bias, abs=0.04)
    error, sigma = robot.go(20.0, 0.2, 0.3)
    # 20 s of 0.01 degrees/s
    assert abs(error) < 1.0 and abs(error) < 4 * sigma and not robot.warnings
    assert robot.case == 'agreement'


def test_standstill_a_claimed_variance_that_is_far_too_large_is_not_believed():
    robot = Robot(imu_variance=0.005)
    robot.go(3.0)
    _, sigma = robot.go(20.0, 0.2)
    # by the reported variance: 0.01 rad/s * sqrt(1 s) in each second, and an equally uncertain bias: 7 degrees
    assert sigma < 1.5


def test_standstill_wheels_that_report_later_than_the_gyro_are_not_carried():
    robot = Robot()
    robot.go(3.0)
    for number in range(20):
        robot.go(0.04, carried=0.5)     # the wheels will report it in the next message
        robot.wheels = arc(robot.wheels, 0.0, 0.02)
        robot.go(1.0, 0.1, 0.5)
        error, sigma = robot.go(1.5 + 0.02 * number)
    # 0.04 s of 0.5 rad/s are 1.1 degrees each time
    assert not robot.combined.filter.carried and abs(error) < 3.0 and sigma < 5.0


def test_a_drifting_bias_makes_the_heading_as_uncertain_as_it_is_wrong():
    robot = Robot()
    robot.go(3.0)
    squares = []
    for _ in range(5):
        for _ in range(20):
            robot.bias += radians(0.5) / 60     # degrees/s in a minute
            error, sigma = robot.go(1.0, 0.2)
        squares.append((error / sigma) ** 2)
        robot.go(7.0)
    # 1.7 degrees in each leg; the drift is known from the first standstill after a leg
    assert max(squares[1:]) < 9.0


@pytest.mark.parametrize('rate', [0.3, 0.5, 0.9])
def test_a_slow_turn_that_is_taken_for_a_bias_makes_the_heading_as_uncertain_as_it_is_wrong(rate):
    robot = Robot()
    robot.go(20.0)
    robot.go(10.0, carried=radians(rate))
    error, sigma = robot.go(10.0)
    assert abs(error) > 5 * rate and 0.5 < sigma / abs(error) < 1.5


def test_a_bias_that_has_changed_since_the_rest_before_does_not_make_the_heading_more_uncertain():
    robot = Robot()
    robot.go(20.0)
    robot.go(1.0, 0.2)
    robot.bias += radians(0.5)
    _, before = robot.go(5.0)
    _, sigma = robot.go(10.0)
    assert sigma < before + 0.1


def test_carried_the_heading_turns_with_the_gyro():
    robot = Robot()
    robot.bias = radians(1.0)
    robot.go(3.0)
    robot.go(1.5, carried=1.0)
    assert robot.case == 'carried' and robot.combined.estimate.covariance[0][0] > 0.5 ** 2
    error, sigma = robot.go(2.0)
    # the wheels have reported none of the 86 degrees
    assert abs(error) < 2.0 and abs(error) < 4 * sigma and robot.case == 'standstill'
    assert degrees(robot.combined.filter.bias) == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize('ratio', [1.5, 2.0, 3.0])
def test_a_skid_steer_follows_the_gyro(ratio):
    robot = Robot()
    robot.go(3.0)
    errors = []
    for angular in (0.5, -0.5, 0.5, -0.5, 0.5, -0.5, 0.5, -0.5):
        errors.append(robot.go(4.0, 0.2, angular, ratio=ratio))
        robot.go(1.0)
    assert max(abs(error) for error, _ in errors) < 2.0 and len(robot.warnings) <= 1
    assert errors[-1][1] < 6.0 and all(abs(error) < 4 * sigma for error, sigma in errors)


def test_contradiction_of_a_gyro_upside_down_is_noticed_in_the_first_turn():
    for ratio in -0.97, -1.0, -1.03:
        robot = Robot()
        robot.go(3.0)
        robot.go(4.0, 0.2, -0.5, ratio=ratio)
        assert robot.case == 'contradiction' and robot.combined.filter.gyro_left
        assert [text.split(': ')[-1].split(';')[0] for text in robot.warnings] == [
            'the bias has drifted, or one of them is wrong',
            'the gyro fails, and is not used until it turns with the wheels']


def test_without_a_gyro_there_is_no_case():
    robot = Robot()
    assert robot.case is None
    robot.go(3.0)
    for _ in range(60):
        robot.now += ODOM_STEP
        robot.combined.add_odom(robot.now, Odom(robot.now, robot.wheels))
    assert robot.case is None and hypot(*robot.combined.estimate.pose[:2]) < 1e-6
