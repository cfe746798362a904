"""The filter: its sums are right, and nothing that comes in can spoil them."""
import os
from math import cos, inf, nan, pi, sin

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.units import SECOND
from rbx1_nav.model.kinematics import ORIGIN, Pose, arc
from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.filter import (BIAS, BIAS_WALK, ROUNDING, SCALE, STRAIGHT, TURNING, X, Y, YAW, Filter, priors)
from rbx1_nav.estimation.inputs import Imu, Odom, RejectedMessage
from rbx1_nav.model.surfaces import load_surface

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'surfaces')
PRIORS = priors(load_surface('low_ply_carpet', FOLDER))
STEP = SECOND // 50
VARIANCES = (1e-6, 1e-6, 1e-6)      # of a pose, m^2 and rad^2

angles = st.floats(-3, 3)
small = st.floats(-0.1, 0.1)
variances = st.floats(1e-9, 1e-3)


# the arithmetic

def moved(state, wheels, gyro, forward, left, variance):
    """A filter whose state is given, one step of 0.02 s later."""
    ekf = Filter(PRIORS, ORIGIN)
    ekf.state = list(state)
    ekf.covariance = numpy.diag([1e-6] * 8)
    turn = ekf.turn(0.02, wheels, gyro)
    ekf.move(0.02, turn, 0.1, forward, left, variance)
    return ekf


@given(st.tuples(small, small, angles, small, small, small, small, small), small, variances, small, small,
       st.sampled_from(['wheels', 'gyro']))
def test_the_covariance_grows_by_the_derivatives_of_the_step(state, angle, variance, forward, left, sensor):
    sensors = [(angle, variance), None] if sensor == 'wheels' else [None, (angle, variance)]
    ekf = moved(state, *sensors, forward, left, 0.0)
    derivatives = numpy.zeros((8, 8))
    h = 1e-6
    for i in range(8):
        up, down = (moved([v + s * (j == i) for j, v in enumerate(state)], *sensors, forward, left, 0.0).state
                    for s in (h, -h))
        derivatives[:, i] = (numpy.array(up) - down) / (2 * h)
    expected = derivatives @ numpy.diag([1e-6] * 8) @ derivatives.T
    # and the noise of the turn, which moves x and y by half of what a change of heading would
    # (the robot's own heading in the middle, whatever the displacement's frame)
    made = 1 - state[STRAIGHT]
    back = forward + (state[ROUNDING] if forward or left else 0.0)
    middle = state[YAW] + (ekf.state[YAW] - state[YAW]) / 2 + 0.1
    by_turn = numpy.zeros(8)
    by_turn[:3] = (-made * (back * sin(middle) + left * cos(middle)) / 2,
                   made * (back * cos(middle) - left * sin(middle)) / 2, 1.0)
    scale = 1 - state[TURNING] if sensor == 'wheels' else 1 / (1 + state[SCALE])
    expected += numpy.outer(by_turn, by_turn) * variance * scale ** 2
    expected[BIAS, BIAS] += BIAS_WALK ** 2 * 0.02
    # central differences of third order leave 1e-10 of derivatives of about 1
    numpy.testing.assert_allclose(ekf.covariance, expected, atol=1e-12, rtol=1e-4)


@given(st.lists(st.tuples(small, small, variances, variances), min_size=1, max_size=30))
def test_the_covariance_stays_one(steps):
    ekf = Filter(PRIORS, ORIGIN)
    for turned, forward, by_wheels, by_gyro in steps:
        ekf.move(0.02, ekf.turn(0.02, (turned, by_wheels), (turned, by_gyro)), 0.0, forward, 0.0, by_wheels)
        numpy.testing.assert_allclose(ekf.covariance, ekf.covariance.T, rtol=1e-9, atol=1e-18)
        assert numpy.linalg.eigvalsh(ekf.covariance).min() > -1e-15
        assert numpy.isfinite(ekf.state).all()


@given(angles, angles, variances, variances)
def test_two_that_are_trusted_alike_meet_where_their_noise_says(by_wheels, by_gyro, wheel_noise, gyro_noise):
    exact = priors(None)
    ekf = Filter(exact, ORIGIN)
    angle, noise, *_ = ekf.turn(0.02, (by_wheels, wheel_noise), (by_gyro, gyro_noise))
    if (by_wheels - by_gyro) ** 2 > 25 * (wheel_noise + gyro_noise):
        assert (angle, noise) == (by_gyro, gyro_noise) and ekf.outliers == 1
    else:
        # inverse variances add up: the information of both
        assert 1 / noise == pytest.approx(1 / wheel_noise + 1 / gyro_noise)
        assert angle == pytest.approx((by_wheels / wheel_noise + by_gyro / gyro_noise) * noise, abs=1e-12)


def test_rounding_does_not_add_up():
    exact = priors(None)
    ekf = Filter(exact, ORIGIN)
    for _ in range(1000):
        ekf.move(0.02, ekf.turn(0.02, (0.0, 1e-12), None), 0.0, 0.004, 0.0, 1e-8)
    # the variance of one rounding, half of that of a step
    assert ekf.covariance[X, X] == pytest.approx(0.5e-8 + 1e-9, rel=1e-3)
    assert ekf.state[X] == pytest.approx(4.0)


# messages

class Robot:
    """Sends what a robot without errors would send, once in 0.02 s."""

    def __init__(self, prior=PRIORS, **options):
        self.said = []
        self.combined = CombinedOdometry(prior, SECOND, say=self.said.append, **options)
        self.now = 1000 * SECOND
        self.pose = Pose(0.0, 0.0, 0.0)

    def send(self, ticks=1, linear=0.0, angular=0.0, odom=True, imu=True, bias=0.0):
        for _ in range(ticks):
            self.now += STEP
            self.pose = arc(self.pose, linear * 0.02, angular * 0.02)
            if imu:
                self.combined.add_imu(self.now, Imu(self.now, angular + bias, 3e-6))
            if odom:
                self.combined.add_odom(self.now, self.odom(), VARIANCES)
        return self.combined.estimate

    def odom(self):
        return Odom(self.now, self.pose, 1e-6, 1e-6)


def exact(estimate, pose, abs=1e-9):
    return estimate.pose == pytest.approx(pose, abs=abs)


def test_without_errors_it_follows_exactly():
    robot = Robot(priors(None))
    robot.send(50)
    robot.send(100, 0.2, 0.5)
    robot.send(100, -0.1, -1.0)
    assert exact(robot.combined.estimate, robot.pose)


def test_it_begins_where_the_odometry_is():
    robot = Robot()
    robot.pose = Pose(3.0, -2.0, 1.0)
    assert exact(robot.send(), robot.pose)


def test_it_learns_the_bias_while_the_robot_stands():
    robot = Robot()
    robot.send(100, bias=0.01)
    state = robot.combined.filter.state
    assert state[BIAS] == pytest.approx(0.01, abs=1e-4)
    # it turned as little as the wheels say, not the 0.02 rad of the gyro
    assert abs(state[YAW]) < 1e-4


@pytest.mark.parametrize('field, value', [('x', nan), ('y', inf), ('yaw', nan), ('yaw', -inf)])
def test_odometry_that_is_no_number_is_refused(field, value):
    refused(lambda robot: (robot.odom()._replace(pose=robot.pose._replace(**{field: value})), VARIANCES),
            'pose.pose.%s' % {'x': 'position.x', 'y': 'position.y', 'yaw': 'orientation'}[field])


@pytest.mark.parametrize('value', [0.0, -1.0, nan, inf])
def test_odometry_without_a_covariance_is_refused(value):
    for index, place in enumerate((0, 7, 35)):
        refused(lambda robot: (robot.odom(), VARIANCES[:index] + (value,) + VARIANCES[index + 1:]),
                r'pose.covariance\[%d\]' % place)
    if value != 0:
        refused(lambda robot: (robot.odom()._replace(linear_variance=value), VARIANCES), r'twist.covariance\[0\]')
        refused(lambda robot: (robot.odom()._replace(angular_variance=value), VARIANCES), r'twist.covariance\[35\]')


@pytest.mark.parametrize('offset', [0, -1, -3600 * SECOND, 10 * SECOND])
def test_stamps_out_of_order_or_from_the_future_are_refused(offset):
    refused(lambda robot: (robot.odom()._replace(stamp=robot.now + offset), VARIANCES), 'header.stamp', sent=True)
    refused(lambda robot: (Imu(robot.now + offset, 0.0, 1e-6),), 'header.stamp', sent=True)


def test_a_first_stamp_of_long_ago_is_refused():
    robot = Robot()
    with pytest.raises(RejectedMessage, match='header.stamp: 0.000000000: expected none that is much older than now'):
        robot.combined.add_odom(robot.now, robot.odom()._replace(stamp=0), VARIANCES)


@pytest.mark.parametrize('rate, variance, field', [
    (nan, 1e-6, 'angular_velocity.z'), (inf, 1e-6, 'angular_velocity.z'), (0.1, 0.0, 'angular_velocity_covariance'),
    (0.1, -1.0, 'angular_velocity_covariance'), (0.1, nan, 'angular_velocity_covariance')])
def test_a_bad_reading_is_refused(rate, variance, field):
    refused(lambda robot: (Imu(robot.now, rate, variance),), field)


def refused(make, field, sent=False):
    """A message is refused by the name of its field, and leaves no trace. sent: the good one of its time came already."""
    robot, undisturbed = Robot(), Robot()
    for each in (robot, undisturbed):
        each.send(50, 0.2, 0.5)
    if not sent:
        robot.now += STEP
    message = make(robot)
    with pytest.raises(RejectedMessage, match=field + '.*expected') as error:
        (robot.combined.add_imu if isinstance(message[0], Imu) else robot.combined.add_odom)(robot.now, *message)
    assert '\n' not in str(error.value)
    if not sent:
        robot.now -= STEP
    robot.send(50, 0.2, 0.5)
    undisturbed.send(50, 0.2, 0.5)
    assert robot.combined.filter.state == undisturbed.combined.filter.state
    assert not robot.said


@given(st.lists(st.tuples(st.sampled_from(['odom', 'imu']), st.floats() | st.sampled_from([0.0, 0.001, 5.0, 5.001]),
                          st.floats() | st.sampled_from([1e-12, 1e-6, 1.0, 1e12]),
                          st.integers(-10 ** 10, 10 ** 10) | st.sampled_from([0, -STEP])), max_size=40))
def test_whatever_comes_the_state_stays_finite(messages):
    robot = Robot()
    robot.send(10)
    for kind, value, variance, offset in messages:
        robot.now += STEP
        try:
            if kind == 'odom':
                robot.combined.add_odom(robot.now, Odom(robot.now + offset, Pose(value, -value, value), variance, variance),
                                        (variance, variance, variance))
            else:
                robot.combined.add_imu(robot.now, Imu(robot.now + offset, value, variance))
        except RejectedMessage:
            pass
    estimate = robot.combined.estimate
    if estimate:
        assert numpy.isfinite(estimate.pose).all() and numpy.isfinite(estimate.covariance).all()


def test_a_sender_without_variances_of_speeds_is_used_with_those_of_its_pose():
    robot = Robot()
    robot.send(10)
    robot.now += STEP
    robot.combined.add_imu(robot.now, Imu(robot.now, 0.0, 1e-6))
    robot.combined.add_odom(robot.now, Odom(robot.now, robot.pose, 0.0, 0.0), (0.1, 0.1, 0.2))
    assert robot.combined.odom.linear_variance == 0.1 and robot.combined.odom.angular_variance == 0.2


# sensors that fall silent

def test_a_gyro_that_falls_silent_is_left_out_and_taken_back():
    robot = Robot(priors(None))
    robot.send(50, 0.2, 0.5)
    robot.send(40, 0.2, 0.5, imu=False)
    behind = robot.combined.estimate
    assert not robot.said and not exact(behind, robot.pose)     # it waits: perhaps the gyro is only late
    robot.send(60, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and robot.combined.silent['imu_data']
    robot.send(60, 0.2, 0.5)
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.silent['imu_data']
    assert ['left out' in said or 'back' in said for said in robot.said] == [True, True]


def test_one_that_never_spoke_is_not_waited_for_either():
    robot = Robot(priors(None))
    robot.send(60, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and 'imu_data' in robot.said[0]


def test_one_that_is_not_used_is_not_waited_for_at_all():
    robot = Robot(priors(None), gyro_used=False)
    robot.send(2, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and not robot.said


def test_odometry_that_falls_silent_leaves_the_turn_to_the_gyro_and_is_taken_back_with_what_it_counted():
    robot = Robot(priors(None))
    robot.send(50, 0.2)
    there = robot.pose
    robot.send(100, 0.0, 0.5, odom=False)
    estimate = robot.combined.estimate
    assert robot.combined.silent['odom'] and exact(estimate, there._replace(yaw=robot.pose.yaw))
    # nobody tells the way: 0.5 m/s for 2 s
    assert estimate.covariance[X, X] > 0.9 and estimate.covariance[Y, Y] > 0.9
    robot.send(100, 0.2, 0.0, odom=False)
    robot.send(1, 0.2, 0.0)
    # the way back in is a straight line to where the wheels say; the gyro told the turn
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.silent['odom']
    assert robot.combined.estimate.covariance[X, X] < 1e-3


@pytest.mark.parametrize('odom_first', [True, False])
def test_odometry_that_comes_back_in_a_turn_finds_the_turn_of_the_gyro(odom_first):
    robot = Robot()     # its wheels slip by the 3 % that the filter expects, and it turns 0.5 rad/s
    for tick in range(300):
        robot.now += STEP
        wheels = Odom(robot.now, Pose(0.0, 0.0, 0.5 * 0.02 * tick / 0.97), 1e-6, 1e-5)
        odom = (robot.combined.add_odom, wheels, VARIANCES)
        imu = (robot.combined.add_imu, Imu(robot.now, 0.5 if tick else 0.0, 3e-6))
        for add, *message in (odom, imu) if odom_first else (imu, odom):
            if add is imu[0] or not 50 < tick < 200:
                add(robot.now, *message)
    assert robot.combined.filter.state[YAW] == pytest.approx(0.5 * 0.02 * tick, abs=1e-3)
    assert len(robot.said) == 2


def test_readings_are_not_kept_for_odometry_that_never_comes():
    robot = Robot()
    robot.send(1000, odom=False)
    assert not robot.combined.readings


def test_a_stamp_that_was_there_before_a_new_beginning_is_still_old():
    robot = Robot()
    robot.send(10)
    robot.combined.restart('test')
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
    robot.send(2)
    robot.pose = Pose(5.0, 0.0, 0.0)
    robot.send(2)
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)


def test_a_gyro_at_the_end_of_its_range_is_not_believed():
    robot = Robot()
    robot.send(100)
    limit = PRIORS.gyro_measurement_range
    for _ in range(50):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.0, 4.0 * 0.02)
        robot.combined.add_imu(robot.now, Imu(robot.now, limit, 3e-6))
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
    assert robot.combined.filter.state[YAW] == pytest.approx(4.0 * 0.97, abs=1e-3)


@pytest.mark.parametrize('lag', [1.1, 5.0])
def test_a_gyro_that_is_always_too_late_is_left_out_once(lag):
    robot = Robot(priors(None))
    for _ in range(500):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.004, 0.01)
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
        robot.combined.add_imu(robot.now, Imu(robot.now - round(lag * SECOND), 0.5, 3e-6))
    assert len(robot.said) == 1 and 'imu_data' in robot.said[0]
    assert exact(robot.combined.estimate, robot.pose)


def test_messages_may_come_in_any_order_of_sensors():
    together, apart = Robot(), Robot()
    together.send(100, 0.2, 0.5)
    odometry = []
    for _ in range(100):
        apart.now += STEP
        apart.pose = arc(apart.pose, 0.004, 0.01)
        apart.combined.add_odom(apart.now, apart.odom(), VARIANCES)
        odometry.append(apart.now)
        if len(odometry) == 10:     # the gyro is late, by 0.2 s
            for stamp in odometry:
                apart.combined.add_imu(apart.now, Imu(stamp, 0.5, 3e-6))
            odometry.clear()
    # but for the very first reading, whose begin nobody knows
    assert exact(apart.combined.estimate, together.combined.estimate.pose, abs=1e-4)


@pytest.mark.parametrize('rate', [20, 73, 100])
def test_a_gyro_at_another_rate(rate):
    robot = Robot(priors(None))
    next_reading = robot.now
    for _ in range(200):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.004, 0.01)
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
        while next_reading <= robot.now:
            robot.combined.add_imu(robot.now, Imu(next_reading, 0.5, 3e-6))
            next_reading += SECOND // rate
    behind = (robot.now - robot.combined.estimate.stamp) / SECOND
    assert 0 <= behind <= 1.1 / rate + 0.02
    expected = arc(ORIGIN, 0.2 * (4 - 0.02 - behind), 0.5 * (4 - 0.02 - behind))
    start = arc(ORIGIN, 0.004, 0.01)
    c, s = cos(start.yaw), sin(start.yaw)
    assert exact(robot.combined.estimate, Pose(start.x + c * expected.x - s * expected.y,
                                               start.y + s * expected.x + c * expected.y, start.yaw + expected.yaw))


# new beginnings

@pytest.mark.parametrize('there', [Pose(-1.0, 2.0, pi / 2), Pose(0.3, 0.0, 0.0), Pose(0.2, 0.0, 0.5)])
def test_odometry_that_jumps_or_turns_too_fast_is_a_new_beginning(there):
    robot = Robot()
    robot.send(50, 0.2)
    robot.pose = there
    assert exact(robot.send(2), there) and 'jumped' in robot.said[-1]


def test_a_single_message_from_far_away_is_a_mistake():
    robot, undisturbed = Robot(priors(None)), Robot(priors(None))
    for each in (robot, undisturbed):
        each.send(50, 0.2)
    home, robot.pose = robot.pose, Pose(-1.0, 2.0, pi / 2)
    robot.send()
    robot.pose = home
    robot.send(50, 0.2)
    undisturbed.send()
    undisturbed.send(50, 0.2)
    assert exact(robot.combined.estimate, undisturbed.combined.estimate.pose) and 'ignored' in robot.said[0]


def test_a_clock_that_goes_back_is_a_new_beginning():
    robot = Robot()
    robot.send(50, 0.2)
    robot.now, robot.pose = SECOND, ORIGIN
    assert exact(robot.send(), ORIGIN) and 'clock went back' in robot.said[0]
    robot.send(50, 0.2)
    assert robot.combined.estimate.pose.x == pytest.approx(0.2 * 0.98, rel=1e-3)
