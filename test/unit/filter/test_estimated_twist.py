"""The velocity that is published with the estimate comes from odometry and gyro, with a matching uncertainty."""
from math import cos, pi, sin
from types import SimpleNamespace

from geometry_msgs.msg import TwistWithCovariance
import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.base.messages import diagonal
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import Estimate
from rbx1_nav.filter.estimate_publisher import estimate_twist
from rbx1_nav.filter.filter import BIAS, SCALE, SLIP_STRAIGHT, SLIP_TURNING, Filter
from rbx1_nav.filter.inputs import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR

FLOOR = UNKNOWN_FLOOR._replace(slip_straight=0.1, slip_turning=0.2, distance_noise=0.3, heading_noise_turning=0.4,
                               heading_noise_straight=0.5)
GOOD = 1e-6     # (m/s)^2 or (rad/s)^2: what a good sensor measures
# variances of the slip forward, of the bias and scale error of the gyro, and of the slip of the wheels in a turn
SLIP, GYRO, WHEELS = (0.07 * 0.225) ** 2, 0.02 ** 2 + (0.03 * 0.5) ** 2, (0.6 * 0.5) ** 2


def measure(time=2.0, case='agreement', reported=(0.0, 0.0), period=0.1, **options):
    """Return the message for a robot whose odometry moves at 0.25 m/s forward, -0.1 m/s to the left (halfway through
    its turn) and 0.4 rad/s for a time (s), while the filter turns at 0.5 rad/s, both through pi."""
    ekf = Filter(FLOOR, ORIGIN)
    for index, sigma in (SLIP_STRAIGHT, 0.07), (BIAS, 0.02), (SCALE, 0.03), (SLIP_TURNING, 0.6):
        ekf.P[index, index] = sigma ** 2
    c, s = cos(3.1 + 0.2 * time), sin(3.1 + 0.2 * time)
    end = Pose(1.0 + time * (0.25 * c + 0.1 * s), 2.0 + time * (0.25 * s - 0.1 * c), 3.1 + 0.4 * time - 2 * pi)
    before, last = (Estimate(stamp, Pose(0.0, 0.0, yaw), None, Odom(stamp, odom, *reported)) for stamp, yaw, odom in (
        (7 * SECOND, 3.0, Pose(1.0, 2.0, 3.1)), (round((7 + time) * SECOND), 3.0 + 0.5 * time - 2 * pi, end)))
    combined = SimpleNamespace(**{**dict(
        filter=ekf, estimate=last, case=case, gyro_used=True, timed_out={'odom': False, 'imu_data': False},
        readings=SimpleNamespace(last=Imu(last.stamp, 9.0, 0.01), period=round(period * SECOND))), **options})
    return estimate_twist(combined, before)


# the noise of the gyro averages out over its readings, unless the step has only one, or their period is not known
@pytest.mark.parametrize('options, forward, turn', [
    (dict(time=2.0), 0.3 ** 2 * 0.225 / 2 + SLIP, 0.01 * 0.1 / 2 + GYRO),
    # within a cell of 0.1 m, the noise of the floor is constant
    (dict(time=0.1, period=0.5), 0.3 ** 2 * 0.225 ** 2 / 0.1 + SLIP, 0.01 + GYRO),
    (dict(period=0.0, reported=(0.6, 9.0)), 0.6 + SLIP, 0.01 + GYRO),
    (dict(case='carried'), 0.25 - GOOD, 0.01 * 0.1 / 2 + GYRO),
    # the wheels turn at 0.4 rad/s less 20 % of slip
    (dict(case='contradiction', period=2.0), 0.3 ** 2 * 0.225 / 2 + SLIP, 0.01 + GYRO + (0.32 - 0.5) ** 2),
    # without the gyro: noise of the floor and slip, and within cells of 0.25 rad and 0.1 m
    (dict(timed_out={'odom': False, 'imu_data': True}), 0.3 ** 2 * 0.225 / 2 + SLIP,
     0.4 ** 2 * 0.4 / 2 + 0.5 ** 2 * 0.225 / 2 + WHEELS),
    (dict(time=0.1, gyro_used=False), 0.3 ** 2 * 0.225 ** 2 / 0.1 + SLIP,
     0.4 ** 2 * 0.4 ** 2 / 0.25 + 0.5 ** 2 * 0.225 ** 2 / 0.1 + WHEELS),
    (dict(gyro_used=False, reported=(0.6, 0.7)), 0.6 + SLIP, 0.7 + WHEELS)])
def test_the_displacement_is_reduced_by_the_slip_and_the_variances_cover_all_errors(options, forward, turn):
    message = measure(**options)
    twist, covariance = message.twist, list(message.covariance)
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == pytest.approx((0.9 * 0.25, -0.9 * 0.1, 0.5))
    left = forward if options.get('case') == 'carried' else (0.07 * 0.09) ** 2
    assert covariance[::7] == pytest.approx([GOOD + forward, GOOD + left, 1e6, 1e6, 1e6, GOOD + turn])
    assert covariance == diagonal(*covariance[::7])


def test_without_an_estimate_before_the_velocity_is_unknown():
    message = measure(time=0.0)
    assert (message.twist, list(message.covariance)) == (TwistWithCovariance().twist, diagonal(*[1e6] * 6))
    assert estimate_twist(SimpleNamespace(estimate=None, filter=None), None) == message
