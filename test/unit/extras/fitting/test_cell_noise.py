"""The noise of a floor for many runs at once has the variance of its path, whatever its steps, and is that of a run."""
import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.extras.fitting.cell_noise import cell_covariance, cell_errors


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
    assert errors.T @ errors / len(errors) == pytest.approx(cell_covariance(numpy.eye(len(path)), path, 0.25), abs=0.01)
    # large errors are as frequent as in the noise of one run, see above
    assert 5 < (errors[:, 1] ** 4).mean() / errors[:, 1].var() ** 2 < 7
