"""The floor below a simulated robot: how the robot moves while its wheels travel."""
from __future__ import annotations

from typing import Any

from rbx1_nav.base.kinematics import Odometry
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.simulation.floor_noise import Roughness, is_rough
from rbx1_nav.simulation.slip import RandomErrors, draw_run, floor_travel


class Floor:
    """A floor in one run. Its true motion cannot be measured by an encoder, and has no effect on the wheels."""

    def __init__(self, surface: Surface, run: RandomErrors, roughness: Roughness | None = None) -> None:
        """run: the errors drawn from the surface."""
        self.surface = surface
        self.run = run
        self.roughness = roughness
        self.truth = Odometry(1.0)      # of any width

    def move(self, straight: float, turn: float) -> None:
        """Move the robot while its wheels travel `straight` (m) and `turn` (rad)."""
        distance, angle = self.slipped(straight, turn)
        if self.roughness:
            further, more = self.roughness.over(straight, turn)
            distance, angle = distance + further, angle + more
        if straight:
            self.truth.move(distance, angle)
        else:       # a turn on the spot needs no sines
            self.truth.yaw = self.truth.yaw + angle

    def slipped(self, straight: float, turn: float) -> tuple[Any, Any]:
        """Return the travel, or the speeds, of the robot for the wheels' ones, without noise: see floor_travel()."""
        return floor_travel(self.surface, self.run, straight, turn)


def make_floor(surface: Surface, seed: int) -> Floor:
    """Return the Floor of a run with this seed."""
    return Floor(surface, draw_run(surface, seed), Roughness(surface, seed) if is_rough(surface) else None)
