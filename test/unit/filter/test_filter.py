"""The filter propagates its errors correctly, learns from rests and from the wheels, and never corrects the pose."""
from math import cos, exp, pi, radians, sin, sqrt
from unittest import mock

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.filter import pose_errors
from rbx1_nav.filter.filter import RARE, ROUNDING, Filter
from rbx1_nav.filter.pose_errors import (
    BIAS, BIAS_WALK, CARRY_SPEED, CURVATURE, INSTABILITY, PERIOD, SLIP, START_VARIANCE, X, Y, YAW, Yaw)
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from sample_priors import IDEAL

FLAT = IDEAL._replace(slip_turning=0.1, curvature=0.2, slip_straight=-0.05, slip_straight_spread=0.0,
                      gyro_scale_error=0.0)     # a floor without noise
steps = st.lists(st.tuples(st.floats(-1, 1), st.floats(-0.3, 0.3), st.floats(-0.1, 0.1), st.booleans()), min_size=1,
                 max_size=8)


def drive(path, pose=ORIGIN, bias=0.0, slip=0.1, curvature=0.2, scale=0.0, straight=-0.05):
    """Return x, y and yaw after steps of 0.5 s (turn, forward, left, whether the gyro measures) with these errors."""
    x, y, yaw = pose
    for turned, forward, left, by_gyro in path:
        angle = (turned - bias * 0.5) * (1 - scale) if by_gyro else turned * (1 - slip) + curvature * forward
        middle, grip = yaw + angle / 2, 1 - straight
        x += grip * (forward * cos(middle) - left * sin(middle))
        y += grip * (forward * sin(middle) + left * cos(middle))
        yaw += angle
    return numpy.array([x, y, yaw])


def follow(ekf, path):
    """Make the same steps with a Filter."""
    for turned, forward, left, by_gyro in path:
        turn = ekf.turn(0.5, (turned, 0.0), (turned, 0.0) if by_gyro else None, forward)
        ekf.step(0.5, turn, turned, forward, left)


@given(steps, st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)))
def test_the_covariance_follows_from_the_derivatives_of_the_whole_path(path, pose):
    for index, name in ((BIAS, 'bias'), (SLIP, 'slip'), (CURVATURE, 'curvature'), (None, 'scale'), (None, 'straight'),
                        (None, 'instability'), (YAW, 'yaw')):
        ekf = Filter(FLAT, Pose(*pose))
        ekf.P = [[0.0] * 6 for _ in range(6)]
        ekf.walk, sigma = 0.0, 1e-4
        if index is not None:
            ekf.P[index][index] = sigma ** 2
        elif name == 'scale':
            ekf.scale_error = sigma
        elif name == 'straight':
            ekf.prior = FLAT._replace(slip_straight_spread=sigma)
        follow(ekf, path)
        assert ekf.state == pytest.approx(drive(path, pose), abs=1e-12)
        means = dict(bias=0.0, slip=0.1, curvature=0.2, scale=0.0, straight=-0.05)

        def reached(change):
            if name == 'yaw':
                return drive(path, (*pose[:2], pose[2] + change))
            cause = 'bias' if name == 'instability' else name
            return drive(path, pose, **{cause: means[cause] + change})
        derivative = (reached(1e-5) - reached(-1e-5)) / 2e-5
        expected = sigma ** 2 * numpy.outer(derivative, derivative)
        # central differences; and an unknown heading turns the path, by the fourth power of sigma
        with mock.patch.object(pose_errors, 'INSTABILITY', sigma if name == 'instability' else 0.0):
            covariance = ekf.covariance
        numpy.testing.assert_allclose(covariance, expected, atol=1e-5 * sigma ** 2, rtol=1e-5)


def test_the_noise_of_turn_and_distance_adds_up_along_the_path():
    rng, ends = numpy.random.default_rng(1), []
    path = [(0.3, 0.2), (-0.5, 0.3), (0.2, 0.25)]
    for _ in range(20000):
        x = y = yaw = 0.0
        for angle, forward in path:
            turn, length = angle + rng.normal(0, 0.03), forward + rng.normal(0, 0.02)
            x, y, yaw = x + length * cos(yaw + turn / 2), y + length * sin(yaw + turn / 2), yaw + turn
        ends.append((x, y, yaw))
    ekf = Filter(FLAT._replace(slip_straight=0.0), ORIGIN)
    ekf.P = [[0.0] * 6 for _ in range(6)]
    for angle, forward in path:     # a distance may have at most the noise of any floor, 0.044 m after 1 m
        ekf.step(0.5, Yaw(angle, 0.03 ** 2, True), 0.0, forward, 0.0, 0.02 ** 2)
    # 1 sigma of an estimated variance is 1 %
    numpy.testing.assert_allclose(ekf.covariance, numpy.cov(numpy.transpose(ends)), atol=2e-5, rtol=0.05)


@given(st.lists(st.tuples(st.floats(-3, 3), st.floats(-1e3, 1e3), st.floats(-2, 4), st.floats(-12, 12),
                          st.integers(0, 3)), min_size=1, max_size=60))
def test_the_covariance_stays_symmetric_and_positive(path):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for turned, forward, exponent, noise, sensor in path:
        duration, gyro = 10 ** exponent, (turned, 10 ** noise)
        if sensor == 0:
            ekf.learn_bias(turned, 10 ** noise)
        turn = ekf.turn(duration, (turned, 10 ** noise), gyro if sensor < 3 else None, forward)
        ekf.step(duration, turn, turned, forward, 0.0, 10 ** noise)
        if sensor < 3:
            ekf.compare(duration, turned, gyro, forward)
        covariance = numpy.array(ekf.covariance)
        numpy.testing.assert_array_equal(covariance, covariance.T)
        values = numpy.linalg.eigvalsh(covariance)
        assert values[0] >= -1e-9 * values[-1] and numpy.isfinite(ekf.state).all()


@pytest.mark.parametrize('reported, turn, path', [
    (0.0, 0.01 + 0.002, 0.01), (0.02, 0.02, 0.02), (1e3, 0.084 ** 2 * 4 + 0.066 ** 2 * 2, 0.044 ** 2 * 16)])
def test_a_reported_variance_counts_between_the_noise_of_the_assumed_floor_and_of_any_floor(reported, turn, path):
    floor = dict(heading_noise_turning=0.05, heading_noise_straight=sqrt(0.001), distance_noise=0.05 / 2)
    ekf = Filter(UNKNOWN_FLOOR._replace(**floor, slip_straight=0.1, slip_straight_spread=0.0), Pose(0, 0, 0.6))
    assert ekf.turn(1.0, (-4.0, reported), None, -2.0).variance == pytest.approx(turn)
    ekf.P = [[0.0] * 6 for _ in range(6)]
    ekf.step(1.0, Yaw(0.0, 0.0, False), 0.0, -10.0, 6.0, reported)
    along = numpy.outer(*2 * ((cos(0.6), sin(0.6)),))
    numpy.testing.assert_allclose(numpy.array(ekf.covariance)[:2, :2], 0.9 ** 2 * path * along, rtol=1e-3)


def test_a_turn_is_measured_by_the_wheels_if_they_are_more_certain():
    ekf = Filter(FLAT, ORIGIN)
    ekf.bias = 0.01
    for wheels, limit in (0.0, ROUNDING ** 2), (-2.0, (0.05 * 2) ** 2):      # 5 % of slip
        by_wheels = ekf.turn(2.0, (wheels, 0.0), None, 0.5)
        assert by_wheels == (pytest.approx(0.9 * wheels + 0.2 * 0.5), 0.0, False)   # slip and curvature
        assert ekf.turn(2.0, (wheels, 0.0), (0.3, 1.01 * limit), 0.5) == by_wheels
        assert ekf.turn(2.0, (wheels, 0.0), (0.3, 0.99 * limit), 0.5) == (pytest.approx(0.28), 0.99 * limit, True)


def test_a_known_pose_has_its_covariance_and_what_is_known_of_the_sensors_remains():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    follow(ekf, [(0.3, 0.2, 0.0, True), (0.3, 0.2, 0.0, False)] * 10)
    ekf.doubt_turn(0.5)
    known = [row[3:] for row in ekf.P[3:]]
    covariance = ((0.04, 0.01, 0.02), (0.01, 0.09, 0.0), (0.02, 0.0, 0.16))
    ekf.place(Pose(1.0, 2.0, 3.0), covariance)
    assert ekf.state == (1.0, 2.0, 3.0) and [row[3:] for row in ekf.P[3:]] == known
    numpy.testing.assert_allclose(ekf.covariance, covariance, atol=2 * START_VARIANCE)
    assert not any(ekf.P[index][other] for index in (X, Y, YAW) for other in (BIAS, SLIP, CURVATURE))
    # a path of 2 m with an unknown heading may have turned about its start, and the heading is at most half a turn off
    ekf.reach = 2.0
    ekf.doubt_turn(10.0)
    (xx, _, x_yaw), _, (_, _, yaw) = ekf.covariance
    factor = pi / sqrt(100.16)
    assert (xx, x_yaw, yaw) == pytest.approx((0.04 + 4.0 * (1 - exp(-100.16)) ** 2, factor * 0.02, pi ** 2))


def test_a_carried_robot_may_have_moved_at_half_a_metre_per_second():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.carry(3.0)
    ekf.carry(1.0)      # in one go: 2 m
    assert [ekf.covariance[index][index] for index in range(3)] == pytest.approx(
        [(CARRY_SPEED * 4) ** 2] * 2 + [0.0], abs=3e-9)


# rests

def drift(final, seconds=100):
    """Return a Filter after a rest and so many seconds with a bias that drifts to `final`, rad/s, without wheels."""
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    for number in range(seconds):
        ekf.step(1.0, Yaw(final / seconds * (number + 0.5), 1e-10, True), 0.0, 0.1)
    return ekf


@pytest.mark.parametrize('final', [0.01, -0.01])     # rad/s, after 100 s
def test_a_rest_never_moves_the_pose_and_holds_the_error_that_a_drift_has_caused(final):
    ekf = drift(final)
    before, claimed = ekf.state, sqrt(ekf.covariance[YAW][YAW])
    assert ekf.learn_bias(final, 1e-10) == pytest.approx(final)
    assert ekf.state == before and ekf.bias == pytest.approx(final, rel=0.01)
    error = final * 100 / 2     # of the heading
    assert ekf.error[YAW] == pytest.approx(-error, rel=0.1) and claimed < abs(error) < sqrt(ekf.covariance[YAW][YAW])
    # the bias applies from then on, and may drift on, by this much at first, and as always in the end
    ekf.step(1.0, ekf.turn(1.0, (0.0, 0.0), (final, 1e-10)), 0.0, 0.1)
    assert ekf.state.yaw == pytest.approx(before.yaw, abs=1e-4)
    for walk in (final ** 2 / 100, final ** 2 / 200, *[None] * 20, BIAS_WALK ** 2):
        assert walk is None or ekf.walk == pytest.approx(walk, rel=0.01)
        before = ekf.P[BIAS][BIAS]
        ekf.step(2.0, Yaw(0.0, 0.0, True))
        assert ekf.P[BIAS][BIAS] == pytest.approx(before + ekf.walk * 2.0)
        assert not ekf.learn_bias(ekf.bias, 1e-4)       # no drift


def test_the_bias_is_the_mean_of_its_measurements():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for rate in 0.01, 0.03, 0.02:
        ekf.learn_bias(rate, 1e-8)
    assert ekf.rested and ekf.bias == pytest.approx(0.02, rel=1e-3)
    assert ekf.sigma(BIAS) == pytest.approx(1e-4 / sqrt(3), rel=1e-3)
    ekf.doubt_bias(0.52)
    assert ekf.sigma(BIAS) == pytest.approx(0.5, rel=1e-3)


# wheels and gyro

SPEEDS = 0.1, 0.0, 0.2, 0.05    # m in a PERIOD: at a constant speed, curvature and bias are the same


def compare(ekf, periods, wheels=lambda number: 0.0, gyro=lambda number: 0.0, speeds=(0.1,)):
    """Drive for a number of PERIODs in which wheels and gyro turn by these angles, with these
    distances (m) for 5 PERIODs each; return what is doubted."""
    doubts = []
    for number in range(periods):
        turns, gyros, forward = wheels(number), gyro(number), speeds[number // 5 % len(speeds)]
        ekf.step(PERIOD, ekf.turn(PERIOD, (turns, 0.0), (gyros, 1e-8), forward), turns, forward)
        doubts.append(ekf.compare(PERIOD, turns, (gyros, 1e-8), forward))
    return doubts


def alternately(number):
    """Return a turn to either side, rad."""
    return 0.2 * (-1) ** (number // 5)


def test_the_error_that_an_unstable_bias_has_caused_remains_after_the_next_rest():
    ekf = Filter(FLAT, ORIGIN)
    ekf.learn_bias(0.0, 1e-12)
    for _ in range(2):
        ekf.step(20.0, Yaw(0.0, 0.0, True))
        ekf.learn_bias(0.0, 1e-12)
    assert sqrt(ekf.covariance[YAW][YAW]) == pytest.approx(sqrt(2) * 20 * INSTABILITY, rel=0.02)  # and a walk


def test_before_the_first_rest_the_wheels_show_the_bias_unless_it_may_be_a_curvature():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    bias, slip = radians(0.7), 0.2

    def turn(number):
        return alternately(number) * (1 - slip) + bias * PERIOD
    compare(ekf, 200, alternately, turn, (0.5,))        # a constant speed
    assert ekf.bias == 0.0 and ekf.error[BIAS] != 0.0
    compare(ekf, 400, alternately, turn, SPEEDS)
    assert ekf.bias == ekf.error[BIAS] == pytest.approx(bias, abs=radians(0.1)) and not ekf.rested
    assert ekf.error[SLIP] == pytest.approx(slip, abs=0.02)


def test_a_bias_that_drifts_is_noticed_on_a_smooth_floor_and_applies_from_then_on():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    doubts = compare(ekf, 300, alternately, lambda number: alternately(number) + 1e-4 * number * PERIOD, SPEEDS)
    assert 'bias' in doubts and not any(doubts[:50])
    # a drift to 0.03 rad/s: 2.2 rad, of which nothing is corrected later
    assert ekf.bias == pytest.approx(0.03, rel=0.2) and 0.3 < ekf.state.yaw < 2.24
    assert ekf.state.yaw < RARE * sqrt(ekf.covariance[YAW][YAW])
    before = ekf.state.yaw
    compare(ekf, 1, alternately, lambda number: alternately(number) + ekf.bias * PERIOD)
    assert ekf.state.yaw == pytest.approx(before + 0.2, abs=1e-9)


def test_wheels_without_a_difference_leave_the_heading_certain():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    assert not any(compare(ekf, 600, alternately, alternately)) and sqrt(ekf.covariance[YAW][YAW]) < radians(8)


@pytest.mark.parametrize('sign', [1, -1])
def test_wheels_that_spin_are_a_contradiction_and_no_reason_to_doubt_the_gyro(sign):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    compare(ekf, 100, alternately, alternately)
    assert not any(compare(ekf, 3, lambda _: sign * 0.9)) and ekf.contradicts
    assert not any(compare(ekf, 100, alternately, alternately)) and not ekf.contradicts
    assert sqrt(ekf.covariance[YAW][YAW]) < 0.2 and abs(ekf.bias) < radians(0.1)


@pytest.mark.parametrize('sign', [1, -1])
def test_wheels_that_turn_steadily_faster_than_any_bias_drifts_make_the_heading_uncertain(sign):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    assert 'bias' in compare(ekf, 60, lambda number: alternately(number) + sign * 0.03, alternately, SPEEDS)
    assert abs(ekf.bias) < radians(0.2) and sqrt(ekf.covariance[YAW][YAW]) > 0.5     # none of it is a bias


@pytest.mark.parametrize('factor', [0.0, -1.0])
def test_a_gyro_that_does_not_turn_with_the_wheels_is_left_until_it_does(factor):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    doubts = compare(ekf, 200, alternately, lambda number: factor * alternately(number))
    assert 'gyro' in doubts and ekf.gyro_left
    before = ekf.state.yaw
    compare(ekf, 5, lambda _: 0.2, lambda _: factor * 0.2)
    assert ekf.state.yaw == pytest.approx(before + 1.0)      # by the wheels
    compare(ekf, 1, lambda _: 0.2, lambda _: 0.19)
    assert not ekf.gyro_left


@pytest.mark.parametrize('sign', [1, -1])
def test_a_scale_error_on_a_smooth_floor_is_held_by_the_covariance(sign):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    doubts = compare(ekf, 100, lambda _: sign * 0.2, lambda _: sign * 0.21)
    assert 'scale' in doubts and ekf.scale_error == pytest.approx(0.05, rel=0.1)
    assert sqrt(ekf.covariance[YAW][YAW]) > 0.05 * 20
    # but not on a floor whose slip varies
    rng = numpy.random.default_rng(1)
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    assert 'scale' not in compare(ekf, 100, lambda _: sign * 0.2, lambda _: sign * (0.21 + rng.normal(0, 0.04)))
