"""Invalid odometry and gyro readings are rejected with the name of the field."""
from math import inf, nan

import pytest

from rbx1_nav.estimation.inputs import Imu, MAX_NUMBER, Odom, RejectedMessage, check, check_imu, check_odom
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.robot.readings import MIN_VARIANCE

ODOM = Odom(0, ORIGIN, 1e-6, 1e-6)
VARIANCES = (1e-6, 1e-6, 1e-6)      # variances of a pose, m^2 and rad^2

# the fields of an Odometry message in an Odom, and in the variances of its pose
POSE = {'pose.pose.position.x': 'x', 'pose.pose.position.y': 'y', 'pose.pose.orientation': 'yaw'}
SPEED = {'twist.covariance[0]': 'linear_variance', 'twist.covariance[35]': 'angular_variance'}
COVARIANCE = {'pose.covariance[0]': 0, 'pose.covariance[7]': 1, 'pose.covariance[35]': 2}

BAD_ODOMETRY = [(field, value)
                for fields, values in [(POSE, (nan, inf, -inf, 1.001 * MAX_NUMBER)),
                                       (SPEED, (-1.0, nan, inf, MIN_VARIANCE / 2)), (COVARIANCE, (0.0, -1.0, nan, inf))]
                for field in fields for value in values]
BAD_READINGS = [('angular_velocity.z', nan, 1e-6), ('angular_velocity.z', inf, 1e-6),
                ('angular_velocity_covariance[8]', 0.1, 0.0), ('angular_velocity_covariance[8]', 0.1, -1.0),
                ('angular_velocity_covariance[8]', 0.1, nan)]


def with_field(odom, variances, field, value):
    """Return the Odom and the variances of its pose, with one field of the message set to a value."""
    if field in POSE:
        return odom._replace(pose=odom.pose._replace(**{POSE[field]: value})), variances
    if field in SPEED:
        return odom._replace(**{SPEED[field]: value}), variances
    place = COVARIANCE[field]
    return odom, variances[:place] + (value,) + variances[place + 1:]


def rejection(function, *arguments):
    """Return the text of the RejectedMessage that a call raises."""
    with pytest.raises(RejectedMessage) as error:
        function(*arguments)
    assert '\n' not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize('field, value', BAD_ODOMETRY)
def test_invalid_odometry_is_rejected(field, value):
    expected = 'a number of at most 1e+06' if field in POSE else 'a variance above 0, from 1e-12 to 1e+12'
    assert rejection(check_odom, *with_field(ODOM, VARIANCES, field, value)) == (
        f'{field}: {value}: expected {expected}')


@pytest.mark.parametrize('field, rate, variance', BAD_READINGS)
def test_an_invalid_gyro_reading_is_rejected(field, rate, variance):
    text = rejection(check_imu, Imu(0, rate, variance))
    assert text.startswith(f'{field}: ') and ': expected a ' in text


def test_valid_messages_are_accepted():
    check_odom(ODOM, VARIANCES)
    check_imu(Imu(0, -0.5, MIN_VARIANCE))


@pytest.mark.parametrize('variance', [1e-12, 1e12])
@pytest.mark.parametrize('number', [1e6, -1e6])
def test_numbers_and_variances_at_their_limits_are_accepted(variance, number):
    check_odom(Odom(0, Pose(number, number, number), variance, variance), (variance,) * 3)
    check_imu(Imu(0, number, variance))


@pytest.mark.parametrize('field, value', [
    (field, value) for field in [*SPEED, *COVARIANCE] for value in (0.999e-12, 1.001e12)])
def test_variances_beyond_their_limits_are_rejected(field, value):
    assert rejection(check_odom, *with_field(ODOM, VARIANCES, field, value)).startswith(f'{field}: {value}: expected ')


def test_a_variance_of_0_of_a_speed_means_that_the_sender_does_not_give_it():
    check_odom(ODOM._replace(linear_variance=0.0, angular_variance=0.0), VARIANCES)


def test_the_text_names_field_value_and_what_is_expected():
    check('header.frame_id', "'odom'", True, 'the name of a frame')
    assert rejection(check, 'header.frame_id', "''", False, 'the name of a frame') == (
        "header.frame_id: '': expected the name of a frame")
