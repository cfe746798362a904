"""The random sequences and their checks."""
from collections import Counter
import random

import numpy
import pytest

import random_messages
from rbx1_nav.base.readings import MIN_VARIANCE
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter import combined_odometry
from rbx1_nav.filter.inputs import MAX_VARIANCE, Imu
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors

GOOD = numpy.diag([1.0, 2.0, 3.0])


@pytest.mark.parametrize('bad, what', [
    (numpy.array([[1.0, 0.0, 0.0], [1e-15, 1.0, 0.0], [0.0, 0.0, 1.0]]), 'not symmetric'),
    (numpy.diag([1.0, 1.0, -1e-11]), 'a negative eigenvalue'),
    (numpy.diag([1.0, numpy.inf, 1.0]), 'not finite'),
    (numpy.zeros((3, 3)), 'no eigenvalue above 0'),
])
def test_the_first_bad_covariance_is_found(bad, what):
    ratio, at, text = random_messages.judge(numpy.zeros((4, 3)), numpy.array([GOOD, GOOD, bad, bad]))
    assert at == 2 and text == what and ratio <= 1 / 3


def test_good_covariances_pass():
    ratio, at, _ = random_messages.judge(numpy.zeros((3, 3)), numpy.array([GOOD, numpy.diag([1.0, 1.0, -1e-13]), GOOD]))
    assert at is None and ratio == pytest.approx(-1e-13)


def test_a_pose_that_is_not_finite_is_found():
    poses = numpy.zeros((2, 3))
    poses[1, 2] = numpy.nan
    assert random_messages.judge(poses, numpy.array([GOOD, GOOD]))[1:] == (1, 'not finite')


def test_a_sequence_can_be_repeated():
    once, again = (random_messages.run({'unknown': UNKNOWN_FLOOR}, 300, 7) for _ in range(2))
    assert once == again and once['counts']['messages'] >= 300


def test_the_sequences_have_every_fault():
    """Gaps up to 1e7 s, all variances, duplicated and swapped messages, and each warning of the filter."""
    gap, variances, doubled, swapped, counts = 0, [], 0, 0, Counter()
    for seed in range(40):
        messages = [message for _, message in random_messages.make_messages(random.Random(seed), 500)]
        imus = [message for message in messages if isinstance(message, Imu)]
        stamps = [imu.stamp for imu in imus]
        gap = max([gap] + [after - before for before, after in zip(stamps, stamps[1:])])
        variances += [imu.variance for imu in imus]
        doubled += sum(one is other for one, other in zip(messages, messages[1:]))
        swapped += sum(after < before for before, after in zip(stamps, stamps[1:]))
        counts.update(random_messages.run({'ideal': priors(None)}, 500, seed)['counts'])
    assert 5e6 * SECOND < gap < 2e7 * SECOND    # two gaps may be consecutive
    assert MIN_VARIANCE <= min(variances) < 1e-11 and 1e11 < max(variances) <= MAX_VARIANCE
    assert doubled > 50 and swapped > 50
    assert all(counts[name] for name in ('dropouts', 'recoveries', 'restarts', 'outliers', 'contradictions'))
    assert counts['rejected'] < 0.1 * counts['messages'] and counts['late estimates'] > 0.2 * counts['estimates']


def test_an_exception_of_the_filter_is_a_failure(monkeypatch):
    monkeypatch.setattr(combined_odometry.CombinedOdometry, '_step', lambda self, odom: 1 / 0)
    assert 'ZeroDivisionError' in random_messages.run({'unknown': UNKNOWN_FLOOR}, 100, 0)['failure']
