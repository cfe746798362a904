"""The statistics of a few end poses that can be computed by hand."""
from math import radians

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.extras.many_runs.summary import Summary

# 5, 10 and 15 cm from the start, 10 degrees to either side of the initial heading
TRUTHS = [Pose(0.03, 0.04, radians(10)), Pose(0.06, -0.08, radians(350)), Pose(-0.15, 0.0, radians(370))]


def lines(method, *runs):
    """Return the lines for runs with these (truth, odometry, estimate)."""
    summary = Summary()
    for truth, odometry, estimate in runs:
        summary.add(truth, odometry, estimate, 0.9 + truth.x)
    return summary.lines(method)


def test_without_a_filter():
    assert lines('odom', *((truth, Pose(truth.x, truth.y + 0.02, 0.0), None) for truth in TRUTHS)) == [
        'odom   truth             -0.020 +- 0.093    -0.013 +- 0.050      3.33 +-  9.43     0.100 +- 0.041',
        '       /odom             -0.020 +- 0.093     0.007 +- 0.050      0.00 +-  0.00     0.101 +- 0.036',
        '       misses its start by 0.100 m (median 0.100, 90 % below 0.140) and 10.0 degrees',
        '       /odom is wrong by 0.020 m (median 0.020, 90 % below 0.020) and 10.0 degrees',
        '       first leg 0.880 m (0.750 to 0.960)']


def test_with_a_filter():
    """The estimate has lines of its own."""
    found = lines('ekf', *((truth, truth, Pose(0.0, 0.0, truth.yaw)) for truth in TRUTHS))
    assert found[2].split()[:4] == ['/odom_ekf', '0.000', '+-', '0.000']
    assert found[5].strip() == '/odom_ekf is wrong by 0.100 m (median 0.100, 90 % below 0.140) and 0.0 degrees'
