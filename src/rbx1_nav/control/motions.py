"""The exercise by time alone: a list of motions, each a velocity for a number of ticks."""
from collections import namedtuple
from math import isfinite

Motion = namedtuple('Motion', 'name linear angular ticks')
Motion.__doc__ = 'One motion: linear in m/s, angular in rad/s (positive to the left), for a number of ticks.'


def ticks(goal, speed, rate):
    """Number of ticks, at `rate` per second, to cover `goal` (m or rad) at `speed` (m/s or rad/s), rounded down.

    Raises ValueError if that is less than one tick or more than a day.
    """
    number = goal / speed * rate
    if not (isfinite(number) and 1 <= number + 1e-9 <= 24 * 3600 * rate):
        raise ValueError('goal %g / speed %g * rate %g = %g ticks: expected between 1 tick and a day of them'
                         % (goal, speed, rate, number))
    # 0.3 / 0.1 is a little less than 3 in floating point: do not lose a tick to that
    return int(number + 1e-9)


def out_and_back(linear_speed, goal_distance, angular_speed, goal_angle, rate):
    """The tutorial's exercise: forward and turn left, twice, as four Motions. Raises ValueError, see ticks()."""
    try:
        forward = Motion('forward', linear_speed, 0.0, ticks(goal_distance, linear_speed, rate))
    except ValueError as error:
        raise ValueError(f'goal_distance, linear_speed: {error}')
    try:
        turn = Motion('turn left', 0.0, angular_speed, ticks(goal_angle, angular_speed, rate))
    except ValueError as error:
        raise ValueError(f'goal_angle, angular_speed: {error}')
    return [forward, turn, forward, turn]
