"""Wheels and gyro are compared over the robot's last turns, and judged by what a floor explains."""
from math import exp, inf, sqrt

import numpy
import pytest

from rbx1_nav.estimation.agreement import Agreement, floor_variance
from rbx1_nav.estimation.priors import Priors

#            straight   turning     gyro       noise
FLOOR = Priors(0.0, 0.0, 0.02, 0.03, 0.01, inf, 0.04, 0.05, 0.0)
SMOOTH = Priors(0.0, 0.0, 0.0, 0.0, 0.0, inf, 0.0, 0.0, 0.0)


def after(*steps):
    """Return an Agreement after steps: (wheels, gyro[, variance[, travelled[, duration]]])."""
    agreement = Agreement()
    for step in steps:
        agreement.add(*step, *(0.0, 0.0, 0.1)[len(step) - 2:])
    return agreement


def test_the_floor_explains_a_difference_that_grows_with_turn_and_path():
    # rounding, the spreads of slip and scale error, and the noise, which grows with the square root of the path
    assert floor_variance(FLOOR, 3.0, 2.0) == pytest.approx(
        0.005 ** 2 + (0.03 * 3.0) ** 2 + (0.01 * 3.0) ** 2 + 0.04 ** 2 * 3.0 + 0.05 ** 2 * 2.0)
    assert floor_variance(SMOOTH, 3.0, 2.0) == pytest.approx(0.005 ** 2)


@pytest.mark.parametrize('wheels, gyro, complete', [
    (0.1999, 0.1999, False), (0.2, 0.0, True), (0.0, 0.2, True), (-0.2, 0.1, True), (0.1, -0.2, True)])
def test_a_part_is_complete_when_a_sensor_has_turned_by_a_fifth_of_a_radian(wheels, gyro, complete):
    assert Agreement().add(wheels, gyro, 0.0, 0.0, 0.1) is complete


def test_small_steps_add_up_to_a_part():
    agreement = Agreement()
    assert [agreement.add(0.0625, 0.06, 1e-6, 0.1, 0.5) for _ in range(8)] == [False, False, False, True] * 2
    kept = exp(-0.25 / 10)
    assert (agreement.wheels, agreement.gyro, agreement.variance, agreement.travelled, agreement.time) == (
        pytest.approx([each * (1 + kept) for each in (0.25, 0.24, 4e-6, 0.4, 2.0)]))


@pytest.mark.parametrize('duration, complete', [(5.0, True), (5.01, False)])
def test_a_robot_that_turns_too_slowly_is_not_compared(duration, complete):
    agreement = Agreement()
    agreement.add(0.15, 0.15, 0.0, 0.0, duration)
    assert agreement.add(0.15, 0.15, 0.0, 0.0, 0.1) is complete


def test_a_turn_counts_less_the_further_the_robot_has_turned_since_then():
    agreement = after((1.0, 0.8, 1e-4, 2.0, 3.0), (4.0, 5.0, 1e-4, 2.0, 3.0))
    kept = exp(-5.0 / 10.0)
    assert (agreement.wheels, agreement.gyro, agreement.turned) == pytest.approx(
        (kept * 1.0 + 4.0, kept * 0.8 + 5.0, kept * 1.0 + 5.0))
    assert (agreement.variance, agreement.travelled, agreement.time) == pytest.approx(
        ((1 + kept) * 1e-4, (1 + kept) * 2.0, (1 + kept) * 3.0))


def test_turns_to_the_left_and_to_the_right_add_up():
    agreement = after((1.0, 0.9), (-1.0, -0.9), (1.0, 0.9), (-1.0, -0.9))
    # each one is counted in its own direction
    assert agreement.wheels / agreement.gyro == pytest.approx(1 / 0.9) and agreement.gyro > 2.5


@pytest.mark.parametrize('wheels, gyro, counted', [
    (1.0, -1.0, (1.0, -1.0)), (-0.11, 1.0, (0.11, -1.0)), (-0.1, 1.0, (-0.1, 1.0)), (0.0, -1.0, (0.0, 1.0))])
def test_the_direction_is_the_one_of_the_wheels_unless_they_have_hardly_turned(wheels, gyro, counted):
    agreement = after((wheels, gyro))
    assert (agreement.wheels, agreement.gyro) == counted


@pytest.mark.parametrize('turn, significant', [(1.5, False), (1.51, True)])
def test_a_turn_of_at_most_1_5_rad_is_not_enough_evidence(turn, significant):
    agreement = after((turn, 0.0))
    assert (agreement.difference(SMOOTH, 0.0) != 0) == significant
    assert (agreement.ratio(0.0) is not None) == significant


@pytest.mark.parametrize('beyond', [-0.01, 0.01])
@pytest.mark.parametrize('sign', [-1, 1])
def test_a_difference_of_more_than_5_standard_deviations_is_not_due_to_chance(beyond, sign):
    # of the gyro's noise, its bias of 0.02 rad/s over 3 s, and the floor
    deviation = sqrt(1e-3 + (0.02 * 3.0) ** 2 + 0.005 ** 2 + (0.03 * 2) ** 2 + (0.01 * 2) ** 2 + 0.04 ** 2 * 2
                     + 0.05 ** 2 * 4.0)
    differ = sign * (5.0 * deviation + beyond)
    # the robot turns by 2 % less than its wheels
    wheels, gyro = (2.0, 2.0 * 0.98 - differ) if differ > 0 else ((2.0 + differ) / 0.98, 2.0)
    agreement = after((wheels, gyro, 1e-3, 4.0, 3.0))
    expected = pytest.approx(differ) if beyond > 0 else 0.0
    assert agreement.difference(FLOOR, 0.02 ** 2) == expected


@pytest.mark.parametrize('beyond, agrees', [(-1e-3, True), (1e-3, False)])
@pytest.mark.parametrize('sign', [-1, 1])
def test_the_last_part_agrees_within_2_standard_deviations(beyond, agrees, sign):
    deviation = sqrt(1e-3 + 0.005 ** 2 + (0.03 * 0.5) ** 2 + (0.01 * 0.5) ** 2 + 0.04 ** 2 * 0.5 + 0.05 ** 2 * 0.2)
    gyro = 0.5 * 0.98 + sign * (2.0 * deviation + beyond)
    # whatever wheels and gyro have measured before
    for before in [], [(3.0, -3.0)]:
        agreement = after(*before, (0.5, gyro, 1e-3, 0.2, 1.0))
        assert agreement.agrees(FLOOR) == agrees
        assert agreement.add(0.01, 5.0, 0.0, 0.0, 0.1) and not agreement.agrees(FLOOR)


@pytest.mark.parametrize('sign', [-1, 1])
def test_the_ratio_of_a_constant_difference_is_this_difference(sign):
    parts = [(sign * turn, 0.95 * sign * turn) for turn in (1.0, 0.5, 2.0)]
    assert after(*parts).ratio(0.0) == pytest.approx(0.05)


def test_the_ratio_contains_the_uncertainty_of_the_bias():
    # 0.02 rad/s for 4 s, relative to a turn of 2 rad
    assert after((2.0, 1.9, 0.0, 0.0, 4.0)).ratio(0.02 ** 2) == pytest.approx(sqrt(0.05 ** 2 + 0.04 ** 2))


def test_the_ratio_contains_how_much_the_difference_varies():
    kept = exp(-1.0 / 10.0)
    # the mean difference after the second turn is 0.04 * kept of 1 + kept; the second turn differs by 0
    mean = 0.04 * kept / (1 + kept)
    assert after((1.0, 0.96), (1.0, 1.0)).ratio(0.0) == pytest.approx(
        sqrt((0.04 * kept) ** 2 + mean ** 2) / (1 + kept))


def test_the_variation_of_a_difference_is_forgotten_with_the_turns():
    noisy = after((1.0, 0.96), (1.0, 1.0)).ratio(0.0)
    assert after((1.0, 0.96), (1.0, 1.0), *[(1.0, 1.0)] * 100).ratio(0.0) < 1e-3 * noisy


def test_the_noise_of_a_robot_that_stands_or_goes_straight_is_no_turn():
    agreement = Agreement()
    generator = numpy.random.default_rng(1)
    for wheels, gyro in generator.normal(0, 1e-3, (100000, 2)):
        agreement.add(wheels, gyro, 1e-9, 0.004, 0.02)
    assert agreement.turned == 0.0
