"""End poses in arrays, and covariances to first order, match the simulated robot."""

import numpy
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rbx1_nav.extras.fitting.comparison import inner_share, mahalanobis, simulate_paths
from rbx1_nav.extras.fitting.prediction import SPREADS, Covariance, Prediction
from rbx1_nav.extras.fitting.recording import Commands
from rbx1_nav.extras.fitting.run import STEP, Windows, commanded_travel, grid
from rbx1_nav.simulation.floor import make_floor
from rbx1_nav.simulation.floor_noise import NOISES
from rbx1_nav.simulation.wheels import Wheels
from sample_surface import SURFACE

WIDTH = 0.26
FLOOR = SURFACE._replace(delay=0.1, curvature=-0.04, turning_loss=0.1, **dict.fromkeys(SPREADS, 0.0))
NOISY = FLOOR._replace(heading_noise_turning=0.09, heading_noise_straight=0.07, distance_noise=0.04,
                       slip_straight_spread=0.02, slip_turning_spread=0.04)
# (m/s, rad/s, s): whole steps
SEQUENCE = [(0.2, 0.0, 3.0), (0.15, 0.5, 3.0), (0.0, -1.0, 1.5), (-0.1, 0.2, 1.0), (0.0, 0.0, 1.0)]
RUNS = 800


def predict(surface, sequence):
    """Return the Prediction for one window that contains a whole sequence."""
    times = numpy.cumsum([0.0] + [duration for _, _, duration in sequence])
    linear, angular = ([*values, 0.0] for values in list(zip(*sequence))[:2])
    commands = Commands(times, numpy.array(linear), numpy.array(angular))
    steps = commanded_travel(surface, WIDTH, commands, grid(0.0, times[-1] + 1e-9))
    return Prediction(surface, steps, Windows(numpy.array([0]), len(steps.straight), numpy.zeros((1, 3))))


def drive(surface, sequence, seed):
    """Return the true poses of a simulated robot after each step."""
    wheels = Wheels(WIDTH, make_floor(surface, seed), 0.02)
    for linear, angular, duration in sequence:
        for _ in range(round(duration / STEP)):
            wheels.travel(linear, angular, STEP)
            yield wheels.truth.pose


def simulated(surface):
    """Return the true end poses of RUNS simulated robots."""
    return numpy.array([list(drive(surface, SEQUENCE, seed))[-1] for seed in range(RUNS)])


def spreads_agree(some, others):
    """Return whether the variances of two covariances differ by at most 30 % along every axis.

    The relative 1 sigma error of a variance from RUNS end poses is sqrt((kurtosis - 1) / RUNS), 5 to 6 %, and the worst
    of three axes counts.
    """
    ratios = numpy.linalg.eigvals(numpy.linalg.solve(some, others)).real
    return 1 / 1.3 < ratios.min() and ratios.max() < 1.3


@settings(max_examples=50)
@given(st.lists(st.tuples(st.floats(-0.5, 0.5), st.floats(-2, 2), st.integers(1, 40)), min_size=1, max_size=10))
def test_without_noise_path_and_end_are_those_of_the_simulated_robot(parts):
    sequence = [(linear, angular, STEP * count) for linear, angular, count in parts]
    prediction = predict(FLOOR, sequence)
    path = numpy.transpose(list(drive(FLOOR, sequence, 0)))
    assert prediction.means[0] == pytest.approx(path[:, -1], abs=1e-9)
    paths = simulate_paths(FLOOR, prediction, 0, 3, numpy.random.default_rng(0))
    assert paths == pytest.approx(numpy.stack([path] * 3), abs=1e-9)


def test_the_ensemble_is_that_of_the_simulated_robot():
    ends = simulated(NOISY)
    ensemble = simulate_paths(NOISY, predict(NOISY, SEQUENCE), 0, 10 * RUNS, numpy.random.default_rng(1))[:, :, -1]
    # five times 1 sigma of a mean
    assert (abs(ends.mean(axis=0) - ensemble.mean(axis=0)) < 5 * ends.std(axis=0) / RUNS ** 0.5).all()
    assert spreads_agree(numpy.cov(ends.T), numpy.cov(ensemble.T))
    for part in 0.5, 0.9:
        inside = numpy.mean([inner_share(ensemble[:2000], end) < part for end in ends[:400]])
        # five times 1 sigma of a share of 400
        assert abs(inside - part) < 5 * (part * (1 - part) / 400) ** 0.5


@pytest.mark.parametrize('key', NOISES + SPREADS)
def test_each_strength_alone_has_the_spread_of_the_simulated_robot(key):
    surface = FLOOR._replace(**{key: 0.05})
    ends = simulated(surface)
    ensemble = simulate_paths(surface, predict(surface, SEQUENCE), 0, 10 * RUNS, numpy.random.default_rng(1))[:, :, -1]
    floor = 1e-6 * numpy.eye(3)     # one strength alone leaves some direction without any spread
    assert spreads_agree(numpy.cov(ends.T) + floor, numpy.cov(ensemble.T) + floor)


@pytest.mark.parametrize('keys', [NOISES, SPREADS, NOISES + SPREADS], ids=' '.join)
def test_the_covariance_to_first_order_is_that_of_the_ensemble(keys):
    surface = FLOOR._replace(**dict.fromkeys(keys, 0.02))
    prediction = predict(surface, SEQUENCE)
    ensemble = simulate_paths(surface, prediction, 0, 10 * RUNS, numpy.random.default_rng(2))[:, :, -1]
    # a measurement error of 3 mm, which is larger than the effects beyond the first order
    measured = ensemble - ensemble.mean(axis=0) + 0.003 * numpy.random.default_rng(3).standard_normal(ensemble.shape)
    covariance = Covariance(surface, prediction.sensitivities(), 0.003 ** 2 * numpy.eye(3))
    white = numpy.array([covariance.whitened(error[None]) for error in measured[:3000]])
    # 1 sigma of each of the three variances is below 5 %
    assert spreads_agree(numpy.cov(white.T), numpy.eye(3))


def test_the_inner_share_of_an_end_is_that_of_the_simulated_ends_nearer_to_the_mean():
    ends = numpy.random.default_rng(3).standard_normal((4000, 2)) * [0.5, 0.02] + [1.0, 2.0]
    assert inner_share(ends, ends.mean(axis=0)) == 0
    assert inner_share(ends, numpy.array([9.0, 2.0])) == 1
    # in two dimensions, 1 - exp(-d^2 / 2) of a normal distribution is inside; both are one standard deviation away
    for end in [1.5, 2.0], [1.0, 2.02]:
        assert inner_share(ends, numpy.array(end)) == pytest.approx(1 - numpy.exp(-0.5), abs=0.04)
    assert mahalanobis(ends, numpy.array([[1.5, 2.02]])) == pytest.approx(2, rel=0.2)
