"""Wheel speeds: a limit preserves the curvature, and the mean over time is the requested speed."""
from hypothesis import given, strategies
import pytest

from rbx1_nav.create.driver.speeds import Rounding, is_too_fast, wheel_speeds

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


@given(strategies.floats(-500, 500), strategies.lists(strategies.floats(0.001, 0.05), min_size=100, max_size=100))
def test_the_mean_is_what_was_asked_for(asked, durations):
    rounding = Rounding()
    sent = rounding.next(asked, 0.0)
    travel = 0.0
    for duration in durations:
        assert abs(sent - asked) <= 1
        travel += sent * duration
        sent = rounding.next(asked, duration)
    # at most 1 mm/s for the longest duration, in both directions
    assert travel == pytest.approx(asked * sum(durations), abs=0.11)


def test_zero_is_zero_at_once():
    rounding = Rounding()
    for _ in range(7):
        rounding.next(0.7, 0.033)
    assert [rounding.next(0.0, 0.033) for _ in range(5)] == [0] * 5


def test_whole_speeds_stay_whole():
    rounding = Rounding()
    assert {rounding.next(200.0, 0.033) for _ in range(50)} == {200}
