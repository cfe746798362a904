"""The filter calculates derivatives, covariances and means correctly."""
from math import cos, pi, sin, sqrt
from unittest.mock import patch

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.estimation.filter import SLIP_WALK, Filter
from rbx1_nav.estimation.model import BIAS, SCALE, STRAIGHT, TURNING, X, YAW
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from sample_priors import IDEAL, PRIORS

angles = st.floats(-3, 3)
small = st.floats(-0.1, 0.1)
variances = st.floats(1e-9, 1e-3)
LONG = 2.0      # s: a step of this length is compared by itself
any_variance = st.floats(-12, 12).map(lambda exponent: 10 ** exponent)
durations = st.floats(-3, 7).map(lambda exponent: 10 ** exponent)


def with_state(state, prior=PRIORS):
    """Return a filter with this state, and an uncertainty of 1 mm, 1 mrad, ..."""
    ekf = Filter(prior, ORIGIN)
    ekf.state = list(state)
    ekf.P.root[:, :7] = 1e-3 * numpy.eye(7)
    return ekf


def whole_covariance(ekf):
    """Return the covariance of the whole state."""
    return ekf.P.root @ ekf.P.root.T


def after_step(state, wheels, gyro, forward, left, variance):
    """Return a filter, one step of 0.02 s after it had this state."""
    ekf = with_state(state, IDEAL)
    turn = ekf.update(0.02, wheels, gyro)
    ekf.predict(0.02, turn, 0.1, forward, left, variance)
    return ekf


@given(st.tuples(small, small, angles, small, small, small, small), small, variances, small, small,
       st.sampled_from(['wheels', 'gyro']))
def test_the_covariance_follows_from_the_derivatives_of_a_step(state, angle, variance, forward, left, sensor):
    sensors = [(angle, variance), None] if sensor == 'wheels' else [None, (angle, variance)]
    ekf = after_step(state, *sensors, forward, left, 0.0)
    derivatives = numpy.zeros((7, 7))
    h = 1e-6
    for i in range(7):
        up, down = (after_step([v + s * (j == i) for j, v in enumerate(state)], *sensors, forward, left, 0.0).state
                    for s in (h, -h))
        derivatives[:, i] = (numpy.array(up) - down) / (2 * h)
    expected = derivatives @ (1e-6 * numpy.eye(7)) @ derivatives.T
    # and the noise of the turn, which moves x and y by half as much as a change of the heading does
    # (the robot's own heading halfway through the turn, whatever the frame of the displacement)
    grip = 1 - state[STRAIGHT]
    middle = state[YAW] + (ekf.state[YAW] - state[YAW]) / 2 + 0.1
    by_turn = numpy.zeros(7)
    by_turn[:3] = (-grip * (forward * sin(middle) + left * cos(middle)) / 2,
                   grip * (forward * cos(middle) - left * sin(middle)) / 2, 1.0)
    scale = 1 - state[TURNING] if sensor == 'wheels' else 1 / (1 + state[SCALE])
    expected += numpy.outer(by_turn, by_turn) * variance * scale ** 2
    # central differences have an error of 1e-10 where the derivatives are about 1
    numpy.testing.assert_allclose(whole_covariance(ekf), expected, atol=1e-12, rtol=1e-4)
    numpy.testing.assert_allclose(ekf.covariance, expected[:3, :3], atol=1e-12, rtol=1e-4)


@given(st.tuples(small, small, angles, small, small, small, small), angles, variances, variances)
def test_a_comparison_changes_state_and_covariance_as_in_the_textbook(state, turned, wheel_noise, gyro_noise):
    ekf = with_state(state, IDEAL)
    grip, scale = 1 - state[TURNING], 1 + state[SCALE]
    gyro = (turned * grip + 1e-4) * scale + state[BIAS] * LONG     # differs by 1e-4 rad
    ekf.update(LONG, (turned, wheel_noise), (gyro, gyro_noise))
    row = numpy.zeros(7)
    row[BIAS] = LONG / scale
    if turned:      # stationary wheels give no information about slip and scale
        row[SCALE], row[TURNING] = (turned * grip + 1e-4) / scale, -(turned * grip + 1e-4) / grip
    before = 1e-6 * numpy.eye(7)
    gain = before @ row / (row @ before @ row + wheel_noise * grip ** 2 + gyro_noise / scale ** 2)
    numpy.testing.assert_allclose(ekf.state, numpy.array(state) + 1e-4 * gain, atol=1e-9)
    numpy.testing.assert_allclose(whole_covariance(ekf), before - numpy.outer(gain, row @ before), atol=1e-15)


@given(angles, st.tuples(small, small, small), variances, variances)
def test_a_step_with_both_sensors_is_as_certain_as_the_least_squares_of_both(turned, errors, wheel_noise, gyro_noise):
    bias, scale_error, slip = errors
    grip, scale = 1 - slip, 1 + scale_error
    duration = 1.01         # long enough to be compared at once
    ekf = with_state([0.0, 0.0, 0.0, bias, scale_error, slip, 0.0], IDEAL)
    turn = ekf.update(duration, (turned / grip, wheel_noise), (turned * scale + bias * duration, gyro_noise))
    ekf.predict(duration, turn)
    assert ekf.state[YAW] == pytest.approx(turned, abs=1e-9)
    # derivatives of both measurements with respect to the turn, the bias, the scale error and the slip. Least squares
    # adds the information, the inverse of the covariance; there is no prior information about the turn
    by_wheels = numpy.array([1.0, 0.0, 0.0, turned / grip])
    by_gyro = numpy.array([1.0, duration / scale, turned / scale, 0.0])
    information = (numpy.diag([0.0, 1e6, 1e6, 1e6]) + numpy.outer(by_wheels, by_wheels) / (wheel_noise * grip ** 2)
                   + numpy.outer(by_gyro, by_gyro) / (gyro_noise / scale ** 2))
    # and the variance of the previous yaw
    expected = numpy.linalg.inv(information) + numpy.diag([1e-6, 0.0, 0.0, 0.0])
    which = [YAW, BIAS, SCALE, TURNING]
    # rounding errors of the inverse, whose elements are at most 1e-3, at a condition number of up to 1e6
    numpy.testing.assert_allclose(whole_covariance(ekf)[numpy.ix_(which, which)], expected, atol=1e-12, rtol=1e-6)


@pytest.mark.parametrize('count', [2, 5, 20])
def test_short_steps_are_compared_by_their_sum(count):
    whole, parts = with_state([0.0] * 7), with_state([0.0] * 7)
    whole.update(1.01, (0.19, 1e-3), (0.18, 1e-6))
    for _ in range(count):
        assert parts.state == [0.0] * 7
        parts.update(1.01 / count, (0.19 / count, 1e-3 / count), (0.18 / count, 1e-6 / count))
    numpy.testing.assert_allclose(parts.state, whole.state, atol=1e-12)
    numpy.testing.assert_allclose(whole_covariance(parts), whole_covariance(whole), atol=1e-15)


@pytest.mark.parametrize('rate', [0.2, 0.5, 1.0, 1.5])
def test_a_rounded_turn_of_the_wheels_is_no_slip(rate):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    steps, degree = round(3 / rate * 30), pi / 180
    counted = [round(rate * step / 30 / degree) for step in range(steps + 1)]
    for before, after in zip(counted, counted[1:]):
        wheels = (after - before) * degree
        # a Create's variance: two rounding errors, and the floor's noise in the counted turn
        ekf.update(1 / 30, (wheels, degree ** 2 / 6 + 0.09 ** 2 * wheels), (rate / 30, 5e-8))
    # compared with an initial uncertainty of 0.05
    assert abs(ekf.state[TURNING]) < 0.01


def test_a_gap_in_which_the_rate_was_steady_is_measured_by_wheels_and_gyro():
    ekf = with_state([0.0] * 7)
    turn = ekf.update(0.4, (0.4, 0.002), (0.4, 1e-6), missing=0.1)
    assert turn.angle == pytest.approx(0.4) and 0.0005 < turn.variance < 0.001


def test_a_gap_in_which_the_rate_changed_is_measured_by_the_wheels():
    ekf = with_state([0.0] * 7)
    turn = ekf.update(0.4, (0.1, 0.002), (0.4, 1e-6), missing=0.1)
    # the weight of the gyro is at most the weight of a turn whose error is the difference
    assert turn.angle - 0.1 < 0.3 * 0.002 / 0.3 ** 2 and 0.0015 < turn.variance < 0.002


def test_without_wheels_a_gap_is_uncertain():
    ekf = with_state([0.0] * 7)
    turn = ekf.update(0.4, None, (0.4, 1e-6), missing=0.1)
    assert turn.angle == pytest.approx(0.4) and turn.variance == pytest.approx(0.1 + 1e-6)


def test_slip_and_bias_walk():
    ekf = with_state([0.0] * 7)
    for _ in range(1000):
        ekf.predict(0.02, ekf.update(0.02, (0.01, 1e-6)), 0.0, 0.004, 0.0, 1e-8)
    grown = numpy.diagonal(whole_covariance(ekf)) - 1e-6
    # 4 m and 10 rad, except for the last steps
    assert grown[STRAIGHT] == pytest.approx(4 * SLIP_WALK ** 2, rel=0.05)
    assert grown[TURNING] == pytest.approx(10 * SLIP_WALK ** 2, rel=0.05)
    assert 0 < grown[BIAS] < 1e-6


@given(st.floats(0.01, 3), st.floats(0.01, 3), st.integers(1, 50))
def test_the_noise_of_a_floor_does_not_depend_on_the_step(turned, travelled, count):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.P.root[TURNING] = 0.0
    with patch('rbx1_nav.estimation.filter.SLIP_WALK', 0.0):
        for _ in range(count):
            ekf.predict(0.0, ekf.update(0.0, (turned / count, 1e-12), travelled=travelled / count))
    assert ekf.covariance[YAW, YAW] == pytest.approx(0.084 ** 2 * turned + 0.066 ** 2 * travelled + 1e-9)
    straight = Filter(UNKNOWN_FLOOR, ORIGIN)
    straight.P.root[STRAIGHT] = 0.0
    with patch('rbx1_nav.estimation.filter.SLIP_WALK', 0.0):
        for _ in range(count):
            straight.predict(0.0, straight.update(0.0), 0.0, travelled / count, 0.0, 1e-12)
    assert straight.covariance[X, X] == pytest.approx(0.044 ** 2 * travelled + 1e-9)


@given(st.lists(st.tuples(angles, st.floats(-1e6, 1e6), durations, any_variance, any_variance, st.integers(0, 2)),
                min_size=1, max_size=60))
def test_the_covariance_stays_symmetric_and_positive(steps):
    ekf = Filter(PRIORS, ORIGIN)
    for turned, forward, duration, wheel_variance, gyro_variance, sensors in steps:
        wheels = (turned, wheel_variance * duration ** 2) if sensors < 2 else None
        gyro = (turned * 0.9, gyro_variance * duration ** 2) if sensors > 0 else None
        ekf.predict(duration, ekf.update(duration, wheels, gyro, abs(forward)), 0.0, forward, 0.0,
                 wheel_variance * duration ** 2)
        for covariance in whole_covariance(ekf), ekf.covariance:
            numpy.testing.assert_array_equal(covariance, covariance.T)
            values = numpy.linalg.eigvalsh(covariance)
            assert values[0] >= -1e-12 * values[-1]
        assert numpy.isfinite(ekf.state).all()


@given(angles, angles, variances, variances)
def test_the_turn_is_the_mean_of_wheels_and_gyro_by_their_variances(by_wheels, by_gyro, wheel_noise, gyro_noise):
    ekf = Filter(IDEAL, ORIGIN)
    ekf.P.root[BIAS:] = 0.0       # no errors except the noise
    angle, noise, *_ = ekf.update(0.02, (by_wheels, wheel_noise), (by_gyro, gyro_noise))
    if (by_wheels - by_gyro) ** 2 > 25 * (wheel_noise + gyro_noise):
        assert (angle, noise) == (by_gyro, gyro_noise)
    else:
        # the inverse of a variance is the information, and the information of both sensors adds up
        assert 1 / noise == pytest.approx(1 / wheel_noise + 1 / gyro_noise)
        assert angle == pytest.approx((by_wheels / wheel_noise + by_gyro / gyro_noise) * noise, abs=1e-12)


def drive(prior, slip, gyro_factor=1.0, turned=6.0):
    """Return a filter after a rest and a turn with slipping wheels and a gyro that measures a multiple of the turn;
    whether it has noticed another floor; and the sum of contradictions (rad)."""
    ekf, floor, contradiction = Filter(prior, ORIGIN), False, 0.0
    for _ in range(100):
        ekf.predict(0.02, ekf.update(0.02, (0.0, 1e-9), (0.0, 1e-9)))
    for _ in range(round(turned / 0.02)):
        wheels, gyro = 0.02 / (1 - slip), 0.02 * gyro_factor
        ekf.predict(0.02, ekf.update(0.02, (wheels, 1e-8), (gyro, 1e-9)))
        if ekf.agreement.add(wheels, gyro, 1e-9, 0.0, 0.02):
            contradiction += abs(ekf.doubt_heading())
            floor = floor or ekf.doubt_floor()
    return ekf, floor, contradiction


def test_another_floor_is_noticed():
    floor = PRIORS._replace(slip_turning=0.005, slip_turning_spread=0.002, heading_noise_turning=0.0)
    same, unexpected, _ = drive(floor, 0.006)
    other, noticed, contradiction = drive(floor, 0.08)
    assert noticed and not unexpected and not contradiction
    # then its straight slip is less certain, and its turn is still the gyro's turn
    assert other.P.variance(STRAIGHT) > 2 * same.P.variance(STRAIGHT)
    assert other.state[YAW] == pytest.approx(6.0, abs=0.02)


@pytest.mark.parametrize('slip, factor', [(0.0, -1.0), (0.9, 1.0), (0.0, 1.5)])
def test_a_contradiction_makes_the_heading_as_uncertain_as_wheels_and_gyro_differ(slip, factor):
    # it is noticed after a turn of 1.5 rad, or later if the slip of a floor nearly explains the difference
    differ = abs(1 / (1 - slip) - factor) / max(1 / (1 - slip), abs(factor))
    for turned in numpy.arange(0.1, 4.0, 0.02):
        ekf, _, contradiction = drive(UNKNOWN_FLOOR, slip, factor, turned)
        if contradiction:
            break
    assert 1.4 * differ < contradiction < 4.3 * differ
    assert sqrt(ekf.covariance[YAW, YAW]) == pytest.approx(contradiction, rel=0.1)


def test_a_doubt_shrinks_when_wheels_and_gyro_agree_again():
    doubtful, _, contradiction = drive(UNKNOWN_FLOOR, 0.5, turned=1.0)
    # wheels that always slip by half agree with the gyro as soon as that is known
    later, _, same = drive(UNKNOWN_FLOOR, 0.5, turned=10.0)
    assert same == contradiction > 0.5 and sqrt(doubtful.covariance[YAW, YAW]) > 0.5
    # the minimum uncertainty of the heading: 1.5 % scale error of the gyro
    assert 0.05 < sqrt(later.covariance[YAW, YAW]) < 0.2


def test_a_contradiction_changes_neither_the_bias_nor_the_scale():
    ekf, _, contradiction = drive(UNKNOWN_FLOOR, 0.5, turned=1.0)
    before = ekf.state[BIAS], ekf.state[SCALE]
    for _ in range(300):
        ekf.predict(0.02, ekf.update(0.02, (0.04, 1e-8), (0.02, 1e-9)))
    assert contradiction and (ekf.state[BIAS], ekf.state[SCALE]) == before


def test_wheels_that_agree_with_the_gyro_leave_little_scale_error_and_little_noise():
    agree, _, _ = drive(UNKNOWN_FLOOR, 0.0, turned=10.0)
    assert sqrt(agree.covariance[YAW, YAW]) < 0.06      # 1.5 % of 10 rad would be 0.15 rad
    # a share of 0.4 of what they differ by
    assert sqrt(drive(UNKNOWN_FLOOR, 0.02, turned=10.0)[0].P.variance(SCALE)) == pytest.approx(0.4 * 0.02, rel=0.2)
    agree.place(ORIGIN, 1e-9 * numpy.eye(3))
    for _ in range(100):
        agree.predict(0.02, agree.update(0.02, (0.0, 1e-8), (0.0, 1e-9), 0.01), 0.0, 0.01)
    # after 1 m, with only the noise of an unknown floor: 0.044 m; with a slip of 5 %: 0.05 m
    noise = agree.covariance[X, X] - agree.P.variance(STRAIGHT)
    assert noise < 0.03 ** 2


def test_the_straight_slip_stays_possible_however_far_the_robot_drives():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for _ in range(2000):
        ekf.predict(1.0, ekf.update(1.0, (0.0, 1e-8), (0.0, 1e-9), 1.0), 0.0, 1.0)
    assert 0.05 < sqrt(ekf.P.variance(STRAIGHT)) < 0.11


@pytest.mark.parametrize('gyro, outlier', [(0.57, False), (0.54, True)])
def test_an_outlier_is_beyond_noise_and_errors_of_the_state_together(gyro, outlier):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-8)
    # 5 standard deviations for the noise of 1 rad: 0.42 rad; together with the slip and the scale error: 0.445 rad
    turn = ekf.update(LONG, (1.0, 1e-6), (gyro, 1e-6))
    assert (ekf.state[TURNING] == 0) == outlier and turn.angle == pytest.approx(gyro, abs=1e-3)


def test_place_leaves_no_doubt():
    ekf, _, contradiction = drive(UNKNOWN_FLOOR, 0.5, turned=2.0)
    covariance = numpy.diag([0.01, 0.02, 0.03])
    ekf.place(Pose(1.0, 2.0, 3.0), covariance)
    assert contradiction and ekf.covariance == pytest.approx(covariance)


@given(st.floats(-0.07, 0.07), st.floats(1.5, 60))
def test_no_slip_of_a_known_floor_is_a_contradiction(slip, turned):
    assert drive(UNKNOWN_FLOOR, slip, turned=turned)[1:] == (False, 0.0)
