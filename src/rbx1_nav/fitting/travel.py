"""Converts commands or odometry to the wheel travel in small steps."""
from __future__ import annotations

from typing import NamedTuple

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.fitting.recording import Commands, Track
from rbx1_nav.simulation.surfaces import Surface
from rbx1_nav.simulation.motors import Motor

STEP = 0.05     # s


class Steps(NamedTuple):
    """The wheel travel in each step, as measured by the encoders."""

    time: Array         # s; one value more than the others, the start of the first step
    straight: Array     # m
    turn: Array         # rad


def grid(start: float, end: float) -> Array:
    """Return times from `start` to `end` (s), STEP apart."""
    return start + STEP * numpy.arange(int((end - start) / STEP) + 1)


def commanded_travel(surface: Surface, base_width: float, commands: Commands, times: Array) -> Steps:
    """Return the Steps between `times` (s) of motors on a Surface that were at rest before the first of the Commands.

    base_width: m.
    """
    changes = numpy.flatnonzero(numpy.append(True, numpy.diff(commands.linear) != 0)
                                | numpy.append(True, numpy.diff(commands.angular) != 0))
    starts = commands.time[changes] + surface.delay
    linear, angular = commands.linear[changes], commands.angular[changes] * base_width / 2
    borders = numpy.unique(numpy.concatenate([starts, times]))
    borders = borders[borders <= times[-1]]
    in_force = numpy.searchsorted(starts, borders[:-1], side='right') - 1
    straight = Motor(surface.lag, surface.accel_limit, surface.drag_straight)
    turning = Motor(surface.lag, surface.accel_limit, surface.drag_turning)
    travelled = [(straight.travel(linear[index], duration), turning.travel(angular[index], duration)) if index >= 0
                 else (0.0, 0.0) for index, duration in zip(in_force.tolist(), numpy.diff(borders).tolist())]
    step = numpy.searchsorted(times, borders[:-1], side='right') - 1
    travel = numpy.array(travelled).reshape(-1, 2)[step >= 0].T
    distance, side = numpy.array([numpy.bincount(step[step >= 0], values, len(times) - 1) for values in travel])
    return Steps(times, distance, 2 * side / base_width)


def reported_travel(odometry: Track, times: Array) -> Steps:
    """Return the Steps between `times` (s) according to the odometry."""
    x, y, yaw = (numpy.interp(times, odometry.time, values) for values in odometry[1:])
    turn = numpy.diff(yaw)
    middle = yaw[:-1] + turn / 2
    chord = numpy.diff(x) * numpy.cos(middle) + numpy.diff(y) * numpy.sin(middle)
    return Steps(times, chord / numpy.sinc(turn / 2 / numpy.pi), turn)      # the inverse of Odometry.move()
