"""The model of the filter: the state, the measurements of wheels and gyro, and the change of the state in a step.

Both sensors measure the same turn. The wheels slip by a fraction of their travel, which varies along the path. The gyro
has a bias and a scale error. These errors are part of the state, after the pose:

    x, y (m), yaw (rad), gyro bias (rad/s), gyro scale error, slip turning, slip straight (fractions of the travel)

In each step the wheels report a turn W, which corresponds to a turn of W (1 - slip turning) of the robot. The gyro's
rates add up to G, which corresponds to a turn of (G - bias * time) / (1 + scale error). The difference of these two
turns, which should be 0, is a measurement of the errors. Their mean, weighted by the inverse variances, is the turn of
the step. The noise of this mean and the noise of the difference are uncorrelated (the Gauss-Markov theorem), so using
one after the other loses no information and counts none twice.
"""
from __future__ import annotations

from math import cos, sin
from operator import add
from typing import NamedTuple, Sequence, Tuple

import numpy

from rbx1_nav.arrays import Array

X, Y, YAW, BIAS, SCALE, TURNING, STRAIGHT = range(7)    # indices of the state

Measurement = Tuple[float, float]   # a turn (rad) and its variance (rad^2)


class HeadingChange(NamedTuple):
    """The turn of a step, and its derivatives with respect to the errors of the sensors."""

    angle: float        # rad
    variance: float     # rad^2
    by_bias: float
    by_scale: float
    by_slip: float


class Turns(NamedTuple):
    """One turn as measured by both sensors."""

    time: float             # s
    wheels: float           # rad
    wheel_variance: float   # rad^2
    gyro: float             # rad
    gyro_variance: float    # rad^2

    def plus(self, other: Turns) -> Turns:
        """Return the sum of two successive turns."""
        return Turns._make(map(add, self, other))


class Step(NamedTuple):
    """The state after a step."""

    state: list[float]
    F: Array                # 3x7: derivatives of x, y and yaw with respect to the previous state
    by_turn: Sequence[float]    # derivatives of x, y and yaw with respect to the turn
    by_distance: Sequence[float]    # derivatives of x and y with respect to the distance


def turn_by_wheels(state: Sequence[float], wheels: Measurement) -> HeadingChange:
    """Return the turn that the wheels measure."""
    angle, variance = wheels
    grip = 1 - state[TURNING]
    return HeadingChange(angle * grip, variance * grip ** 2, 0.0, 0.0, -angle)


def turn_by_gyro(state: Sequence[float], gyro: Measurement, time: float) -> HeadingChange:
    """Return the turn that the gyro measures in a time (s)."""
    scale = 1 + state[SCALE]
    angle = (gyro[0] - state[BIAS] * time) / scale
    return HeadingChange(angle, gyro[1] / scale ** 2, -time / scale, -angle / scale, 0.0)


def mean_turn(state: Sequence[float], turns: Turns) -> HeadingChange:
    """Return the mean of both turns, weighted by their inverse variances."""
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    angle = (turns.gyro - state[BIAS] * turns.time) / scale
    wheel_noise, gyro_noise = turns.wheel_variance * grip ** 2, turns.gyro_variance / scale ** 2
    share = gyro_noise / (wheel_noise + gyro_noise)     # weight of the wheels
    return HeadingChange(share * turns.wheels * grip + (1 - share) * angle, share * wheel_noise,
                         (share - 1) * turns.time / scale, (share - 1) * angle / scale, -share * turns.wheels)


def innovation(state: Sequence[float], turns: Turns) -> tuple[float, float]:
    """Return the gyro's turn minus the wheels' turn (rad), and the variance R of the noise in this difference (rad^2).

    The measured value is 0, and the value predicted from the state is the wheels' turn minus the gyro's turn.
    """
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    return ((turns.gyro - state[BIAS] * turns.time) / scale - turns.wheels * grip,
            turns.wheel_variance * grip ** 2 + turns.gyro_variance / scale ** 2)


def innovation_derivatives(state: Sequence[float], turns: Turns) -> Array:
    """Return H, the derivatives of the predicted value of innovation() with respect to the state.

    The result has the elements from BIAS to TURNING; the others are 0. Noise that is both in a measurement and in its
    derivative does not average out. So the slip's derivative uses the gyro's turn, because the wheels' turn is rounded
    to ticks. If the wheels are stationary, the gyro's turn is only noise.
    """
    scale, grip = 1 + state[SCALE], 1 - state[TURNING]
    turned = (turns.gyro - state[BIAS] * turns.time) / scale if turns.wheels else 0.0
    return numpy.array([turns.time / scale, turned / scale, -turned / grip])


def move(state: Sequence[float], turn: HeadingChange, direction: float, forward: float, left: float) -> Step:
    """Return the state after a turn and a displacement, see Filter.predict()."""
    x, y, yaw, bias, scale, turning, straight = state
    middle = yaw + turn.angle / 2 + direction
    c, s = cos(middle), sin(middle)
    grip = 1 - straight
    along, across = forward * c - left * s, forward * s + left * c
    # derivatives of x and y with respect to the heading halfway, which depends on half of the turn
    dx, dy = -grip * across, grip * along
    F = numpy.array([
        [1.0, 0.0, dx, dx / 2 * turn.by_bias, dx / 2 * turn.by_scale, dx / 2 * turn.by_slip, -along],
        [0.0, 1.0, dy, dy / 2 * turn.by_bias, dy / 2 * turn.by_scale, dy / 2 * turn.by_slip, -across],
        [0.0, 0.0, 1.0, turn.by_bias, turn.by_scale, turn.by_slip, 0.0]])
    return Step([x + grip * along, y + grip * across, yaw + turn.angle, bias, scale, turning, straight],
                F, (dx / 2, dy / 2, 1.0), (c, s))
