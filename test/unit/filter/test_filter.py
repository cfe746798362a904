"""The filter calculates derivatives, covariances and corrections correctly."""
from math import cos, exp, pi, sin, sqrt

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.filter.filter import BIAS, BIAS_WALK, SCALE, WINDOW, X, Y, YAW, Filter
from rbx1_nav.filter.gyro_readings import Sums
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from sample_priors import IDEAL

angles = st.floats(-3, 3)
small = st.floats(-0.1, 0.1)
FLAT = IDEAL._replace(slip_turning=0.1, curvature=0.2, slip_straight=-0.05)    # a floor without noise


def true_step(state, errors, by_gyro, turned, forward, left, direction):
    """Return x, y and yaw after a step of 0.5 s, if the sensors have these errors (indices BIAS to SLIP_STRAIGHT), and
    the difference of both turns."""
    bias, curvature, scale, turning, straight = errors
    by_wheels = turned * (1 - turning) + curvature * forward
    angle = (turned - bias * 0.5) / (1 + scale) if by_gyro else by_wheels
    middle, grip = state[YAW] + angle / 2 + direction, 1 - straight
    c, s = numpy.cos(middle), numpy.sin(middle)
    return numpy.array([state[X] + grip * (forward * c - left * s), state[Y] + grip * (forward * s + left * c),
                        state[YAW] + angle, by_wheels - angle])


@given(st.tuples(small, small, angles), small, angles, small, small, small, st.booleans())
def test_the_covariance_follows_from_the_derivatives_of_a_step(pose, bias, turned, forward, left, direction, by_gyro):
    ekf = Filter(FLAT, Pose(*pose))
    ekf.state[BIAS] = bias
    ekf.P, ekf.doubt = 1e-6 * numpy.eye(9), [0.1, 0.2, 0.3]
    ekf.step(0.5, ekf.turn(0.5, (turned, 0.0), (turned, 1e-6) if by_gyro else None, forward), direction, forward, left)
    # the gyro's scale error is 0, and the other errors have the mean of the floor
    errors = numpy.array([bias, 0.2, 0.0, 0.1, -0.05])
    reached = true_step(pose, errors, by_gyro, turned, forward, left, direction)
    assert ekf.state == pytest.approx([*reached[:3], bias, 0.2], abs=1e-12)
    assert ekf.reach == pytest.approx(numpy.hypot(*reached[:2] - pose[:2]))
    h, columns = 1e-6, []
    for index in range(8):
        change = h * numpy.eye(8)[index]
        ends = [true_step(numpy.add(pose, sign * change[:3]), errors + sign * change[3:], by_gyro, turned, forward,
                          left, direction) for sign in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * h))
    derivatives = numpy.stack(columns, axis=1)
    assert ekf.doubt == pytest.approx(derivatives[:3, :3] @ (0.1, 0.2, 0.3), abs=1e-8)
    doubted = ekf.covariance - ekf.P[:3, :3] - numpy.outer(ekf.doubt, ekf.doubt)
    assert doubted[[X, X, Y, YAW], [Y, YAW, YAW, YAW]] == pytest.approx(0, abs=1e-12)
    expected = 1e-6 * derivatives @ derivatives.T
    if by_gyro:     # and the noise of its turn, half of which also changes the direction
        by_turn = derivatives[:, YAW] * (0.5, 0.5, 1.0, 0.0) - (0.0, 0.0, 0.0, 1.0)
        expected += 1e-6 * numpy.outer(by_turn, by_turn)
        expected[3, 3] += 1e-6      # which was there before
    count = 4 if by_gyro else 3     # without the gyro there is no difference
    indices = [X, Y, YAW, WINDOW][:count]
    numpy.testing.assert_allclose(      # central differences: 1e-10
        ekf.P[numpy.ix_(indices, indices)], expected[:count, :count], atol=1e-12, rtol=1e-4)
    numpy.testing.assert_allclose(ekf.P[BIAS:WINDOW, BIAS:WINDOW], 1e-6 * numpy.eye(5), atol=1e-9)  # the bias walks


@given(st.lists(st.tuples(angles, st.floats(-1e6, 1e6), st.floats(-3, 7), st.floats(-12, 12), st.integers(0, 3)),
                min_size=1, max_size=60))
def test_the_covariance_stays_symmetric_and_positive(steps):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for turned, forward, exponent, noise, sensor in steps:
        duration, gyro = 10 ** exponent, (turned, 10 ** noise)
        if sensor == 0:
            ekf.learn_bias(turned, 10 ** noise)
        turn = ekf.turn(duration, (turned, 10 ** noise), gyro if sensor < 3 else None, forward)
        ekf.step(duration, turn, 0.0, forward, 0.0, 10 ** noise)
        ekf.close_window()
        numpy.testing.assert_array_equal(ekf.covariance, ekf.covariance.T)
        values = numpy.linalg.eigvalsh(ekf.covariance)
        assert values[0] >= -1e-9 * values[-1] and numpy.isfinite(ekf.state).all()


@pytest.mark.parametrize('reported, turn, path', [
    (0.0, 0.01 + 0.002, 0.01), (0.02, 0.02, 0.02), (1e3, 0.084 ** 2 * 4 + 0.066 ** 2 * 2, 0.044 ** 2 * 16)])
def test_a_reported_variance_counts_between_the_noise_of_the_assumed_floor_and_of_any_floor(reported, turn, path):
    ekf = Filter(UNKNOWN_FLOOR._replace(heading_noise_turning=0.05, heading_noise_straight=sqrt(0.001),
                                        distance_noise=0.05 / 2, slip_straight=0.1), ORIGIN)
    assert ekf.turn(1.0, (-4.0, reported), None, -2.0).variance == pytest.approx(turn)
    ekf.P[:] = 0.0
    ekf.step(1.0, ekf.turn(1.0, None, None), 0.6, -10.0, 6.0, reported)
    # along the heading, and reduced by the slip like the path
    c, s = cos(0.6), sin(0.6)
    assert ekf.P[:2, :2] == pytest.approx(0.9 ** 2 * path * numpy.array([[c * c, c * s], [c * s, s * s]]))


def test_a_turn_is_measured_by_the_wheels_if_they_are_more_certain():
    ekf = Filter(FLAT, ORIGIN)
    ekf.state[BIAS] = 0.01
    for wheels, limit in (0.0, 0.005 ** 2), (-2.0, (0.05 * 2) ** 2):    # rounding of odometry, 5 % of slip
        by_wheels = ekf.turn(2.0, (wheels, 0.0), None, 0.5)
        assert by_wheels.angle == pytest.approx(0.9 * wheels + 0.2 * 0.5)   # slip and curvature
        assert ekf.turn(2.0, (wheels, 0.0), (0.3, 1.01 * limit), 0.5) == by_wheels
        turn = ekf.turn(2.0, (wheels, 0.0), (0.3, 0.99 * limit), 0.5)
        assert turn[:3] == (pytest.approx(0.28), 0.99 * limit, (-2.0, 0.0, pytest.approx(-0.28), 0.0))
        assert turn.compared == Sums(2.0, wheels, by_wheels.angle, turn.angle, 0.5, 0.0)
    # a step of more than 10 s is not compared; without sensors, there is no turn
    assert ekf.turn(11.0, (0.0, 0.0), (0.3, 1e-9)).compared is None
    assert ekf.turn(2.0, None, None)[:3] == (0.0, 0.0, (0.0, 0.0, 0.0, 0.0))


def arbitrary():
    """Return a Filter with an arbitrary state, and its covariance before."""
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.state = [0.1, 0.2, 0.3, 0.4, 0.5]
    root = numpy.random.RandomState(1).rand(9, 9)
    ekf.P = root @ root.T
    return ekf, ekf.P.copy()


def test_a_known_pose_has_its_covariance_and_what_is_known_of_the_sensors_remains():
    ekf, before = arbitrary()
    ekf.drift, ekf.doubt, ekf.reach = numpy.ones(9), [1.0, 2.0, 3.0], 4.0
    covariance = numpy.array([[0.04, 0.01, 0.02], [0.01, 0.09, 0.0], [0.02, 0.0, 0.16]])
    ekf.place(Pose(1.0, 2.0, 3.0), covariance)
    assert ekf.state == [1.0, 2.0, 3.0, 0.4, 0.5] and ekf.drift.tolist() == [0.0] * 3 + [1.0] * 6
    numpy.testing.assert_allclose(ekf.covariance, covariance, atol=1e-12)       # rounding
    assert not ekf.P[:3, 3:].any() and not ekf.P[3:, :3].any() and (ekf.P[3:, 3:] == before[3:, 3:]).all()
    # a doubt of 0.1 m, 0.2 m and 0.3 rad; and the path of 2 m may have turned about its start
    ekf.doubt, ekf.reach = [0.1, 0.2, 0.3], 2.0
    turned = ((1 - exp(-0.25)) * 2) ** 2
    expected = [[0.05 + turned, 0.03, 0.05], [0.03, 0.13 + turned, 0.06], [0.05, 0.06, 0.25]]
    numpy.testing.assert_allclose(ekf.covariance, expected, rtol=1e-9)          # rounding
    ekf.doubt[YAW] = 10.0       # the heading is unknown: the same correlation, but half a turn
    factor = pi / sqrt(100.16)
    assert ekf.covariance[YAW].tolist() == pytest.approx([factor * (0.02 + 1.0), factor * 2.0, pi ** 2])
    # no variance is less than at the first pose
    ekf.place(ORIGIN, numpy.full((3, 3), 0.01))
    assert numpy.linalg.eigvalsh(ekf.covariance) == pytest.approx([1e-9, 1e-9, 0.03], rel=1e-6)   # eigh: 1e-16


def test_a_carried_robot_may_have_moved_at_half_a_metre_per_second():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.carry(0.3, 3.0)
    ekf.carry(-0.1, 1.0)
    assert ekf.state[:3] == pytest.approx([0.0, 0.0, 0.2])
    # in one go: 2 m; the pose was known to 1e-9
    assert ekf.P.diagonal()[:3].tolist() == pytest.approx([4.0, 4.0, 0.0], abs=2e-9)


def test_a_rest_updates_what_is_estimated_and_not_what_is_considered():
    ekf, before = arbitrary()
    ekf.rested, ekf.drift = True, numpy.ones(9)
    ekf.learn_bias(0.7, 0.6)
    # the gain of a Kalman filter
    gain = before[BIAS] / (before[BIAS, BIAS] + 0.6)
    assert ekf.state == pytest.approx([old + each * 0.3 for old, each in zip((0.1, 0.2, 0.3, 0.4, 0.5), gain)])
    expected = before - numpy.outer(gain, before[BIAS])
    expected[SCALE:, SCALE:] = before[SCALE:, SCALE:]
    numpy.testing.assert_allclose(ekf.P, expected, rtol=1e-9)       # rounding
    assert not ekf.drift.any()
    ekf.doubt_bias(ekf.bias - 0.5)
    assert ekf.P[BIAS, BIAS] == pytest.approx(expected[BIAS, BIAS] + 0.25)
    ekf.rested = False      # the first rest: the window began with another bias
    ekf.learn_bias(0.7, 0.6)
    assert ekf.rested and not ekf.P[WINDOW].any() and not ekf.P[:, WINDOW].any()


@pytest.mark.parametrize('final', [0.01, -0.01])     # rad/s, after 10 s
def test_a_bias_that_has_drifted_has_turned_the_heading_by_half_of_its_change(final):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    for number in range(100):
        ekf.step(0.1, ekf.turn(0.1, None, (final / 100 * number * 0.1, 1e-10)))
    assert ekf.state[YAW] == pytest.approx(5 * final, rel=0.05)
    ekf.learn_bias(final, 1e-9)
    assert ekf.bias == pytest.approx(final, abs=1e-4) and ekf.state[YAW] == pytest.approx(0.0, abs=0.002)
    # it may drift on, by 0.01 rad/s in 10 s at first, and as always in the end
    for walk in (0.01 ** 2 / 10, 0.01 ** 2 / 20, *[None] * 20, BIAS_WALK ** 2):
        assert walk is None or ekf.walk == pytest.approx(walk)
        before = ekf.P[BIAS, BIAS]
        ekf.step(2.0, ekf.turn(2.0, None, None))
        assert ekf.P[BIAS, BIAS] == pytest.approx(before + ekf.walk * 2.0)
        ekf.learn_bias(ekf.bias + 0.01, 1e-4)       # 1 sigma is no drift
