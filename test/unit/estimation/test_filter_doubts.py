"""The heading becomes uncertain by a contradiction, certain again by agreement, and an agreement limits the scale."""
from math import exp, sqrt

import numpy
import pytest

from rbx1_nav.estimation.filter import Filter
from rbx1_nav.estimation.model import SCALE, STRAIGHT, TURNING, YAW
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR
from rbx1_nav.robot.kinematics import ORIGIN
from sample_priors import IDEAL


def compared(*turns, prior=UNKNOWN_FLOOR):
    """Return a filter whose wheels and gyro have turned by (wheels, gyro) in each of some parts, rad."""
    ekf = Filter(prior, ORIGIN)
    ekf.learn_bias(0.0, 1e-12)
    for wheels, gyro in turns:
        ekf.agreement.add(wheels, gyro, 1e-9, 0.0, 0.1)
    return ekf


def heading_doubt(ekf):
    """Return the deviation of the heading because of contradictions; the heading itself is certain to 0.03 mrad."""
    return sqrt(ekf.covariance[YAW, YAW] - 1e-9)


@pytest.mark.parametrize('sign', [-1, 1])
def test_a_contradiction_makes_the_heading_uncertain_by_the_difference(sign):
    ekf = compared((sign * 3.0, sign * -1.0))
    assert ekf.doubt_heading() == pytest.approx(4.0) and heading_doubt(ekf) == pytest.approx(4.0)
    # a new comparison begins
    assert ekf.doubt_heading() == 0.0 and heading_doubt(ekf) == pytest.approx(4.0)


def test_contradictions_add_up():
    ekf = compared((3.0, -1.0))
    ekf.doubt_heading()
    ekf.agreement.add(2.0, -1.0, 1e-9, 0.0, 0.1)
    ekf.doubt_heading()
    assert heading_doubt(ekf) == pytest.approx(7.0)


def test_wheels_that_agree_leave_the_heading_certain():
    ekf = compared((3.0, 3.1))
    assert ekf.doubt_heading() == 0.0 and heading_doubt(ekf) == pytest.approx(0.0, abs=1e-6)


def test_a_doubt_that_the_slip_explains_decays_with_the_turn_in_which_the_sensors_agree():
    ekf = compared((4.0, 2.0))
    ekf.doubt_heading()
    ekf.state[TURNING] = 0.5        # has been learned, and explains the contradiction
    doubt = 2.0
    for gyro in 0.25, 0.5, -0.25:
        ekf.agreement.add(2 * gyro, gyro, 1e-9, 0.0, 0.1)
        assert ekf.doubt_heading() == 0.0
        # by a factor e in half a radian
        doubt *= exp(-abs(gyro) / 0.5)
        assert heading_doubt(ekf) == pytest.approx(doubt, rel=1e-4)


def test_a_doubt_that_the_slip_does_not_explain_remains():
    ekf = compared((4.0, 0.0))
    ekf.doubt_heading()
    for _ in range(20):     # the gyro was stuck, and measures turns again
        ekf.agreement.add(0.3, 0.3, 1e-9, 0.0, 0.1)
        ekf.doubt_heading()
    assert heading_doubt(ekf) == pytest.approx(4.0)


def test_the_unexplained_part_of_a_doubt_remains():
    ekf = compared((4.0, 2.0))
    ekf.doubt_heading()
    ekf.state[TURNING] = 0.4        # 2.4 rad of 4 rad: 0.4 rad more than the gyro
    for _ in range(5):
        ekf.agreement.add(0.5, 0.3, 1e-9, 0.0, 0.1)
        ekf.doubt_heading()
    assert heading_doubt(ekf) == pytest.approx(0.4)


def test_wheels_and_gyro_that_still_differ_leave_the_doubt():
    ekf = compared((4.0, 2.0))
    ekf.doubt_heading()
    ekf.agreement.add(0.5, 0.0, 1e-9, 0.0, 0.1)
    assert ekf.doubt_heading() == 0.0 and heading_doubt(ekf) == pytest.approx(2.0)


def test_a_contradiction_counts_in_steps_after_it():
    ekf = compared((3.0, -1.0))
    ekf.doubt_heading()
    ekf.predict(0.1, ekf.update(0.1), 0.0, 0.5)
    # the robot has driven in a direction that is uncertain by 4 rad, to first order
    assert ekf.covariance[1, 1] == pytest.approx((4.0 * 0.5) ** 2, rel=1e-6)


# another floor

def test_another_floor_makes_the_distance_uncertain():
    prior = IDEAL._replace(slip_turning_spread=0.001)
    ekf = compared((3.0, 2.5), prior=prior)
    assert ekf.doubt_heading() == 0.0 and ekf.doubt_floor()
    assert ekf.P.variance(STRAIGHT) == pytest.approx(0.02 ** 2 + 0.05 ** 2)


def test_the_assumed_floor_changes_nothing():
    for turns, contradicted in (((3.0, 3.0),), False), (((3.0, -1.0),), True):
        ekf = compared(*turns, prior=IDEAL)
        assert bool(ekf.doubt_heading()) == contradicted
        if contradicted:
            ekf.agreement.add(3.0, 2.5, 1e-9, 0.0, 0.1)
        assert not ekf.doubt_floor() and ekf.P.variance(STRAIGHT) == pytest.approx(0.02 ** 2)


# the scale error

@pytest.mark.parametrize('differ, sigma', [
    (0.02, 0.008), (-0.02, 0.008), (0.001, 0.003), (0.0, 0.003), (0.036, 0.0144), (0.05, 0.015)])
def test_a_scale_error_is_at_most_4_tenths_of_the_difference_of_wheels_and_gyro(differ, sigma):
    # a fraction of the greater turn
    ekf = compared((2.0 * (1 - max(differ, 0.0)), 2.0 * (1 + min(differ, 0.0))))
    ekf.state[SCALE] = 0.01
    assert ekf.doubt_heading() == 0.0
    assert sqrt(ekf.P.variance(SCALE)) == pytest.approx(sigma, rel=1e-3)
    # like the mean of the scale error and a measurement of 0, by their variances
    assert ekf.state[SCALE] == pytest.approx(0.01 * sigma ** 2 / 0.015 ** 2, rel=1e-3)


def test_a_short_turn_does_not_limit_the_scale_error():
    ekf = compared((1.4, 1.4))
    ekf.doubt_heading()
    assert sqrt(ekf.P.variance(SCALE)) == pytest.approx(0.015)


def test_nor_does_a_turn_with_a_bias_that_is_uncertain():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 0.01 ** 2)
    ekf.agreement.add(2.0, 2.0, 1e-9, 0.0, 6.0)     # 0.06 rad in 2 rad, of which 4 tenths are 0.012
    ekf.doubt_heading()
    # the bias is more certain by 0.2 %, because it was known to be at most 10 degrees/s
    assert sqrt(ekf.P.variance(SCALE)) == pytest.approx(0.012, rel=3e-3)


def test_a_new_pose_ends_doubts_and_their_explanation():
    ekf = compared((4.0, 2.0))
    ekf.doubt_heading()
    ekf.place(ORIGIN, 1e-9 * numpy.eye(3))
    assert heading_doubt(ekf) == pytest.approx(0.0, abs=1e-6)
    ekf.agreement.add(3.0, 0.0, 1e-9, 0.0, 0.1)
    assert ekf.doubt_heading() == pytest.approx(3.0) and heading_doubt(ekf) == pytest.approx(3.0)
    ekf.state[TURNING] = 0.75
    ekf.agreement.add(1.0, 0.25, 1e-9, 0.0, 0.1)
    ekf.doubt_heading()
    # 3 rad of the wheels would be 0.75 rad; turns from before the new pose do not count
    assert heading_doubt(ekf) == pytest.approx(3.0 * exp(-0.5), rel=1e-3)
