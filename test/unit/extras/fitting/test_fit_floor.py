"""The covariance of the floor's noise, and the values that windows determine."""
import numpy
import pytest

from rbx1_nav.extras.fitting.comparison import simulate_paths
from rbx1_nav.extras.fitting.floor_fit import MEANS, Fitter
from rbx1_nav.extras.fitting.prediction import Covariance, Prediction
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from sample_runs import EXERCISE, FLOOR, FORWARD, REST, record

QUIET = 1e-4, 1e-4, 1e-4    # m, m, rad


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
    assert covariance[0][0] ** 0.5 < MEANS['slip_straight'][1]
    assert covariance[1][1] ** 0.5 > MEANS['slip_turning'][1]
