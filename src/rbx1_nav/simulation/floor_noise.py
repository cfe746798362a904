"""The random part of slip: motion errors that vary along the path, because a floor is not uniform."""
from __future__ import annotations

from math import log
import random
from typing import Iterator, NamedTuple

from rbx1_nav.base.surfaces import CELL_TRAVELLED, CELL_TURNED, Surface


class NoiseKind(NamedTuple):
    """What a noise of a surface does."""

    error: str      # what it changes: angle (rad) or distance (m)
    path: str       # along which it varies: turned (rad) or travelled (m)
    cell: float     # length of a cell of this path


# by the key of the surface, whose value is the strength
KINDS = {'heading_noise_turning': NoiseKind('angle', 'turned', CELL_TURNED),
         'heading_noise_straight': NoiseKind('angle', 'travelled', CELL_TRAVELLED),
         'distance_noise': NoiseKind('distance', 'travelled', CELL_TRAVELLED)}
NOISES = tuple(KINDS)


class Noise:
    """White noise along a path, whose variance grows by strength ** 2 with each unit of the path.

    The variance does not depend on how the path is divided into steps (the form of Chong and Kleeman, Accurate odometry
    and error modelling for a mobile robot, 1997). The path is divided into cells. The error grows linearly within a
    cell. The error of each cell is drawn from a Laplace distribution, in which large errors are more frequent than in a
    normal distribution.
    """

    def __init__(self, strength: float, cell: float, generator: random.Random) -> None:
        """strength: 1 sigma after one unit of the path; cell: length of a cell, in units of the path."""
        self.scale: float = strength / (2 * cell) ** 0.5       # a Laplace distribution of scale 1 has a variance of 2
        self.cell = cell
        self.random = generator.random
        self.left = cell * self.random()
        self.slope = self.draw()

    def draw(self) -> float:
        """Return the error per unit of the path in the next cell."""
        return self.scale * log((1 - self.random()) / (1 - self.random()))     # Laplace

    def over(self, path: float) -> float:
        """Return the error over the next `path` (0 or more)."""
        if path <= self.left:       # the usual case
            self.left -= path
            return self.slope * path
        error = 0.0
        while path > self.left:
            error += self.slope * self.left
            path -= self.left
            self.slope, self.left = self.draw(), self.cell
        self.left -= path
        return error + self.slope * path


class Roughness:
    """The motion errors of one run as a function of the wheel travel."""

    def __init__(self, surface: Surface, seed: int) -> None:
        self.turning, self.heading, self.distance = draw_noises(surface, seed)

    def over(self, straight: float, turn: float) -> tuple[float, float]:
        """Return the errors of distance (m) and angle (rad) while the wheels travel `straight` (m) and `turn` (rad)."""
        distance = angle = 0.0
        if straight:
            distance, angle = self.distance.over(abs(straight)), self.heading.over(abs(straight))
        if turn:
            angle += self.turning.over(abs(turn))
        return distance, angle


def draw_noises(surface: Surface, seed: int) -> Iterator[Noise]:
    """Yield the Noise of each of NOISES in a run."""
    for key, kind in KINDS.items():
        # one generator each: with a shared one, the length of the steps would determine which noise draws next
        yield Noise(getattr(surface, key), kind.cell, random.Random(f'{key} {seed}'))


def is_rough(surface: Surface) -> bool:
    """Return whether a Surface has noise."""
    return any(getattr(surface, key) for key in NOISES)
