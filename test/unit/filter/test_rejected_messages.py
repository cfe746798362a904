"""Messages that the filter rejects have no effect."""
from math import inf, nan

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.filter.input_checks import MAX_NUMBER, Imu, Odom, RejectedMessage, check_imu, check_odom
from sample_robot import STEP, Robot

# the fields of an Odometry message in an Odom
POSE = {'pose.pose.position.x': 'x', 'pose.pose.position.y': 'y', 'pose.pose.orientation': 'yaw'}
BAD_ODOMETRY = [(field, value) for field in POSE for value in (nan, inf, -inf, 1.001 * MAX_NUMBER)]
BAD_READINGS = [('angular_velocity.z', nan, 1e-6), ('angular_velocity.z', inf, 1e-6),
                ('angular_velocity_covariance[8]', 0.1, 0.0), ('angular_velocity_covariance[8]', 0.1, -1.0),
                ('angular_velocity_covariance[8]', 0.1, nan), ('angular_velocity_covariance[8]', 0.1, 1.1e12)]


def with_field(odom, field, value):
    """Return the Odom with one field of the message set to a value."""
    return odom._replace(pose=odom.pose._replace(**{POSE[field]: value}))


def check_rejected(make_message, text):
    """Check that a message is rejected with an error that contains `text`, and has no effect.

    make_message(robot): returns an Odom or an Imu.
    """
    robot, undisturbed = Robot(), Robot()
    for each in (robot, undisturbed):
        each.send(50, 0.2, 0.5)
    robot.now += STEP
    message = make_message(robot)
    add = robot.combined.add_imu if isinstance(message, Imu) else robot.combined.add_odom
    with pytest.raises(RejectedMessage) as error:
        add(robot.now, message)
    assert text in str(error.value) and ': expected a' in str(error.value) and '\n' not in str(error.value)
    robot.now -= STEP
    robot.send(50, 0.2, 0.5)
    undisturbed.send(50, 0.2, 0.5)
    assert robot.combined.filter.state == undisturbed.combined.filter.state
    assert not robot.warnings


@pytest.mark.parametrize('field, value', BAD_ODOMETRY)
def test_rejected_odometry_leaves_no_trace(field, value):
    check_rejected(lambda robot: with_field(robot.odom(), field, value), field)


@pytest.mark.parametrize('field, rate, variance', BAD_READINGS)
def test_a_rejected_gyro_reading_leaves_no_trace(field, rate, variance):
    check_rejected(lambda robot: Imu(robot.now, rate, variance), field)


def test_a_restart_does_not_make_old_stamps_acceptable():
    robot = Robot()
    robot.send(10)
    robot.combined.restart('test')
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom())
    robot.send(2)
    robot.pose = Pose(5.0, 0.0, 0.0)
    robot.send(2)
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom())


@given(st.lists(st.tuples(st.sampled_from(['odom', 'imu']), st.floats() | st.sampled_from([0.0, 0.001, 5.0, 5.001]),
                          st.floats() | st.sampled_from([1e-12, 1e-6, 1.0, 1e12]),
                          st.integers(-10 ** 10, 10 ** 10) | st.sampled_from([0, -STEP])), max_size=40))
def test_no_sequence_of_messages_makes_the_estimate_infinite(messages):
    robot = Robot()
    robot.send(10)
    for kind, value, variance, offset in messages:
        robot.now += STEP
        stamp = robot.now + offset
        try:
            if kind == 'odom':
                robot.combined.add_odom(robot.now, Odom(stamp, Pose(value, -value, value)))
            else:
                robot.combined.add_imu(robot.now, Imu(stamp, value, variance))
        except RejectedMessage:
            pass
    estimate = robot.combined.estimate
    if estimate:
        assert numpy.isfinite(estimate.pose).all() and numpy.isfinite(estimate.covariance).all()


@pytest.mark.parametrize('variance', [1e-12, 1e12])
@pytest.mark.parametrize('number', [1e6, -1e6])
def test_numbers_and_variances_at_their_limits_are_accepted(variance, number):
    check_odom(Odom(0, Pose(number, number, number)))
    check_imu(Imu(0, number, variance))
