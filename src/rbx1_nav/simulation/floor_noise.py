"""The random part of slip: errors of a motion that are drawn anew along the path, because a floor varies."""
from __future__ import annotations

from math import log
import random

from rbx1_nav.simulation.surfaces import Surface

CELL_TURNED = 0.25      # rad } the size of a cell; both were found in records of five Creates: docs/why_it_misses.md
CELL_TRAVELLED = 0.1    # m   }


class Noise:
    """White noise along a path. Its variance grows by strength ** 2 with each unit of the path, however the path is cut
    into steps (the form of Chong and Kleeman, Accurate odometry and error modelling for a mobile robot, 1997).

    The path is divided into cells. The error grows evenly within a cell, and each cell has another one, drawn from a
    Laplace distribution: large errors are more frequent than in a normal distribution.
    """

    def __init__(self, strength: float, cell: float, generator: random.Random) -> None:
        """strength: 1 sigma after one unit of the path; cell: in units of the path."""
        self.scale: float = strength / (2 * cell) ** 0.5       # a Laplace distribution of scale 1 has a variance of 2
        self.cell = cell
        self.random = generator.random
        self._draw(cell * self.random())

    def _draw(self, size: float) -> None:
        self.slope = self.scale * log((1 - self.random()) / (1 - self.random()))     # Laplace
        self.left = size

    def over(self, path: float) -> float:
        """The error of the next `path` (0 or more)."""
        if path <= self.left:       # nearly always
            self.left -= path
            return self.slope * path
        error = 0.0
        while path > self.left:
            error += self.slope * self.left
            path -= self.left
            self._draw(self.cell)
        self.left -= path
        return error + self.slope * path


class Roughness:
    """The errors of one run, by the travel of the wheels."""

    def __init__(self, surface: Surface, seed: int) -> None:
        def noise(key: str, cell: float) -> Noise:
            # a generator for each: in a common one, the length of the steps would decide whose turn it is
            return Noise(getattr(surface, key), cell, random.Random(f'{key} {seed}'))
        self.turning = noise('heading_noise_turning', CELL_TURNED)
        self.heading = noise('heading_noise_straight', CELL_TRAVELLED)
        self.distance = noise('distance_noise', CELL_TRAVELLED)

    def over(self, straight: float, turn: float) -> tuple[float, float]:
        """The errors of distance (m) and angle (rad) while the wheels travel by `straight` (m) and `turn` (rad)."""
        distance = angle = 0.0
        if straight:
            distance, angle = self.distance.over(abs(straight)), self.heading.over(abs(straight))
        if turn:
            angle += self.turning.over(abs(turn))
        return distance, angle


def make_roughness(surface: Surface, seed: int) -> Roughness | None:
    """A Roughness; None for a Surface without noise."""
    return Roughness(surface, seed) if (surface.heading_noise_turning or surface.heading_noise_straight
                                        or surface.distance_noise) else None
