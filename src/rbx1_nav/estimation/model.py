"""The model of the filter: the state, what wheels and gyro measure of it, and how it changes in a step.

Both sensors measure the same turn. The wheels slip by a fraction of their travel, which changes on the way; the gyro
has a bias and a scale error. These errors are part of the state, after the pose:

    x, y (m), yaw (rad), gyro bias (rad/s), gyro scale error, slip turning, slip straight (fractions of the travel)

In each step the wheels report a turn W, of which the robot makes W (1 - slip turning), and the gyro's rates add up to
G, which stands for a turn of (G - bias * time) / (1 + scale error). The difference of the two, which should be 0, is a
measurement of the errors. Their mean, weighted by the inverse variances, is the turn of the step. The noise of that
mean and the noise of the difference are uncorrelated (the Gauss-Markov theorem), so using one after the other loses no
information and counts none twice.
"""
from __future__ import annotations

from math import cos, sin
from operator import add
from typing import NamedTuple, Sequence, Tuple

import numpy

from rbx1_nav.arrays import Array

X, Y, YAW, BIAS, SCALE, TURNING, STRAIGHT = range(7)    # of the state

Measurement = Tuple[float, float]   # a turn (rad) and its variance (rad^2)


class HeadingChange(NamedTuple):
    """The turn of a step, and its derivatives by the errors of the sensors."""

    angle: float        # rad
    variance: float     # rad^2
    by_bias: float
    by_scale: float
    by_slip: float


class Turns(NamedTuple):
    """One turn as both sensors have measured it."""

    time: float             # s
    wheels: float           # rad
    wheel_variance: float   # rad^2
    gyro: float             # rad
    gyro_variance: float    # rad^2

    def plus(self, other: Turns) -> Turns:
        """Both turns, one after the other."""
        return Turns._make(map(add, self, other))


class Step(NamedTuple):
    """The state after a step."""

    state: list[float]
    F: Array                # 3x7: derivatives of x, y and yaw by the state before
    by_turn: Sequence[float]    # derivatives of x, y and yaw by the turn
    by_distance: Sequence[float]    # and of x and y by the distance


def turn_by_wheels(state: Sequence[float], wheels: Measurement) -> HeadingChange:
    """The turn that the wheels measure."""
    angle, variance = wheels
    grip = 1 - state[TURNING]
    return HeadingChange(angle * grip, variance * grip ** 2, 0.0, 0.0, -angle)


def turn_by_gyro(state: Sequence[float], gyro: Measurement, time: float) -> HeadingChange:
    """The turn that the gyro measures in a time (s)."""
    scale = 1 + state[SCALE]
    angle = (gyro[0] - state[BIAS] * time) / scale
    return HeadingChange(angle, gyro[1] / scale ** 2, -time / scale, -angle / scale, 0.0)


def mean_turn(state: Sequence[float], turns: Turns) -> HeadingChange:
    """The mean of both turns, weighted by their inverse variances."""
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    angle = (turns.gyro - state[BIAS] * turns.time) / scale
    wheel_noise, gyro_noise = turns.wheel_variance * grip ** 2, turns.gyro_variance / scale ** 2
    share = gyro_noise / (wheel_noise + gyro_noise)     # of the wheels
    return HeadingChange(share * turns.wheels * grip + (1 - share) * angle, share * wheel_noise,
                         (share - 1) * turns.time / scale, (share - 1) * angle / scale, -share * turns.wheels)


def innovation(state: Sequence[float], turns: Turns) -> tuple[float, float]:
    """The turn by the gyro less that by the wheels (rad), and the variance R of the noise in it (rad^2).

    The measured value is 0, and what the state predicts for it is the turn by the wheels less that by the gyro.
    """
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    return ((turns.gyro - state[BIAS] * turns.time) / scale - turns.wheels * grip,
            turns.wheel_variance * grip ** 2 + turns.gyro_variance / scale ** 2)


def innovation_derivatives(state: Sequence[float], turns: Turns) -> Array:
    """H: the derivatives of the predicted value of innovation() by the state from BIAS to TURNING; the others are 0.

    Noise that is both in a measurement and in its derivative does not average out. So the slip's derivative uses the
    gyro's turn, since the wheels' is rounded to ticks; where the wheels stand, the gyro's turn is all noise.
    """
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    turned = (turns.gyro - state[BIAS] * turns.time) / scale if turns.wheels else 0.0
    return numpy.array([turns.time / scale, turned / scale, -turned / grip])


def move(state: Sequence[float], turn: HeadingChange, direction: float, forward: float, left: float) -> Step:
    """The state after a turn and a displacement, as of Filter.predict()."""
    x, y, yaw, bias, scale, turning, straight = state
    middle = yaw + turn.angle / 2 + direction
    c, s = cos(middle), sin(middle)
    grip = 1 - straight
    along, across = forward * c - left * s, forward * s + left * c
    # derivatives of x and y by the heading half way, which depends on half of the turn
    dx, dy = -grip * across, grip * along
    F = numpy.array([
        [1.0, 0.0, dx, dx / 2 * turn.by_bias, dx / 2 * turn.by_scale, dx / 2 * turn.by_slip, -along],
        [0.0, 1.0, dy, dy / 2 * turn.by_bias, dy / 2 * turn.by_scale, dy / 2 * turn.by_slip, -across],
        [0.0, 0.0, 1.0, turn.by_bias, turn.by_scale, turn.by_slip, 0.0]])
    return Step([x + grip * along, y + grip * across, yaw + turn.angle, bias, scale, turning, straight],
                F, (dx / 2, dy / 2, 1.0), (c, s))
