"""Wheels and gyro are compared in periods in which both have measured a motion."""
import pytest

from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.filter.filter import Filter
from rbx1_nav.filter.pose_errors import BIAS, PERIOD
from rbx1_nav.filter.priors import UNKNOWN_FLOOR


def test_a_period_in_which_the_gyro_has_not_measured_is_not_compared():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    for gyro in (0.5, 1e-8), None, (0.1, 1e-8):
        assert ekf.compare(PERIOD / 2, 0.1, gyro, 0.1) is None
    assert ekf.compare(PERIOD / 2, 0.1, (0.1, 1e-8), 0.1) == ''
    assert ekf.turned == pytest.approx(0.2) and abs(ekf.error[BIAS]) < 1e-6


def test_a_robot_that_hardly_moves_is_not_compared():
    ekf = Filter(UNKNOWN_FLOOR, ORIGIN)
    assert all(ekf.compare(PERIOD, 0.005, (0.1, 1e-8), 0.01) is None for _ in range(10))
    assert ekf.error[BIAS] == 0.0
