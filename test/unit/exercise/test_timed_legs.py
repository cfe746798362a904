"""The timed exercise: the numbers of ticks of its motions."""
from math import inf

import pytest

from rbx1_nav.exercise.legs import out_and_back, ticks


@pytest.mark.parametrize('goal, speed, rate, expected', [(0.3, 0.1, 50, 150), (1.0, 0.3, 50, 166), (0.1, 0.5, 5, 1)])
def test_ticks_are_rounded_down_but_float_error_costs_none(goal, speed, rate, expected):
    assert ticks(goal, speed, rate) == expected


@pytest.mark.parametrize('goal, speed', [(1e-9, 1.0), (1e300, 1e-300), (1.0, 1e-9), (inf, 1.0)])
def test_a_motion_shorter_than_a_tick_or_longer_than_a_day_is_rejected(goal, speed):
    with pytest.raises(ValueError, match='expected from 1 to 100000000'):
        ticks(goal, speed, 50)


@pytest.mark.parametrize('change, text', [
    (dict(linear_speed=1e-9), 'goal_distance / linear_speed * rate: 1 / 1e-09 * 50: 5e+10 ticks'),
    (dict(angular_speed=1e3), 'goal_angle / angular_speed * rate: 3 / 1000 * 50: 0.15 ticks')])
def test_the_error_shows_the_calculation(change, text):
    with pytest.raises(ValueError) as error:
        out_and_back(**dict(dict(linear_speed=0.2, goal_distance=1.0, angular_speed=1.0, goal_angle=3.0, rate=50),
                            **change))
    assert str(error.value) == f'{text}: expected from 1 to 100000000'
