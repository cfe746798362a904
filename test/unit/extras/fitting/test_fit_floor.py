"""The covariance of the floor's noise, and the values that windows determine."""
import numpy
import pytest

from rbx1_nav.extras.fitting.comparison import simulate_paths
from rbx1_nav.extras.fitting.floor_fit import MEANS, Fitter
from rbx1_nav.extras.fitting.prediction import Covariance, Prediction
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from sample_runs import EXERCISE, FLOOR, FORWARD, LEFT, REST, record

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


def test_rounding_in_a_turn_is_no_path():
    run = PreparedRun(record((REST, FORWARD, REST, LEFT, REST)), 0.26, start=8.0)       # from the turn on
    prediction = Prediction(FLOOR, run.steps(FLOOR), Windows(numpy.array([0]), len(run.times) - 1, numpy.zeros((1, 3))))
    assert numpy.abs(prediction.straight).sum() > 5 / FLOOR.ticks_meter     # both encoders round
    assert prediction.paths()['travelled'].sum() == 0.0


@pytest.mark.parametrize('window, excess', [(4.0, 3 / 8), (1.0, 3 / 2), (0.25, 3)])
def test_the_errors_of_a_few_cells_have_an_excess_kurtosis(window, excess):
    """Of windows at 0.2 m/s: 3 divided by the number of cells of 0.1 m, at least 1."""
    run = PreparedRun(record((REST, (0.2, 0.0, 800), REST))._replace(truth=None), 0.26, 3.0, 17.0)
    first = numpy.arange(0, 240, round(window / 0.05))
    fitter = Fitter([run], [Windows(first, round(window / 0.05), numpy.zeros((len(first), 3)))], QUIET)
    assert fitter.excess(FLOOR, 'distance_noise') == pytest.approx(excess, rel=0.1)
    assert fitter.excess(FLOOR, 'slip_straight_spread') == 0.0
