"""The random sequences and their checks."""
import random

import numpy
import pytest

import random_messages
from rbx1_nav.base.readings import MIN_VARIANCE
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.inputs import MAX_VARIANCE, Imu

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


def test_the_sequences_have_every_fault():
    """Gaps up to 1e7 s, all variances, duplicated and swapped messages."""
    gap, variances, doubled, swapped = 0, [], 0, 0
    for seed in range(40):
        messages = [message for _, message in random_messages.make_messages(random.Random(seed), 500)]
        imus = [message for message in messages if isinstance(message, Imu)]
        stamps = [imu.stamp for imu in imus]
        gap = max([gap] + [after - before for before, after in zip(stamps, stamps[1:])])
        variances += [imu.variance for imu in imus]
        doubled += sum(one is other for one, other in zip(messages, messages[1:]))
        swapped += sum(after < before for before, after in zip(stamps, stamps[1:]))
    assert 5e6 * SECOND < gap < 2e7 * SECOND    # two gaps may be consecutive
    assert MIN_VARIANCE <= min(variances) < 1e-11 and 1e11 < max(variances) <= MAX_VARIANCE
    assert doubled > 50 and swapped > 50
