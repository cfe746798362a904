"""The floors of many runs whose wheels travel alike, computed at once: each pose has one number per run.

Single runs give the same results, to the last bit.
"""
from __future__ import annotations

from math import cos, sin
from typing import Any, Callable, Sequence

import numpy

from rbx1_nav.base.kinematics import SMALL, Odometry
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import Array
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.floor_noise import Noise, Roughness, draw_noises, is_rough
from rbx1_nav.simulation.slip import RandomErrors, draw_run, floor_travel


def each(function: Callable[[float], float], values: Sequence[float]) -> Array:
    """Return the values of a function of math: numpy's own may differ in the last bit, depending on the processor."""
    return numpy.fromiter(map(function, values), float, len(values))


class Odometries(Odometry):
    """The poses of many robots."""

    def move(self, distance: Any, angle: Any) -> None:
        """See Odometry.move()."""
        half = angle / 2
        small = abs(half) <= SMALL
        large = each(sin, half.tolist()) / numpy.where(small, 1.0, half)
        chord = distance * numpy.where(small, 1 - half * half / 6, large)
        directions = (self.yaw + half).tolist()
        # not +=, which would also change a pose that was read before
        self.x = self.x + chord * each(cos, directions)
        self.y = self.y + chord * each(sin, directions)
        self.yaw = self.yaw + angle


class Noises:
    """The same Noise in many runs, all of which have the same path."""

    def __init__(self, noises: Sequence[Noise]) -> None:
        self.draws = [noise.draw for noise in noises]
        self.cell = noises[0].cell
        self.left = numpy.array([noise.left for noise in noises])
        self.slope = numpy.array([noise.slope for noise in noises])

    def over(self, path: float) -> Array:
        """See Noise.over()."""
        errors: Array = numpy.zeros(len(self.left))
        rest = numpy.full(len(self.left), path)
        crossing = numpy.flatnonzero(rest > self.left)     # few of them
        while len(crossing):
            errors[crossing] += self.slope[crossing] * self.left[crossing]
            rest[crossing] -= self.left[crossing]
            self.slope[crossing] = [self.draws[index]() for index in crossing.tolist()]
            self.left[crossing] = self.cell
            crossing = crossing[rest[crossing] > self.cell]
        self.left -= rest
        errors += self.slope * rest
        return errors


class ManyRoughness(Roughness):
    """The motion errors of many runs."""

    def __init__(self, surface: Surface, seeds: Sequence[int]) -> None:
        self.turning, self.heading, self.distance = (    # type: ignore[assignment]
            Noises(noises) for noises in zip(*(draw_noises(surface, seed) for seed in seeds)))


class ManyFloors(Floor):
    """A floor in many runs."""

    def __init__(self, surface: Surface, seeds: Sequence[int]) -> None:
        runs: Any = map(numpy.array, zip(*(draw_run(surface, seed) for seed in seeds)))
        super().__init__(surface, RandomErrors(*runs), ManyRoughness(surface, seeds) if is_rough(surface) else None)
        self.truth = Odometries(1.0)

    def slipped(self, straight: float, turn: float) -> tuple[Any, Any]:
        return floor_travel(self.surface, self.run, straight, turn, numpy.copysign, numpy.maximum)
