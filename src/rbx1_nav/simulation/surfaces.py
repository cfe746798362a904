"""The surface below the robot: reads config/surfaces/*.yaml, and draws one run's random errors from it.

One file serves both the simulated base, which draws its slip and its gyro's errors from it, and the filter, which takes
its initial uncertainties from it.
"""
from collections import namedtuple
from math import radians
import os
import random
import re

from rbx1_nav.config import ConfigError, Section, load_yaml, show, show_name

RANDOM = 'random'   # the word for a seed that is drawn anew
MAX_SEED = 2 ** 31 - 1
FRACTION = dict(low=0.0, high=0.5, what='a fraction')
SIGNED_FRACTION = dict(FRACTION, low=-0.5)


def number_between(low, high):
    """The range of a key, as keyword arguments of Section.number()."""
    return dict(low=low, high=high)


# key: its range, and the conversion to SI units
KEYS = {
    'lag': (number_between(1e-4, 60), float),
    'accel_limit': (number_between(1e-3, 1000), float),
    'drag_straight': (number_between(1e-6, 10), float),
    'drag_turning': (number_between(1e-6, 10), float),
    'slip_straight': (SIGNED_FRACTION, float),
    'slip_straight_spread': (FRACTION, float),
    'slip_turning': (SIGNED_FRACTION, float),
    'slip_turning_spread': (FRACTION, float),
    'ticks_meter': (number_between(1, 1e6), float),
    'gyro_noise': (number_between(1e-3, 1000), radians),
    'gyro_bias': (number_between(0, 1000), radians),
    'gyro_scale_error': (FRACTION, float),
    'gyro_measurement_range': (number_between(1, 1e5), radians)}

# the same for those that a file may leave out: they are 0 then
OPTIONAL_KEYS = {
    'delay': (number_between(0, 5), float),
    'curvature': (number_between(-10, 10), float),
    'turning_loss': (number_between(0, 1), float),
    'heading_noise_turning': (number_between(0, 1), float),
    'heading_noise_straight': (number_between(0, 1), float),
    'distance_noise': (number_between(0, 1), float)}

Surface = namedtuple('Surface', ['name', *KEYS, *OPTIONAL_KEYS], defaults=[0.0] * len(OPTIONAL_KEYS))
Surface.__doc__ = 'A surface, with the keys of its file as fields, in s, m/s, m/s^2 and (unlike the file) rad/s.'

RandomErrors = namedtuple('RandomErrors', 'slip_straight slip_turning gyro_bias gyro_scale_error')
RandomErrors.__doc__ = 'The random errors of one run: fractions of the travel, rad/s, fraction of the rate.'


def known_surfaces(folder):
    """Names of the surfaces that have a file in a folder, sorted."""
    return sorted(name[:-len('.yaml')] for name in os.listdir(folder) if name.endswith('.yaml'))


def load_surface(name, folder):
    """The Surface of this name in a folder, or of the file with this absolute path; None for the ideal surface.

    Raises ConfigError.
    """
    is_path = isinstance(name, str) and os.path.isabs(name)
    if is_path and not os.path.isfile(name):
        raise ConfigError('surface: %s: no such file: expected the absolute path of a surface file, or one of %s'
                          % (show(name), ', '.join(known_surfaces(folder))))
    if not is_path and name not in known_surfaces(folder):
        raise ConfigError('surface: %s: expected one of %s, or the absolute path of a surface file'
                          % (show(name), ', '.join(known_surfaces(folder))))
    path = name if is_path else os.path.join(folder, f'{name}.yaml')
    try:
        values = load_yaml(path)
    except ConfigError as error:
        raise ConfigError(f'surface: {show_name(path)}: {error}')
    return read_surface(values, os.path.basename(path)[:-len('.yaml')] if path.endswith('.yaml') else name)


def read_surface(values, name):
    """The Surface of a mapping with all KEYS, and some OPTIONAL_KEYS; None, the ideal surface, for an empty mapping.
    Raises ConfigError."""
    section = Section(values, f'surface {show_name(name)}')
    if not values:
        return None
    surface = Surface(name, *(convert(section.number(key, **limits)) for key, (limits, convert) in KEYS.items()),
                      *(convert(section.number(key, default=0.0, **limits))
                        for key, (limits, convert) in OPTIONAL_KEYS.items()))
    if section.unknown():
        raise ConfigError(f"{section.unknown()[0]}: unknown: expected only {', '.join([*KEYS, *OPTIONAL_KEYS])}")
    return surface


def read_seed(value):
    """A seed: an integer from 0 to 2147483647, its digits as text, or `random` for a new one. Raises ConfigError."""
    if value == RANDOM:
        return random.randrange(10 ** 6)
    seed = int(value) if isinstance(value, str) and re.fullmatch(r'\d{1,10}', value, re.ASCII) else value
    if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed <= MAX_SEED:
        raise ConfigError('seed: %s: expected %s, or an integer from 0 to %d' % (show(value), RANDOM, MAX_SEED))
    return seed


def draw_run(surface, seed):
    """The RandomErrors that a seed (an integer) stands for."""
    normal = random.Random(seed).gauss
    return RandomErrors(normal(surface.slip_straight, surface.slip_straight_spread),
               normal(surface.slip_turning, surface.slip_turning_spread),
               normal(0.0, surface.gyro_bias),
               normal(0.0, surface.gyro_scale_error))
