"""Steps of the filter: which differences are summed, gaps, the noise of the wheels, and limits of the errors."""
from math import radians, sqrt

import numpy
import pytest

from rbx1_nav.estimation.filter import Filter
from rbx1_nav.estimation.model import BIAS, SCALE, STRAIGHT, TURNING, X, Y, YAW
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from sample_priors import IDEAL


def sure(prior=IDEAL):
    """Return a filter whose sensors have no errors except noise, and no random walks."""
    ekf = Filter(prior, ORIGIN)
    ekf.P.root[BIAS:] = 0.0
    return ekf


# which steps are compared

@pytest.mark.parametrize('duration, wheels, gyro, compared', [
    (1.0, 0.2, 0.199, False), (1.01, 0.1, 0.099, True), (0.1, 0.21, 0.19, True), (0.1, 0.19, 0.21, True),
    (0.1, -0.21, -0.19, True), (0.1, -0.19, -0.21, True), (0.1, -0.2, -0.2, False)])
def test_differences_are_used_after_1_second_or_a_turn_of_a_fifth_of_a_radian(duration, wheels, gyro, compared):
    ekf = Filter(IDEAL, ORIGIN)
    before = ekf.bias_sigma
    ekf.update(duration, (wheels, 1e-3), (gyro, 1e-6))
    assert (ekf.bias_sigma < before) == compared


@pytest.mark.parametrize('gyro_noise, missing, alone', [(0.9e-3, 0.0, False), (1.1e-3, 0.0, True), (1e-6, 1e-9, True)])
def test_a_step_that_is_noisier_than_the_wheels_is_compared_alone(gyro_noise, missing, alone):
    ekf, summed = Filter(IDEAL, ORIGIN), Filter(IDEAL, ORIGIN)
    for each in ekf, summed:
        each.update(0.1, (0.1, 1e-3), (0.09, 1e-6))
        before = each.bias_sigma
        each.update(0.1, (0.1, 1e-3), (0.09, gyro_noise if each is ekf else 1e-6), missing=missing * (each is ekf))
    assert summed.bias_sigma == before and (ekf.bias_sigma < before) == alone


def test_a_part_is_used_when_the_robot_comes_to_rest():
    ekf = Filter(IDEAL, ORIGIN)
    ekf.update(0.1, (0.1, 1e-3), (0.09, 1e-6))
    before = ekf.bias_sigma
    ekf.rest(0.1)
    assert ekf.bias_sigma < before
    before = ekf.bias_sigma
    ekf.rest(0.1)       # and only once
    assert ekf.bias_sigma == before


def test_after_a_part_the_next_one_begins():
    once, twice = Filter(IDEAL, ORIGIN), Filter(IDEAL, ORIGIN)
    for ekf in once, twice:
        ekf.update(1.01, (0.1, 1e-3), (0.09, 1e-6))
    before = once.bias_sigma
    twice.update(0.5, (0.1, 1e-3), (0.09, 1e-6))
    assert twice.bias_sigma == before


# gaps

@pytest.mark.parametrize('missing, by_wheels, variance', [
    # half of the wheels' variance, if they differ by nothing
    (0.1, 0.4, 0.5 * 0.002), (0.1, 0.42, 0.5 * 0.002 + 0.02 ** 2), (1e-4, 0.4, 1e-4)])
def test_the_error_of_a_gap_is_the_difference_from_the_wheels(missing, by_wheels, variance):
    turn = sure().update(0.4, (by_wheels, 0.002), (0.4, 1e-6), missing=missing)
    # both measurements add their information, the inverse of the variance
    information = 1 / 0.002 + 1 / (variance + 1e-6)
    assert turn.variance == pytest.approx(1 / information)
    assert turn.angle == pytest.approx((by_wheels / 0.002 + 0.4 / (variance + 1e-6)) / information)


def test_a_difference_that_is_no_outlier_because_of_a_gap_is_used():
    # 0.1 rad would be 5 standard deviations of a variance of 4e-4; the gap makes it 0.01 + 3e-4
    turn = sure().update(0.4, (0.4, 2e-4), (0.5, 1e-6), missing=1.0)
    assert turn.angle == pytest.approx(0.4, abs=0.1 * 2e-4 / 0.01 * 1.01)


@pytest.mark.parametrize('difference, outlier', [(0.0499, False), (0.0501, True)])
@pytest.mark.parametrize('sign', [-1, 1])
def test_wheels_that_differ_by_more_than_5_deviations_are_not_used(difference, outlier, sign):
    turn = sure().update(0.02, (0.1 + sign * difference, 0.6e-4), (0.1, 0.4e-4))
    assert (turn.angle == pytest.approx(0.1)) == outlier
    assert turn.variance == pytest.approx(0.4e-4 if outlier else 0.24e-4)


def test_without_a_sensor_the_robot_does_not_turn():
    assert Filter(IDEAL, ORIGIN).update(0.02) == (0.0, 0.0, 0.0, 0.0, 0.0)


# noise

def test_a_floor_is_as_rough_as_its_prior_even_if_the_wheels_report_less():
    for reported, used in ((1e-9, 0.084 ** 2 * 0.5 + 0.066 ** 2 * 0.3), (0.1, 0.1)):
        turn = sure(UNKNOWN_FLOOR).update(0.02, (-0.5, reported), None, 0.3)
        assert turn.angle == -0.5 and turn.variance == pytest.approx(used)


def test_the_distance_has_the_noise_of_the_wheels_or_of_the_floor():
    for reported, variance in ((1e-9, 0.044 ** 2 * 0.7), (0.1, 0.1)):
        ekf = sure(UNKNOWN_FLOOR)
        ekf.predict(0.02, ekf.update(0.02), 0.0, 0.4, -0.3, reported)
        # the distance is measured along the heading
        assert ekf.covariance[X, X] - 1e-9 == pytest.approx(variance)
        assert ekf.state[:3] == pytest.approx([0.4, -0.3, 0.0])


def test_a_floor_may_have_noise_of_the_distance_only():
    ekf = sure(IDEAL._replace(distance_noise=0.1))
    ekf.predict(0.02, ekf.update(0.02, (0.0, 1e-4), None, 1.0), 0.0, 1.0)
    assert ekf.covariance[X, X] == pytest.approx(1e-9 + 0.1 ** 2)


def test_slip_makes_the_noise_of_the_distance_smaller_with_the_distance():
    ekf = sure()
    ekf.state[STRAIGHT] = 0.25
    ekf.predict(0.02, ekf.update(0.02), 0.0, 1.0, 0.0, 0.01)
    assert ekf.state[X] == 0.75 and ekf.covariance[X, X] == pytest.approx(1e-9 + 0.01 * 0.75 ** 2)


def test_wheels_that_are_smoother_than_the_floor_in_turns_are_so_in_their_distance():
    ekf = sure(UNKNOWN_FLOOR)
    for _ in range(200):
        ekf.update(1.01, (0.3, 1e-9), (0.3, 1e-9))
    factor = ekf.noise.value
    # the differences have no noise at all: 200 squares of 0, and 5 of the expected size
    assert factor == pytest.approx(5 / 205 * (1 + 2 * sqrt(2 / 205)), rel=1e-3)
    turn = ekf.update(0.02, (0.3, 1e-9))
    assert turn.variance == pytest.approx(factor * 0.084 ** 2 * 0.3 * (1 - ekf.state[TURNING]) ** 2, rel=1e-6)
    before = ekf.covariance[X, X]
    ekf.predict(0.02, turn._replace(angle=0.0), 0.0, 0.5, 0.0, 1e-9)
    assert ekf.covariance[X, X] - before == pytest.approx(factor * 0.044 ** 2 * 0.5, rel=1e-3)


def test_wheels_that_report_more_noise_than_the_floor_are_not_smoother_than_it():
    ekf = sure(UNKNOWN_FLOOR)
    for _ in range(20):
        ekf.update(1.01, (0.3, 1e-9), (0.3, 1e-9))
    ekf.update(0.02, (0.0, 1.0), None, 0.5)
    before = ekf.covariance[X, X]
    ekf.predict(0.02, ekf.update(0.02), 0.0, 0.5, 0.0, 1e-9)
    assert ekf.covariance[X, X] - before == pytest.approx(0.044 ** 2 * 0.5, rel=1e-3)


# limits

@pytest.mark.parametrize('index', [TURNING, SCALE])
@pytest.mark.parametrize('turned', [-3.0, 3.0])
@pytest.mark.parametrize('factor', [0.01, 30.0])
def test_slip_and_scale_error_are_at_most_80_percent(index, turned, factor):
    ekf = Filter(IDEAL, ORIGIN)
    ekf.P.root[BIAS:] = 0.0
    ekf.P.root[index, index] = 100.0
    ekf.update(1.01, (turned, 1e-9), (factor * turned, 1e-9))
    assert abs(ekf.state[index]) == 0.8


def test_once_the_bias_is_known_a_difference_changes_only_the_slip():
    for known in False, True:
        ekf = Filter(UNKNOWN_FLOOR, Pose(1.0, 2.0, 3.0))
        if known:
            ekf.learn_bias(0.0, 1e-8)
        before = list(ekf.state)
        for _ in range(3):
            ekf.predict(1.01, ekf.update(1.01, (0.3, 1e-5), (0.28, 1e-5))._replace(angle=0.0))
        changed = [index for index, (old, new) in enumerate(zip(before, ekf.state)) if abs(old - new) > 1e-9]
        assert TURNING in changed and (changed == [TURNING]) == known


def test_the_slip_walks_with_the_square_root_of_turn_and_path():
    for turned in -0.1, 0.1:
        ekf = sure()
        for _ in range(200):
            ekf.predict(0.02, ekf.update(0.02, (turned, 1e-9)), 0.0, -0.003, 0.004, 0.0)
        ekf.place(ORIGIN, numpy.eye(3))     # adds the random walks
        # 0.02 after 1 rad, and after 1 m; 20 rad and 0.007 m in each step, forward and to the left
        assert sqrt(ekf.P.variance(TURNING)) == pytest.approx(0.02 * sqrt(20.0), rel=1e-3)
        assert sqrt(ekf.P.variance(STRAIGHT)) == pytest.approx(0.02 * sqrt(1.4), rel=1e-3)
        assert sqrt(ekf.P.variance(BIAS)) == pytest.approx(radians(0.0005) * sqrt(4.0), rel=1e-3)


def test_the_straight_slip_walks_to_at_most_10_percent():
    for spread, expected in ((0.0, 0.1), (0.06, 0.1), (0.2, 0.2)):
        ekf = sure()
        ekf.P.root[STRAIGHT, STRAIGHT] = spread
        for _ in range(3):
            ekf.predict(1.0, ekf.update(1.0), 0.0, 100.0)
            ekf.place(ORIGIN, numpy.eye(3))
        assert sqrt(ekf.P.variance(STRAIGHT)) == pytest.approx(expected)


def test_the_displacement_has_its_own_direction():
    ekf = sure()
    ekf.state[YAW] = 0.5
    turn = ekf.update(0.02, (0.2, 1e-9))
    ekf.predict(0.02, turn, radians(90) - 0.6, 2.0, 1.0)
    # halfway through the turn, the robot's own frame is at 0.6 rad, so the displacement is along the y axis
    assert ekf.state[:3] == pytest.approx([-1.0, 2.0, 0.7]) and ekf.covariance[Y, Y] > 0
