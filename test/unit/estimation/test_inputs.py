"""Invalid odometry and gyro readings are rejected with the name of the field."""
from math import inf, nan

import pytest

from rbx1_nav.estimation.inputs import Imu, MAX_NUMBER, Odom, RejectedMessage, check, check_imu, check_odom
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.robot.readings import MIN_VARIANCE

ODOM = Odom(0, ORIGIN)

# the fields of an Odometry message in an Odom
POSE = {'pose.pose.position.x': 'x', 'pose.pose.position.y': 'y', 'pose.pose.orientation': 'yaw'}
BAD_ODOMETRY = [(field, value) for field in POSE for value in (nan, inf, -inf, 1.001 * MAX_NUMBER)]
BAD_READINGS = [('angular_velocity.z', nan, 1e-6), ('angular_velocity.z', inf, 1e-6),
                ('angular_velocity_covariance[8]', 0.1, 0.0), ('angular_velocity_covariance[8]', 0.1, -1.0),
                ('angular_velocity_covariance[8]', 0.1, nan)]


def with_field(odom, field, value):
    """Return the Odom with one field of the message set to a value."""
    return odom._replace(pose=odom.pose._replace(**{POSE[field]: value}))


def rejection(function, *arguments):
    """Return the text of the RejectedMessage that a call raises."""
    with pytest.raises(RejectedMessage) as error:
        function(*arguments)
    assert '\n' not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize('field, value', BAD_ODOMETRY)
def test_invalid_odometry_is_rejected(field, value):
    assert rejection(check_odom, with_field(ODOM, field, value)) == (
        f'{field}: {value}: expected a number of at most 1e+06')


@pytest.mark.parametrize('field, rate, variance', BAD_READINGS)
def test_an_invalid_gyro_reading_is_rejected(field, rate, variance):
    text = rejection(check_imu, Imu(0, rate, variance))
    assert text.startswith(f'{field}: ') and ': expected a ' in text


def test_valid_messages_are_accepted():
    check_odom(ODOM)
    check_imu(Imu(0, -0.5, MIN_VARIANCE))


@pytest.mark.parametrize('variance', [1e-12, 1e12])
@pytest.mark.parametrize('number', [1e6, -1e6])
def test_numbers_and_variances_at_their_limits_are_accepted(variance, number):
    check_odom(Odom(0, Pose(number, number, number)))
    check_imu(Imu(0, number, variance))


def test_the_text_names_field_value_and_what_is_expected():
    check('header.frame_id', "'odom'", True, 'the name of a frame')
    assert rejection(check, 'header.frame_id', "''", False, 'the name of a frame') == (
        "header.frame_id: '': expected the name of a frame")
