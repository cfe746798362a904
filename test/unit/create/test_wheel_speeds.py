"""Wheel speeds: a limit preserves the curvature."""
from hypothesis import given, strategies
import pytest

from rbx1_nav.create.driver.exchange import is_too_fast, wheel_speeds

SPEEDS = strategies.floats(-10, 10)


@given(SPEEDS, SPEEDS)
def test_the_limit_does_not_bend_the_curve(linear, angular):
    left, right = wheel_speeds(linear, angular, 0.26)
    assert max(abs(left), abs(right)) <= 500.001
    assert is_too_fast(linear, angular, 0.26) == (abs(linear) + 0.13 * abs(angular) > 0.5)
    # the ratio of the speeds determines the curvature
    asked_left, asked_right = linear - 0.13 * angular, linear + 0.13 * angular
    assert left * asked_right == pytest.approx(right * asked_left, abs=1e-6)


def test_below_the_limit_nothing_changes():
    assert wheel_speeds(0.2, 1.0, 0.26) == pytest.approx((70, 330))
