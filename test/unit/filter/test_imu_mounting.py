"""The turn rate comes from an IMU with any mounting, or from an IMU that sends an orientation only."""
from math import cos, inf, nan, pi, sin

from hypothesis import assume, given, strategies
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.imu_mounting import GyroInput, ImuData, multiply, turn_about, vertical_axis
from rbx1_nav.filter.input_checks import Imu, RejectedMessage

UPSIDE_DOWN = vertical_axis((1.0, 0.0, 0.0, 0.0))       # rolled by 180 degrees
VARIANCES = (1e-6, 1e-6, 1e-6)
MARGIN = 1e-9       # far above rounding


def about(axis, angle):
    """Return the rotation by an angle (rad) about 'x', 'y' or 'z'."""
    return tuple(sin(angle / 2) * (each == axis) for each in 'xyz') + (cos(angle / 2),)


angles = strategies.floats(-pi, pi)
mountings = strategies.builds(lambda roll, pitch, yaw: multiply(about('z', yaw), multiply(about('y', pitch),
                                                                                         about('x', roll))),
                              angles, angles, angles)


def data(rate=0.0, mounting=about('z', 0), variances=VARIANCES, heading=None, stamp=0, yaw_variance=1e-6):
    """Return the ImuData of an IMU on a robot that turns at a rate, with an orientation if `heading` is given."""
    axis = vertical_axis(mounting)
    orientation = None if heading is None else multiply(about('z', heading), mounting)
    return ImuData(round(stamp * SECOND), tuple(rate * share for share in axis), variances, orientation, yaw_variance)


def orientations_only(*messages):
    """Return the Imus that a GyroInput makes of ImuDatas without an angular velocity."""
    gyro, read = GyroInput(), []
    for message, vertical in messages:
        message = message._replace(rates=None)
        read.append(gyro.read(message, vertical))
        gyro.accepted(message)
    return read


def test_the_axes_are_weighted_by_what_they_measure_and_their_noise():
    # the rates are 2, 3 and -1 rad/s
    imu = GyroInput().read(ImuData(7, (0.8, 1.44, -0.77), (0.01, 0.04, 0.09), None, nan), (0.4, 0.48, 0.77))
    x, y, z = 0.4 ** 2 / 0.01, 0.48 ** 2 / 0.04, 0.77 ** 2 / 0.09
    assert imu == Imu(7, pytest.approx((2.0 * x + 3.0 * y - 1.0 * z) / (x + y + z)), pytest.approx(1 / (x + y + z)))
    # an axis without a variance is left out
    imu = GyroInput().read(ImuData(7, (0.8, 9.0, -0.77), (0.01, 0.0, 0.09), None, nan), (0.4, 0.48, 0.77))
    assert imu == Imu(7, pytest.approx((2.0 * x - 1.0 * z) / (x + z)), pytest.approx(1 / (x + z)))


def test_without_a_mounting_the_z_axis_is_used_unchanged():
    message = ImuData(7, (nan, inf, 0.1), (nan, -1.0, 0.3), None, nan)
    assert GyroInput().read(message) == Imu(7, 0.1, 0.3)


@pytest.mark.parametrize('vertical, field, rates, variances', [
    ((0.0, 0.0, 1.0), 'angular_velocity.z', (0, 0, nan), VARIANCES),
    (UPSIDE_DOWN, 'angular_velocity.z', (0, 0, inf), VARIANCES),
    ((0.0, 1.0, 0.0), 'angular_velocity.y', (0, 1e7, 0), VARIANCES),
    ((0.0, 1.0, 0.0), 'angular_velocity_covariance[4]', (0, 0, 0), (1, -1.0, 1)),
    ((0.0, 0.0, 1.0), 'angular_velocity_covariance[8]', (0, 0, 0), (1, 1, inf))])
def test_invalid_rates_are_rejected_by_the_axis_that_measures(vertical, field, rates, variances):
    with pytest.raises(RejectedMessage, match=field.replace('[', r'\[')):
        GyroInput().read(ImuData(0, rates, variances, None, 1.0), vertical)


def test_rates_without_a_covariance_get_the_one_of_robot_pose_ekf():
    notes = []
    gyro = GyroInput(notes.append)
    for _ in range(3):
        assert gyro.read(data(0.5, variances=(0.0, 0.0, 0.0))) == Imu(0, 0.5, 0.00017 ** 2)
    assert notes == ['no angular velocity covariance: assuming 0.00017 rad/s']


@given(mountings, angles, strategies.floats(-3, 3), strategies.floats(0.001, 1.0))
def test_without_an_angular_velocity_the_rate_is_the_change_of_the_orientation(mounting, heading, rate, duration):
    vertical = vertical_axis(mounting)
    first, second = orientations_only(
        (data(mounting=mounting, heading=heading), vertical),
        (data(mounting=mounting, heading=heading + rate * duration, stamp=duration), vertical))
    assert first.rate == 0.0
    # stamps are rounded to 1 ns
    assert second.rate == pytest.approx(rate, rel=1e-5, abs=1e-6)
    assert second.variance == 1e-6 and second.is_mean


def test_rates_of_0_without_a_covariance_are_no_angular_velocity_until_one_is_measured():
    gyro = GyroInput()
    zero = (0.0, 0.0, 0.0)
    gyro.accepted(data(variances=zero, heading=0.0))
    assert gyro.read(data(variances=zero, heading=0.1, stamp=0.1)).rate == pytest.approx(1.0)
    gyro.accepted(data(0.5, variances=zero, heading=0.1, stamp=0.1))
    assert gyro.read(data(variances=zero, heading=0.2, stamp=0.2)).rate == 0.0


def test_after_rates_an_orientation_is_rejected():
    gyro = GyroInput()
    gyro.accepted(data(0.5, heading=0.0))
    expected = r'^angular_velocity_covariance\[0\]: -1: expected an angular velocity, as before'
    with pytest.raises(RejectedMessage, match=expected):
        gyro.read(data(heading=0.1, stamp=0.1)._replace(rates=None))


def test_notes_about_the_orientation_are_logged_once():
    notes = []
    gyro = GyroInput(notes.append)
    assumed, used = ('no orientation covariance: assuming 0.00017 rad',
                     'no angular velocity: using the change in orientation instead')
    for number, noted in enumerate([[assumed], [assumed], [assumed, used], [assumed, used]]):
        # it turns from the third message on
        message = data(heading=0.1 * max(0, number - 1), stamp=number, yaw_variance=0.0)._replace(rates=None)
        assert gyro.read(message).variance == 0.00017 ** 2
        gyro.accepted(message)
        assert notes == noted


@pytest.mark.parametrize('variance', [-1.0, nan, inf])
def test_an_invalid_covariance_of_the_orientation_is_rejected(variance):
    with pytest.raises(RejectedMessage, match=r'orientation_covariance\[8\]'):
        orientations_only((data(heading=0.0, yaw_variance=variance), (0.0, 0.0, 1.0)))


def test_a_rejected_reading_and_one_from_the_past_change_nothing():
    gyro = GyroInput()
    gyro.accepted(data(heading=0.0)._replace(rates=None))
    gyro.read(data(heading=1.0, stamp=1e6)._replace(rates=None))      # the filter rejects its stamp
    assert gyro.read(data(heading=0.2, stamp=0.1)._replace(rates=None)).rate == pytest.approx(2.0)
    for stamp in -1.0, 0.0:
        assert gyro.read(data(heading=0.2, stamp=stamp)._replace(rates=None)).rate == 0.0


@given(angles, angles)
def test_a_turn_is_the_shorter_way(before, after):
    turn = (after - before + pi) % (2 * pi) - pi
    assume(abs(turn) < pi - 1e-6)
    assert turn_about((0.0, 0.0, 1.0), about('z', before), about('z', after)) == pytest.approx(turn, abs=MARGIN)


def test_rotations_are_multiplied_by_hamiltons_rules():
    # 24 i + 48 j + 48 k - 6
    assert multiply((1, 2, 3, 4), (5, 6, 7, 8)) == (24, 48, 48, -6)
