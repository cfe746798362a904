"""The bias that is learned at rest, its drift, and a robot that is carried make the filter as uncertain as they are."""
from math import radians, sqrt

import numpy
import pytest

from rbx1_nav.estimation.filter import Filter
from rbx1_nav.estimation.model import BIAS, SCALE, STRAIGHT, TURNING, X, Y, YAW
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from sample_priors import IDEAL

FIRST = 1e-6        # rad^2/s^2: variance of the first bias


def rested(rate=0.0, variance=FIRST):
    """Return a filter that has learned its first bias."""
    ekf = Filter(IDEAL, ORIGIN, 10.0)
    ekf.learn_bias(rate, variance)
    return ekf


def test_the_first_bias_is_the_rate_at_rest():
    ekf = rested(0.02)
    # it was uncertain by 10 rad/s
    assert ekf.bias == ekf.state[BIAS] == pytest.approx(0.02, rel=1e-6) and ekf.bias_known
    assert ekf.bias_sigma == pytest.approx(1e-3, rel=1e-6) and ekf.state[YAW] == 0.0


def test_a_second_measurement_of_the_bias_is_averaged_by_the_variances():
    ekf = rested(0.02)
    ekf.rest(0.5)
    ekf.learn_bias(0.023, 2e-6)
    assert ekf.bias == pytest.approx(0.021) and ekf.bias_sigma ** 2 == pytest.approx(1 / (1e6 + 0.5e6), rel=1e-5)


def test_a_bias_at_rest_walks_by_3_hundredths_of_a_degree_per_second_in_an_hour():
    for move in Filter.rest, lambda ekf, time: ekf.predict(time, ekf.update(time)):
        ekf = rested()
        for _ in range(60):
            move(ekf, 60.0)
        # random walks are added now and then: when the pose is set, for example
        ekf.place(ORIGIN, numpy.eye(3))
        assert sqrt(ekf.P.variance(BIAS) - FIRST) == pytest.approx(radians(0.03), rel=1e-3)
        assert [ekf.P.variance(index) for index in (TURNING, SCALE)] == pytest.approx([0.05 ** 2, 0.003 ** 2])


@pytest.mark.parametrize('time, learned', [(1.0, False), (1.01, True)])
def test_a_drift_is_learned_from_standstills_more_than_1_second_apart(time, learned):
    ekf = rested()
    ekf.predict(time, ekf.update(time))
    ekf.learn_bias(0.1, FIRST)
    assert (ekf.bias_drift.value > 0) == learned


def test_no_drift_is_learned_from_the_first_standstill():
    ekf = Filter(IDEAL, ORIGIN)
    ekf.rest(5.0)
    ekf.learn_bias(0.1, FIRST)
    assert ekf.bias_drift.value == 0.0


def test_a_drifting_bias_makes_bias_and_heading_uncertain_until_the_next_standstill():
    ekf = rested()
    ekf.predict(4.0, ekf.update(4.0))
    ekf.rest(6.0)
    ekf.learn_bias(0.1, FIRST)
    # the expected square without a drift is the variance of the bias and the variance of the measurement; 1 sigma of
    # this noise is subtracted
    drift = (0.1 ** 2 - (2 + 2 * sqrt(2)) * FIRST) / 10.0 ** 2
    assert ekf.bias_drift.value == pytest.approx(drift, rel=1e-4)
    assert ekf.bias_sigma ** 2 == pytest.approx(FIRST, rel=1e-3) and ekf.bias == pytest.approx(0.1, rel=1e-3)
    before = ekf.covariance[YAW, YAW]
    for _ in range(2):
        ekf.predict(3.0, ekf.update(3.0, None, (0.3, 1e-6)))
    # after 6 s
    assert ekf.bias_sigma ** 2 == pytest.approx(FIRST + drift * 6.0 ** 2, rel=1e-3)
    # the bias of the second half is wrong by 3 s of drift; at the beginning of the first half it was right
    assert ekf.covariance[YAW, YAW] - before == pytest.approx(
        2e-6 + FIRST * 6.0 ** 2 + drift * (3.0 * 3.0) ** 2, rel=1e-3)
    # the next standstill does not forget the heading
    uncertain = ekf.covariance[YAW, YAW]
    ekf.learn_bias(0.1, FIRST)
    assert ekf.bias_sigma ** 2 < 1.01 * FIRST
    # the bias has not changed after all, so it was not wrong in the turn
    assert ekf.covariance[YAW, YAW] < uncertain and not ekf.P.drift.any()


def test_a_rate_that_may_be_the_bias_makes_it_as_uncertain_as_the_difference():
    for rate in 0.05, -0.01:
        ekf = rested(0.02)
        ekf.doubt_bias(rate)
        assert ekf.bias == pytest.approx(0.02)
        assert ekf.bias_sigma ** 2 == pytest.approx(FIRST + 0.03 ** 2, rel=1e-4)


# carried

def test_a_robot_that_is_carried_is_as_uncertain_as_it_was_turned_and_moved_in_all():
    ekf = Filter(IDEAL, Pose(1.0, 2.0, 3.0))
    for angle, duration in (0.5, 1.0), (-0.7, 1.0), (0.3, 2.0):
        ekf.carry(angle, duration)
    assert ekf.state[:3] == pytest.approx([1.0, 2.0, 3.1])
    # 1.5 rad, and 0.5 m/s for 4 s
    assert ekf.covariance == pytest.approx(numpy.diag([2.0 ** 2, 2.0 ** 2, 1.5 ** 2]), rel=1e-6)


def test_a_new_pose_begins_another_carrying():
    ekf = Filter(IDEAL, ORIGIN)
    ekf.carry(1.0, 2.0)
    ekf.place(ORIGIN, 1e-9 * numpy.eye(3))
    ekf.carry(1.0, 2.0)
    assert ekf.covariance == pytest.approx(numpy.diag([1.0, 1.0, 1.0]), rel=1e-6)


def test_no_pose_is_certain():
    ekf = Filter(IDEAL, ORIGIN)
    ekf.place(Pose(1.0, 2.0, 3.0), numpy.zeros((3, 3)))
    assert ekf.state[:3] == [1.0, 2.0, 3.0] and ekf.covariance == pytest.approx(1e-9 * numpy.eye(3))
    assert [ekf.P.variance(index) for index in (X, Y, STRAIGHT)] == pytest.approx([1e-9, 1e-9, 0.02 ** 2])
