"""Noise and drift are learned from measurements."""
from math import sqrt

import numpy
import pytest

from rbx1_nav.estimation.noise import Drift, NoiseFactor


def factor(deviation, share=1.0, number=400):
    """Return the NoiseFactor after normal differences with this deviation, relative to the assumed deviation."""
    noise = NoiseFactor()
    for value in numpy.random.default_rng(0).normal(0, deviation, number):
        noise.add(value ** 2 / (share * noise.value + 1 - share), share)
    return noise


def test_the_factor_is_that_of_the_variances_and_at_most_1():
    # 400 squares: 1 sigma of their mean is 0.07 of the mean
    assert factor(0.5).value == pytest.approx(0.25, rel=0.28)
    assert factor(2.0).value == 1.0


def test_differences_that_are_noise_of_the_gyro_change_nothing():
    assert factor(0.995, share=0.01).value == 1.0


def test_a_single_outlier_counts_little():
    noise = factor(0.5)
    before = noise.value
    noise.add(1e6, 1.0)
    # 400 differences: the outlier counts 9 / 400
    assert noise.value < 1.03 * before


def test_a_drift_is_the_change_of_the_bias_by_time():
    drift = Drift()
    for _ in range(10):
        drift.add(20.0, (20 * 1e-4) ** 2, 1e-8)
    assert drift.value == pytest.approx(1e-4 ** 2, rel=0.01)


@pytest.mark.parametrize('square', [0.0, 0.5e-6, 1e-6])
def test_changes_that_noise_explains_are_no_drift(square):
    drift = Drift()
    for _ in range(10):
        drift.add(20.0, square, 1e-6)
    assert drift.value == 0.0


def test_the_factor_is_cautious_by_2_sigma_and_begins_like_5_differences_of_the_expected_size():
    noise = NoiseFactor()
    assert noise.value == 1.0
    for count in range(6, 40):
        noise.add(0.0, 1.0)
        # the mean of 5 squares of 1 and some squares of 0; its relative deviation is sqrt(2 / count)
        assert noise.value == pytest.approx(min(1.0, 5 / count * (1 + 2 * sqrt(2 / count))))


def test_a_difference_counts_by_the_share_of_the_wheels_noise():
    noise = NoiseFactor()
    noise.add(0.0, 1.0)
    noise.add(3.0, 0.5)
    # the mean is 5/6, and the square is 2 more than expected: by the half that is noise of the wheels, of a count of
    # 6.25
    assert noise.mean == pytest.approx(5 / 6 * (1 + 0.5 * 2.0 / 6.25))
    assert noise.count == 5 + 1 + 0.5 ** 2


@pytest.mark.parametrize('square', [9.0, 9.1, 1e9])
def test_a_square_counts_as_at_most_9_times_its_expected_size(square):
    noise = NoiseFactor()
    noise.add(square, 1.0)
    assert noise.mean == pytest.approx((5 + 9) / 6)


def test_a_drift_is_weighted_by_the_time_in_which_it_acts():
    drift = Drift()
    assert drift.value == 0.0
    drift.add(10.0, 4e-6, 1e-6)
    # 3e-6 rad^2/s^2 more than the noise, of which 1 sigma, sqrt(2) * 1e-6, may be chance
    assert drift.value == pytest.approx((3 - sqrt(2)) * 1e-6 / 10.0 ** 2)
    drift.add(20.0, 9e-6, 1e-6)
    # least squares of 3e-6 = drift * 10^2 and 8e-6 = drift * 20^2
    mean = (3e-6 * 10 ** 2 + 8e-6 * 20 ** 2) / (10 ** 4 + 20 ** 4)
    sigma = sqrt(2) * sqrt((1e-6 * 10 ** 2) ** 2 + (1e-6 * 20 ** 2) ** 2) / (10 ** 4 + 20 ** 4)
    assert drift.value == pytest.approx(mean - sigma)
