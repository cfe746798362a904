"""The covariance of the floor's noise, and the values that windows determine."""
from hypothesis import given, strategies as st
import numpy
import pytest

from rbx1_nav.fitting.comparison import simulate_paths
from rbx1_nav.fitting.floor_fit import MEANS, Fitter
from rbx1_nav.fitting.prediction import Covariance, Prediction
from rbx1_nav.fitting.run import PreparedRun, Windows
from rbx1_nav.simulation.floor_noise import cell_covariance, cell_errors
from sample_runs import EXERCISE, FLOOR, FORWARD, REST, record

QUIET = 1e-4, 1e-4, 1e-4    # m, m, rad


@given(st.lists(st.floats(0.0, 2.0), min_size=1, max_size=12), st.floats(0.05, 1.0), st.integers(1, 5))
def test_the_variance_after_a_path_does_not_depend_on_its_steps(steps, cell, parts):
    finer = numpy.repeat(numpy.array(steps) / parts, parts)
    variances = [cell_covariance(numpy.ones((1, len(path))), numpy.array(path), cell).item()
                 for path in (steps, [sum(steps)], finer)]
    assert variances == pytest.approx(3 * variances[:1], abs=1e-9)
    # never more than white noise, and smaller by a third of a cell on a path of many cells
    assert variances[0] <= sum(steps) + 1e-9
    assert variances[0] >= sum(steps) - cell / 3 - 1e-9


def test_the_covariance_is_that_of_simulated_noise():
    path = numpy.array([0.02, 0.3, 0.0, 0.05, 0.2, 0.1])
    errors = cell_errors(numpy.random.default_rng(1), 100000, path, 0.25)
    # 1 sigma of an estimated variance is 0.5 % for a normal distribution, and 0.8 % for these tails
    assert numpy.cov(errors.T) == pytest.approx(cell_covariance(numpy.eye(len(path)), path, 0.25), abs=0.01)


def test_ends_have_the_predicted_covariance():
    run = PreparedRun(record(EXERCISE), 0.26)
    prediction = Prediction(FLOOR, run.steps(FLOOR), Windows(numpy.array([0]), len(run.times) - 1, numpy.zeros((1, 3))))
    ends = simulate_paths(FLOOR, prediction, 0, 20000, numpy.random.default_rng(2))[:, :, -1]
    roots = Covariance(FLOOR, prediction.sensitivities(by_cells=True), numpy.diag(numpy.square(QUIET))).roots[0]
    spreads = [prediction.sensitivities()[key][0] * getattr(FLOOR, key)
               for key in ('slip_straight_spread', 'slip_turning_spread')]
    expected = roots @ roots.T + sum(numpy.outer(one, one) for one in spreads)
    # first order only: errors of 0.1 rad change the path by a few percent
    assert numpy.diag(numpy.cov(ends.T)) == pytest.approx(numpy.diag(expected), rel=0.1)


def test_what_the_runs_do_not_tell_has_a_large_standard_error():
    run = PreparedRun(record((REST, FORWARD, REST)), 0.26)
    _, covariance = Fitter([run], [run.windows(2.0)], QUIET, by_cells=True).fit_means(FLOOR, ['slip_straight',
                                                                                        'slip_turning'])
    assert covariance[0, 0] ** 0.5 < MEANS['slip_straight'][1]
    assert covariance[1, 1] ** 0.5 > MEANS['slip_turning'][1]
