"""The statistics of a few end poses that can be computed by hand."""
from math import radians
import statistics

import numpy
import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.extras.many_runs.summary import Spread, Summary

# 5, 10 and 15 cm from the start, 10 degrees to either side of the initial heading
TRUTHS = [Pose(0.03, 0.04, radians(10)), Pose(0.06, -0.08, radians(350)), Pose(-0.15, 0.0, radians(370))]


def lines(method, *runs):
    """Return the lines for runs with these (truth, odometry, estimate)."""
    summary = Summary()
    for some in filter(None, (runs[:1], runs[1:])):     # in two blocks
        truths, odometry, estimates = map(numpy.array, zip(*some))
        summary.add(truths, odometry, None if estimates[0] is None else estimates, 0.9 + truths[:, 0])
    return summary.lines(method)


def test_without_a_filter():
    assert lines('odom', *((truth, Pose(truth.x, truth.y + 0.02, 0.0), None) for truth in TRUTHS)) == [
        'odom   truth             -0.020 +- 0.114    -0.013 +- 0.061      3.33 +- 11.55     0.100 +- 0.050',
        '       /odom             -0.020 +- 0.114     0.007 +- 0.061      0.00 +-  0.00     0.101 +- 0.044',
        '       misses its start by 0.100 m (median 0.100, 90 % below 0.140) and 10.0 degrees',
        '       /odom is wrong by 0.020 m (median 0.020, 90 % below 0.020) and 10.0 degrees',
        '       first leg 0.880 m (0.750 to 0.960)']


def test_with_a_filter():
    """The estimate has lines of its own."""
    found = lines('ekf', *((truth, truth, Pose(0.0, 0.0, truth.yaw)) for truth in TRUTHS))
    assert found[2].split()[:4] == ['/odom_ekf', '0.000', '+-', '0.000']
    assert found[5].strip() == '/odom_ekf is wrong by 0.100 m (median 0.100, 90 % below 0.140) and 0.0 degrees'


@pytest.mark.parametrize('sizes', [(7,), (1, 6), (2, 1, 4)])
def test_a_spread_does_not_depend_on_the_blocks(sizes):
    values = 1e3 + numpy.array([[3.0, -1.0, 4.0, 1.5, -9.0, 2.6, 5.0], [5.0, 35.0, 8.0, 97.0, 9.0, 3.0, 2.0]])
    spread = Spread(2)
    for part in numpy.split(values, numpy.cumsum(sizes)[:-1], axis=1):
        spread.add(*part)
    # with n - 1, as pandas' describe()
    assert spread.texts() == [f'{statistics.mean(row):8.3f} +- {statistics.stdev(row):5.3f}' for row in values.tolist()]


def test_a_single_run_has_no_deviation():
    assert lines('odom', (TRUTHS[0], TRUTHS[0], None))[0].count('+- 0.000') == 3
