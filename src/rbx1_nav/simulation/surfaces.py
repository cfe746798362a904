"""The surface below the robot: reads config/surfaces/*.yaml, and draws the random errors of a run from a surface.

The simulated base and the filter use the same file: the base draws its slip and its gyro's errors from it, and the
filter takes its initial uncertainties from it.
"""
from __future__ import annotations

from math import radians
import os
import random
import re
from typing import Callable, NamedTuple

from rbx1_nav.config import ConfigError, Section, YamlValue, load_yaml, show, show_name

RANDOM = 'random'   # the value that requests a new random seed
MAX_SEED = 2 ** 31 - 1


class Key(NamedTuple):
    """The range of a key in a surface file, and the conversion to SI units."""

    low: float
    high: float
    what: str = 'a number'
    convert: Callable[[float], float] = float


FRACTION = Key(0.0, 0.5, 'a fraction')
SIGNED_FRACTION = Key(-0.5, 0.5, 'a fraction')

KEYS = {
    'lag': Key(1e-4, 60),
    'accel_limit': Key(1e-3, 1000),
    'drag_straight': Key(1e-6, 10),
    'drag_turning': Key(1e-6, 10),
    'slip_straight': SIGNED_FRACTION,
    'slip_straight_spread': FRACTION,
    'slip_turning': SIGNED_FRACTION,
    'slip_turning_spread': FRACTION,
    'ticks_meter': Key(1, 1e6),
    'gyro_noise': Key(1e-3, 1000, convert=radians),
    'gyro_bias': Key(0, 1000, convert=radians),
    'gyro_scale_error': FRACTION,
    'gyro_measurement_range': Key(1, 1e5, convert=radians)}

# keys that a file may omit; their default is 0
OPTIONAL_KEYS = {
    'delay': Key(0, 5),
    'curvature': Key(-10, 10),
    'turning_loss': Key(0, 1),
    'heading_noise_turning': Key(0, 1),
    'heading_noise_straight': Key(0, 1),
    'distance_noise': Key(0, 1)}


class Surface(NamedTuple):
    """A surface, with the keys of its file as fields, in s, m/s, m/s^2 and (unlike the file) rad/s."""

    name: str
    lag: float
    accel_limit: float
    drag_straight: float
    drag_turning: float
    slip_straight: float
    slip_straight_spread: float
    slip_turning: float
    slip_turning_spread: float
    ticks_meter: float
    gyro_noise: float
    gyro_bias: float
    gyro_scale_error: float
    gyro_measurement_range: float
    delay: float = 0.0
    curvature: float = 0.0
    turning_loss: float = 0.0
    heading_noise_turning: float = 0.0
    heading_noise_straight: float = 0.0
    distance_noise: float = 0.0


class RandomErrors(NamedTuple):
    """The random errors of one run."""

    slip_straight: float        # fraction of the travel
    slip_turning: float
    gyro_bias: float            # rad/s
    gyro_scale_error: float     # fraction of the rate


def known_surfaces(folder: str) -> list[str]:
    """Return the sorted names of the surfaces that have a file in a folder."""
    return sorted(name[:-len('.yaml')] for name in os.listdir(folder) if name.endswith('.yaml'))


def load_surface(name: YamlValue, folder: str) -> Surface | None:
    """Return the Surface with this name in a folder, or from the file at this absolute path.

    The result is None for the ideal surface. Raises ConfigError.
    """
    path = None
    if isinstance(name, str):
        if os.path.isabs(name):
            path = name
            if not os.path.isfile(path):
                raise ConfigError(f'surface: {show(name)}: no such file: expected the absolute path of a surface file, '
                                  f"or one of {', '.join(known_surfaces(folder))}")
        elif name in known_surfaces(folder):
            path = os.path.join(folder, f'{name}.yaml')
    if path is None:
        raise ConfigError(f"surface: {show(name)}: expected one of {', '.join(known_surfaces(folder))}, or the "
                          'absolute path of a surface file')
    try:
        values = load_yaml(path)
    except ConfigError as error:
        raise ConfigError(f'surface: {show_name(path)}: {error}') from None
    return read_surface(values, os.path.basename(path)[:-len('.yaml')] if path.endswith('.yaml') else path)


def read_surface(values: YamlValue, name: str) -> Surface | None:
    """Return the Surface of a mapping with all KEYS and some OPTIONAL_KEYS. Raises ConfigError.

    The result is None, the ideal surface, for an empty mapping.
    """
    section = Section(values, f'surface {show_name(name)}')
    if not values:
        return None
    surface = Surface(name, *(key.convert(section.number(each, key.low, key.high, what=key.what))
                              for each, key in KEYS.items()),
                      *(key.convert(section.number(each, key.low, key.high, 0.0, key.what))
                        for each, key in OPTIONAL_KEYS.items()))
    if section.unknown():
        raise ConfigError(f"{section.unknown()[0]}: unknown: expected only {', '.join([*KEYS, *OPTIONAL_KEYS])}")
    return surface


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
