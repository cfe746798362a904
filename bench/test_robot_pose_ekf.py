"""robot_pose_ekf's arithmetic, against its results in closed form.

In each update, the system noise makes the old estimate negligible. What remains of the filter: the position follows the
odometry, rotated to the estimated heading; and the heading turns by the mean of both turns, weighted by the inverse
variances.
"""
import cmath
import math
import random

import numpy
import pytest

from robot_pose_ekf import RobotPoseEkf

ROUNDING = 1e-5     # of the weights: variances near 1e-5 are differences of two numbers near SYSTEM_NOISE
VARIANCES = 1e-3, 1e-3, 1e-3


def run(messages):
    """The filter after these messages: (time, odometry pose, its variances, IMU yaw, its variance)."""
    port = RobotPoseEkf()
    for message in messages:
        port.update(*message)
    return port


def by_closed_form(messages):
    """The result as complex position and yaw. The first message sets the pose, the second is the first measurement."""
    place, heading = complex(*messages[0][1][:2]), messages[0][1][2]
    for (_, before, _, imu_before, _), (_, odom, variances, imu, imu_variance) in zip(messages[1:], messages[2:]):
        place += (complex(*odom[:2]) - complex(*before[:2])) * cmath.exp(1j * (heading - before[2]))
        wheels, gyro = 1 / variances[2], 1 / imu_variance
        heading += (wheels * math.remainder(odom[2] - before[2], 2 * math.pi)
                    + gyro * math.remainder(imu - imu_before, 2 * math.pi)) / (wheels + gyro)
    return place, heading


def test_it_begins_at_the_pose_of_the_odometry():
    port = run([(5.0, (1.0, 2.0, 3.0), VARIANCES, 0.7, 1e-3)])
    assert port.state == pytest.approx([1.0, 2.0, 3.0]) and port.covariance == pytest.approx(1e-6 * numpy.eye(3))


def test_variances_are_those_of_one_second():
    port = run([(time, (0.0, 0.0, 0.0), (1e-3, 4e-3, 2e-3), 0.0, 2e-3) for time in (0.0, 1.0, 1.5)])
    assert numpy.diag(port.covariance) == pytest.approx([2.5e-4, 1e-3, 2.5e-4], rel=ROUNDING)


def test_a_stamp_that_is_not_later_has_no_effect():
    messages = [(0.1 * n, (0.02 * n, 0.0, 0.0), VARIANCES, 0.0, 1e-3) for n in range(5)]
    again = [(0.4, (9.0, 9.0, 1.0), VARIANCES, 1.0, 1e-3), (0.2, (9.0, 9.0, 1.0), VARIANCES, 1.0, 1e-3)]
    assert list(run(messages + again).state) == list(run(messages).state)


@pytest.mark.parametrize('seed', range(20))
def test_any_drive_ends_as_in_closed_form(seed):
    generator = random.Random(seed)
    time, imu, x, y, yaw, messages = 0.0, 0.0, 0.0, 0.0, 0.0, []
    for _ in range(300):    # several turns, both yaws wrapped to one turn, at changing intervals and variances
        time += generator.uniform(0.05, 0.2)
        turn = generator.uniform(-0.1, 0.3)
        x, y = x + generator.uniform(-0.01, 0.04), y + generator.uniform(-0.04, 0.04)
        yaw, imu = yaw + turn, imu + turn * generator.uniform(0.9, 1.1)
        variances = [10 ** generator.uniform(-2, 1) for _ in range(4)]
        messages.append((time, (x, y, math.remainder(yaw, 2 * math.pi)), variances[:3], imu % (2 * math.pi),
                         variances[3]))
    place, heading = by_closed_form(messages)
    state = run(messages).state
    assert complex(*state[:2]) == pytest.approx(place, abs=1e-6)
    assert math.remainder(state[2] - heading, 2 * math.pi) == pytest.approx(0.0, abs=1e-6)
