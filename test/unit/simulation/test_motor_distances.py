"""The distances and times of a motor, against the solution of its equation by hand."""
from math import exp, log

import pytest

from rbx1_nav.simulation.motors import Motor

SIGNS = pytest.mark.parametrize('sign', [1, -1])
ROUNDING = 1e-12    # m or m/s: a few roundings of numbers of the order of 1


def moving(speed, lag, accel_limit, drag):
    motor = Motor(lag, accel_limit, drag)
    motor.speed = speed
    return motor


def is_at(motor, speed):
    return motor.speed == pytest.approx(speed, abs=ROUNDING)


@SIGNS
def test_a_reversal_at_the_acceleration_limit(sign):
    motor = moving(sign * 0.5, 0.01, 2.0, 0.01)
    # 0.5 m/s takes 0.25 s at 2 m/s^2: 1/16 m; then back for as long
    assert motor.travel(-sign * 1.0, 0.25) == pytest.approx(sign / 16, abs=ROUNDING) and is_at(motor, 0.0)
    assert motor.travel(-sign * 1.0, 0.25) == pytest.approx(-sign / 16, abs=ROUNDING) and is_at(motor, -sign * 0.5)
    motor.speed = sign * 0.5
    assert motor.travel(-sign * 1.0, 0.375) == pytest.approx(sign * (1 / 16 - 1 / 64), abs=ROUNDING)
    assert is_at(motor, -sign * 0.25)


@SIGNS
def test_a_start_at_the_acceleration_limit_and_then_with_the_lag(sign):
    motor = Motor(0.1, 1.0, 0.05)
    # the final speed is 0.55 - 0.05; the limit ends 0.1 m/s below it, after 0.4 s and 0.08 m
    travel = motor.travel(sign * 0.55, 0.4)
    assert travel == pytest.approx(sign * 0.08, abs=ROUNDING) and is_at(motor, sign * 0.4)
    # then the gap of 0.1 m/s closes by a factor of e in each 0.1 s
    travel = motor.travel(sign * 0.55, 0.3)
    assert travel == pytest.approx(sign * (0.5 * 0.3 - 0.1 * 0.1 * (1 - exp(-3))), abs=ROUNDING)
    assert is_at(motor, sign * (0.5 - 0.1 * exp(-3)))


@SIGNS
def test_a_stop_with_the_lag_and_the_drag(sign):
    # v = -drag + (speed + drag) exp(-t / lag) is 0 at t = lag log(1 + speed / drag), after lag * speed - drag * t
    time = 0.2 * log(1 + 0.1 / 0.05)
    for duration in time + 1e-9, 5.0:
        motor = moving(sign * 0.1, 0.2, 10.0, 0.05)
        assert motor.travel(0.0, duration) == pytest.approx(sign * (0.2 * 0.1 - 0.05 * time), abs=ROUNDING)
        assert motor.speed == 0.0
    motor = moving(sign * 0.1, 0.2, 10.0, 0.05)
    motor.travel(0.0, 0.9 * time)
    assert motor.speed * sign > 0


@SIGNS
def test_a_reversal_with_the_lag(sign):
    # to the speed 0 with the drag on one side, and from there with the drag on the other side
    forth, back = 0.2 * log(1 + 0.1 / 0.15), 0.3
    motor = moving(sign * 0.1, 0.2, 10.0, 0.05)
    expected = 0.2 * 0.1 - 0.15 * forth - (0.05 * back - 0.05 * 0.2 * (1 - exp(-back / 0.2)))
    assert motor.travel(-sign * 0.1, forth + back) == pytest.approx(sign * expected, abs=ROUNDING)
    assert is_at(motor, -sign * 0.05 * (1 - exp(-back / 0.2)))
