"""The velocity that is published with the estimate comes from odometry and gyro, with a matching uncertainty."""
from collections import namedtuple
from math import pi

import pytest

from rbx1_nav.base.kinematics import ORIGIN, arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.estimate_publisher import estimate_twist
from rbx1_nav.filter.inputs import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors

STEP = SECOND // 50
# m/s, m/s, rad/s, and the variances of these
Twist = namedtuple('Twist', 'forward left turn forward_variance left_variance turn_variance')
IDEAL = priors(None)


class Robot:
    """Sends the messages of both sensors every 0.02 s, and keeps the last two estimates."""

    def __init__(self, prior, **options):
        self.combined = CombinedOdometry(prior, SECOND, **options)
        self.now = 1000 * SECOND
        self.pose = ORIGIN
        self.before = None

    def drive(self, ticks, linear, wheels, gyro, odom=True, imu=True):
        """Move the odometry at linear (m/s) and wheels (rad/s), and the gyro at `gyro` (rad/s); return the Twist."""
        for _ in range(ticks):
            last = self.combined.estimate
            self.now += STEP
            self.pose = arc(self.pose, linear * 0.02, wheels * 0.02)
            if imu:
                self.combined.add_imu(self.now, Imu(self.now, gyro, 3e-6))
            if odom:
                self.combined.add_odom(self.now, Odom(self.now, self.pose))
            if self.combined.estimate is not last:
                self.before = last
        message = estimate_twist(self.combined, self.before)
        twist, variances = message.twist, message.covariance[::7]
        return Twist(twist.linear.x, twist.linear.y, twist.angular.z, variances[0], variances[1], variances[5])


def test_sensors_without_errors():
    robot = Robot(IDEAL)
    robot.drive(150, 0.0, 0.0, 0.0)
    twist = robot.drive(150, 0.3, 0.5, 0.5)
    # the chord of an arc of 0.01 rad is shorter than the arc by a factor of 4e-6
    assert twist[:3] == pytest.approx((0.3, 0.0, 0.5), abs=1e-4)
    # backward, and through the angle of pi
    for _ in range(10):
        twist = robot.drive(50, -0.1, 1.0, 1.0)
        assert twist[:3] == pytest.approx((-0.1, 0.0, 1.0), abs=1e-4)
    assert robot.combined.estimate.pose.yaw > 2 * pi


def test_the_displacement_is_reduced_by_the_slip_and_the_turn_is_the_gyros():
    robot = Robot(UNKNOWN_FLOOR._replace(slip_straight=0.1, slip_turning=0.2))
    robot.drive(150, 0.0, 0.0, 0.0)
    twist = robot.drive(150, 0.3, 0.5, 0.4)
    assert twist.forward == pytest.approx(0.27, abs=0.001)
    assert twist.turn == pytest.approx(0.4, abs=0.01)


def test_the_variances_cover_noise_slip_bias_and_scale():
    robot = Robot(UNKNOWN_FLOOR)
    twist = robot.drive(150, 0.5, 0.0, 0.0)
    # on an unknown floor 5 % of slip, and the noise of a cell of 0.1 m: 0.044 ** 2 / 0.1
    assert twist.forward_variance == pytest.approx(0.25 * (0.05 ** 2 + 0.0194), rel=0.05)
    assert twist.left_variance < 1e-5
    # the gyro bias is unknown before the first standstill
    assert twist.turn_variance > 0.01 ** 2
    robot = Robot(UNKNOWN_FLOOR)
    robot.drive(500, 0.0, 0.0, 0.0)
    assert robot.drive(10, 0.5, 0.0, 0.0).turn_variance < 0.003 ** 2
    # a scale error of 0.7 %
    assert robot.drive(10, 0.0, 2.0, 2.0).turn_variance == pytest.approx(0.014 ** 2, rel=0.1)


def test_without_a_gyro_the_turn_is_as_uncertain_as_the_slip():
    robot = Robot(UNKNOWN_FLOOR, gyro_used=False)
    twist = robot.drive(50, 0.0, 1.0, None, imu=False)
    assert twist.turn == pytest.approx(1.0)
    # 30 % of slip, and the noise of a cell of 0.25 rad: 0.084 ** 2 / 0.25
    assert twist.turn_variance == pytest.approx(0.3 ** 2 + 0.0282, rel=0.05)


def test_after_a_dropout_of_the_odometry_the_velocity_is_the_mean_since_the_last_one():
    robot = Robot(UNKNOWN_FLOOR)
    robot.drive(200, 0.3, 0.0, 0.0)
    robot.drive(100, 0.3, 0.5, 0.5, odom=False)
    twist = robot.drive(1, 0.3, 0.5, 0.5)
    assert (twist.forward, twist.turn) == pytest.approx((0.3, 0.5), abs=0.02)
