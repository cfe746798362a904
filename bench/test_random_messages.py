"""The random sequences and their checks."""
import numpy
import pytest

import random_messages

GOOD = numpy.diag([1.0, 2.0, -1e-13])


@pytest.mark.parametrize('covariance, what', [
    (GOOD, ''),
    (numpy.array([[1.0, 0.0, 0.0], [1e-15, 1.0, 0.0], [0.0, 0.0, 1.0]]), 'not symmetric'),
    (numpy.diag([1.0, 1.0, -1e-11]), 'a negative eigenvalue'),
    (numpy.diag([1.0, numpy.inf, 1.0]), 'not finite'),
    (numpy.zeros((3, 3)), 'no eigenvalue above 0')])
def test_a_bad_covariance_is_found(covariance, what):
    assert random_messages.judge(numpy.zeros(3), covariance)[1] == what


def test_a_pose_that_is_not_finite_is_found():
    assert random_messages.judge(numpy.array([0.0, numpy.nan, 0.0]), GOOD)[1] == 'not finite'
