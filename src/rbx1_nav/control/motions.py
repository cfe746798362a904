"""The timed exercise: a list of motions, each a velocity for a number of ticks."""
from __future__ import annotations

from math import isfinite
from typing import NamedTuple

MAX_TICKS = 10 ** 8    # three weeks at 50 Hz


class Motion(NamedTuple):
    """One motion: the same command for a number of ticks."""

    name: str
    linear: float   # m/s
    angular: float  # rad/s, positive to the left
    ticks: int


def whole_ticks(number: float, formula: str) -> int:
    """Return a number of ticks, rounded down. Raises ValueError if it is below 1 or above MAX_TICKS.

    formula: how the number was calculated, for the error message.
    """
    if not (isfinite(number) and 1 <= number + 1e-9 <= MAX_TICKS):
        raise ValueError(f'{formula}: {number:g} ticks: expected from 1 to {MAX_TICKS}')
    # 0.3 / 0.1 is a little less than 3 in floating point: do not lose a tick to that
    return int(number + 1e-9)


def ticks(goal: float, speed: float, rate: float, keys: str = 'goal / speed') -> int:
    """Return the number of ticks that it takes to cover `goal` (m or rad) at `speed` (m/s or rad/s), rounded down.

    rate: ticks per second; keys: names of goal and speed, for the error message. Raises ValueError, see whole_ticks().
    """
    return whole_ticks(goal / speed * rate, f'{keys} * rate: {goal:g} / {speed:g} * {rate:g}')


def out_and_back(linear_speed: float, goal_distance: float, angular_speed: float, goal_angle: float,
                 rate: float) -> list[Motion]:
    """Return the tutorial's exercise (forward and turn left, twice) as four Motions. Raises ValueError, see ticks().

    The arguments are in m/s, m, rad/s, rad and Hz.
    """
    forward = Motion('forward', linear_speed, 0.0,
                     ticks(goal_distance, linear_speed, rate, 'goal_distance / linear_speed'))
    turn = Motion('turn left', 0.0, angular_speed, ticks(goal_angle, angular_speed, rate, 'goal_angle / angular_speed'))
    return [forward, turn, forward, turn]
