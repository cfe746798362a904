"""The filter calculates derivatives, covariances and corrections correctly, and doubts the right sensor."""
from math import degrees, pi, radians, sqrt

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.filter import BIAS, CURVATURE, FIRST_BIAS, SCALE, SLIP_TURNING, WINDOW, X, Y, YAW, Filter
from rbx1_nav.filter.gyro_readings import Sums
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, Bounds
from rbx1_nav.filter.sensors import CONTRADICTION, Doubts
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


@given(st.floats(0.01, 3), st.floats(0.01, 3), st.integers(1, 50))
def test_the_noise_of_a_floor_does_not_depend_on_the_step(turned, travelled, count):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.P[3:, 3:] = 0.0
    for _ in range(count):
        ekf.step(0.0, ekf.turn(0.0, (turned / count, 0.0), None, travelled / count))
    assert ekf.covariance[YAW, YAW] == pytest.approx(0.084 ** 2 * turned + 0.066 ** 2 * travelled, abs=1e-8)
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.P[3:, 3:] = 0.0
    for _ in range(count):
        ekf.step(0.0, ekf.turn(0.0, None, None), 0.0, travelled / count)
    assert ekf.P[X, X] == pytest.approx(0.044 ** 2 * travelled, abs=1e-8)


@pytest.mark.parametrize('reported, used', [(0.0, 0.01), (0.02, 0.02), (1e3, 0.084 ** 2 * 4)])
def test_a_reported_variance_counts_between_the_noise_of_the_assumed_floor_and_of_any_floor(reported, used):
    ekf = Filter(UNKNOWN_FLOOR._replace(heading_noise_turning=0.05, distance_noise=0.05 / 2), ORIGIN)
    assert ekf.turn(1.0, (4.0, reported), None).variance == pytest.approx(used)
    ekf.P[3:, 3:] = 0.0
    ekf.step(1.0, ekf.turn(1.0, None, None), 0.0, 16.0, 0.0, reported)
    assert ekf.P[X, X] == pytest.approx(max(0.01, min(reported, 0.044 ** 2 * 16)), abs=1e-8)


def turn_by_gyro(ekf, rate, time, step=0.1):
    """Turn for a time (s) at the rate that the gyro measures."""
    for _ in range(round(time / step)):
        ekf.step(step, ekf.turn(step, None, (rate * step, 1e-10)))


def test_a_rest_also_corrects_the_heading_since_the_start():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    turn_by_gyro(ekf, 0.02, 30)
    assert ekf.state[YAW] == pytest.approx(0.6)
    first = FIRST_BIAS * Bounds().gyro_bias
    # the bias for 30 s, and the scale error in a turn of 0.6 rad
    assert ekf.covariance[YAW, YAW] == pytest.approx((first * 30) ** 2 + (0.007 * 0.6 / 2) ** 2, rel=0.05)
    ekf.learn_bias(0.02, 1e-9)
    assert ekf.state[YAW] == pytest.approx(0.0, abs=0.01) and ekf.bias == pytest.approx(0.02, abs=1e-4)
    assert sqrt(ekf.covariance[YAW, YAW]) < 0.02


@pytest.mark.parametrize('final', [0.01, -0.01])     # rad/s, after 10 s
def test_a_bias_that_has_drifted_has_turned_the_heading_by_half_of_its_change(final):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-9)
    for number in range(100):
        ekf.step(0.1, ekf.turn(0.1, None, (final / 100 * number * 0.1, 1e-10)))
    assert ekf.state[YAW] == pytest.approx(5 * final, rel=0.05)
    ekf.learn_bias(final, 1e-9)
    assert ekf.bias == pytest.approx(final, abs=1e-4) and ekf.state[YAW] == pytest.approx(0.0, abs=0.002)


def test_wheels_and_gyro_do_not_change_the_errors_that_are_considered():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    turn_by_gyro(ekf, 1.0, 10)
    before = ekf.P[SCALE:, SCALE:].copy()
    ekf.learn_bias(0.01, 1e-9)
    numpy.testing.assert_allclose(ekf.P[SCALE:, SCALE:], before, rtol=1e-12)


def test_an_unknown_heading_is_half_a_turn_and_the_position_anywhere_around_the_start():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for _ in range(600):
        ekf.step(1.0, ekf.turn(1.0, None, (0.0, 1e-6)), 0.0, 0.01)
    assert sqrt(ekf.covariance[YAW, YAW]) == pytest.approx(pi)
    assert min(numpy.linalg.eigvalsh(ekf.covariance[:2, :2])) > 5.9 ** 2     # 6 m from the start


def drive(ekf, turned, slip=0.0, factor=1.0):
    """Turn with slipping wheels, and a gyro that measures a multiple of the turn; return the doubts."""
    return move(ekf, [((0.02 / (1 - slip), 0.0), (0.02 * factor, 1e-9))] * round(turned / 0.02))


def move(ekf, turns, forward=0.0):
    """Make steps of 0.02 s with the turns of wheels and gyro; return the doubts."""
    doubts = []
    for wheels, gyro in turns:
        ekf.step(0.02, ekf.turn(0.02, wheels, gyro, forward), 0.0, forward)
        verdict = ekf.close_window()
        doubts += [verdict[1]] if verdict else []
    return doubts


@given(st.floats(-0.25, 0.6), st.floats(1.5, 60))
def test_a_slip_that_is_possible_changes_nothing_but_its_own_spread(slip, turned):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-10)
    drive(ekf, turned, slip)
    assert ekf.state[YAW] == pytest.approx(round(turned / 0.02) * 0.02) and abs(ekf.bias) < 1e-9
    # what is left is the scale error of the gyro
    assert degrees(sqrt(ekf.covariance[YAW, YAW])) < degrees(0.007 * turned) + 3


def test_a_larger_slip_than_that_of_the_floor_is_reported_once_and_widens_the_position():
    floor = UNKNOWN_FLOOR._replace(slip_turning_spread=0.05)
    ekf = Filter(floor, ORIGIN)
    ekf.learn_bias(0.0, 1e-10)
    doubts = drive(ekf, 20.0, 0.5)
    assert doubts[0] == 'wheels' and not any(doubts[1:])
    assert 0.4 < ekf.sigma(SLIP_TURNING) < 0.6 and ekf.covariance[X, X] > 0.1 ** 2
    drive(ekf, 40.0)
    assert ekf.sigma(SLIP_TURNING) == pytest.approx(0.05)        # and shrinks again


@pytest.mark.parametrize('factor', [-1.0, 0.0, 3.0])
def test_a_difference_that_is_no_slip_is_a_doubt_of_the_heading_until_both_agree(factor):
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-10)
    doubts = drive(ekf, 6.0, factor=factor)
    assert set(doubts) == {'both'}
    differ = abs(1 - factor) * 6.0      # rad; the last 2 rad are not yet compared
    assert 0.6 * min(differ, pi) < sqrt(ekf.covariance[YAW, YAW]) < differ + 0.1
    assert not any(drive(ekf, 60.0)[1:])    # the first window may have begun before
    assert sqrt(ekf.covariance[YAW, YAW]) < 0.007 * (6.0 * abs(factor) + 60.0) + 0.05    # the scale error of the gyro


def straight_on(rates, noise=0.0):
    """Return a Filter that knows the bias, after straight motion at 0.2 m/s, and its doubts.

    rates: of the gyro, rad/s; noise: rad, of the wheels, a turn that changes its direction every second.
    """
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.learn_bias(0.0, 1e-10)
    return ekf, move(ekf, [((noise * (-1) ** (number // 50) / 50, 0.0), (rate * 0.02, 1e-10))
                           for number, rate in enumerate(rates)], 0.004)


def test_a_drift_while_the_robot_drives_straight_is_found_and_corrected():
    ekf, doubts = straight_on([1e-4 * number * 0.02 for number in range(3000)])     # 0.34 degrees/s in a minute
    assert 'imu_data' in doubts and doubts[-1] == ''
    assert ekf.bias == pytest.approx(0.006, abs=0.001) and abs(ekf.state[YAW]) < 0.01   # uncorrected: 0.18
    assert abs(ekf.state[Y]) < 0.05


def test_a_constant_curve_is_no_drift():
    ekf, doubts = straight_on([0.002] * 3000)
    assert not any(doubts) and ekf.state[CURVATURE] == pytest.approx(0.01, rel=0.02)
    assert abs(ekf.bias) < 1e-5 and ekf.state[YAW] == pytest.approx(0.12, rel=0.01)


def test_straight_motion_does_not_correct_what_the_wheels_have_turned():
    """The wheels measured 60 rad, which any slip makes uncertain; then the gyro misses a part of a slow turn."""
    ekf, _ = straight_on([0.0] * 1000)
    for _ in range(600):
        ekf.step(0.02, ekf.turn(0.02, (0.1, 0.0), None))
    before = ekf.state[YAW]
    assert before == pytest.approx(60.0) and ekf.sigma(YAW) > 10.0
    move(ekf, [((0.2 / 500, 0.0), (0.1 / 500, 1e-10))] * 500, 0.006)
    assert ekf.state[YAW] == pytest.approx(before + 0.1, abs=0.01)


def test_with_noisy_wheels_no_drift_can_be_found():
    _, doubts = straight_on([1e-4 * number * 0.02 for number in range(3000)], 0.03)
    assert not any(doubts)


def report(verdicts, rested=True):
    """Return the warnings for doubts, one per second."""
    warnings, doubts, ekf = [], Doubts(warn=lambda text: warnings.append(text)), Filter(UNKNOWN_FLOOR, ORIGIN)
    ekf.rested = rested
    for second, doubted in enumerate(verdicts):
        doubts.report((Sums(time=20.0, wheels=2.0, gyro=1.0), doubted), ekf, second * SECOND)
    return warnings, doubts


def test_a_doubt_and_its_end_are_reported_once():
    warnings, doubts = report(['', 'wheels', 'wheels', '', '', '', '', '', ''])
    assert warnings == ['odom turned by 2.00 rad, imu_data by 1.00 rad in 20.0 s: the wheels slip; the heading follows '
                        'the gyro', 'odom and imu_data agree again']
    assert doubts.doubted == 'nothing' and not doubts.contradicts(8 * SECOND)
    warnings, doubts = report(['', 'both'])
    assert warnings[0].endswith(': one of them is wrong; the heading is uncertain')
    assert doubts.doubted == 'both since 1.0 s' and doubts.contradicts(SECOND + CONTRADICTION - 1)


def test_a_robot_that_was_never_at_rest_is_reported_once():
    warnings, _ = report(['', '', ''], rested=False)
    assert warnings == ['the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may drift '
                        f'by {degrees(FIRST_BIAS * radians(10)):.1f} degrees/s or more']
