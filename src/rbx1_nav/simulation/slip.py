"""The surface below a simulated robot: the random errors of a run, and what a floor does to the travel of wheels."""
from __future__ import annotations

from math import copysign
import random
import re
from typing import Any, NamedTuple

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.node.config import ConfigError, YamlValue, show

RANDOM = 'random'   # the value that requests a new random seed
MAX_SEED = 2 ** 31 - 1


class RandomErrors(NamedTuple):
    """The random errors of one run."""

    slip_straight: float        # fraction of the travel
    slip_turning: float
    gyro_bias: float            # rad/s
    gyro_scale_error: float     # fraction of the rate


def read_seed(value: YamlValue) -> int:
    """Return a seed, given as an integer from 0 to 2147483647, as text, or as `random`. Raises ConfigError."""
    if value == RANDOM:
        return random.randrange(10 ** 6)
    seed = int(value) if isinstance(value, str) and re.fullmatch(r'\d{1,10}', value, re.ASCII) else value
    if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed <= MAX_SEED:
        raise ConfigError(f'seed: {show(value)}: expected {RANDOM}, or an integer from 0 to {MAX_SEED}')
    return seed


def draw_run(surface: Surface, seed: int) -> RandomErrors:
    """Return the RandomErrors that a seed (an integer) determines."""
    normal = random.Random(seed).gauss
    return RandomErrors(normal(surface.slip_straight, surface.slip_straight_spread),
                        normal(surface.slip_turning, surface.slip_turning_spread),
                        normal(0.0, surface.gyro_bias),
                        normal(0.0, surface.gyro_scale_error))


def floor_travel(surface: Surface, slips: Surface | RandomErrors, straight: Any, turn: Any, copysign: Any = copysign,
                 maximum: Any = max) -> tuple[Any, Any]:
    """Return the robot's (distance, angle) for the travel of its wheels, or its speeds for the wheels' speeds.

    Noise is not included. slips: the slips of a run or, for their means, the surface; straight: m, turn: rad, or m/s
    and rad/s: each a number, or with the functions of numpy an array.
    """
    distance = straight * (1 - slips.slip_straight)
    if surface.turning_loss:
        distance = copysign(maximum(0.0, abs(distance) - surface.turning_loss * abs(turn)), distance)
    return distance, turn * (1 - slips.slip_turning) + surface.curvature * straight
