"""Noise and drift are learned from measurements."""
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
