"""What a robot stands on, and what that does to its wheels: reads config/surfaces/*.yaml, and draws a run from it.

One file serves the simulated base, which draws its slip and its gyro's errors from it, and the filter, which knows
nothing but the file: how far the wheels and the gyro can be trusted.
"""
from collections import namedtuple
from math import radians
import os
import random
import re

import yaml

from rbx1_nav.config import ConfigError, Section

FRACTION = dict(low=0.0, high=0.5, closed=True, expected='a part from 0 to 0.5')


def between(low, high):
    """A number in that range."""
    return dict(low=low, high=high, closed=True, expected='a number from %g to %g' % (low, high))


# key: what it may be, and what turns it into SI units
KEYS = {
    'lag': (between(1e-4, 60), float),
    'accel_limit': (between(1e-3, 1000), float),
    'drag_straight': (between(1e-6, 10), float),
    'drag_turning': (between(1e-6, 10), float),
    'slip_straight': (FRACTION, float),
    'slip_straight_spread': (FRACTION, float),
    'slip_turning': (FRACTION, float),
    'slip_turning_spread': (FRACTION, float),
    'ticks_meter': (between(1, 1e6), float),
    'gyro_noise': (between(1e-3, 1000), radians),
    'gyro_bias': (between(0, 1000), radians),
    'gyro_scale_error': (FRACTION, float),
    'gyro_measurement_range': (between(1, 1e5), radians)}

Surface = namedtuple('Surface', ['name'] + list(KEYS))
Surface.__doc__ = 'A surface, by the keys of its file, in s, m/s, m/s^2 and (not as in the file) rad/s.'

Run = namedtuple('Run', 'slip_straight slip_turning gyro_bias gyro_scale_error')
Run.__doc__ = 'What was drawn for one run: parts of the travel, rad/s, part of the rate.'


def known_surfaces(folder):
    """Names of the surfaces that have a file in a folder."""
    return sorted(name[:-len('.yaml')] for name in os.listdir(folder) if name.endswith('.yaml'))


def load_surface(name, folder):
    """The Surface of a file in a folder by its name, or of any other file by its absolute path; None for the ideal one.

    Raises ConfigError.
    """
    path = name if isinstance(name, str) and os.path.isabs(name) else os.path.join(folder, '%s.yaml' % name)
    if not (os.path.isfile(path) and (path == name or name in known_surfaces(folder))):
        raise ConfigError('surface: %r: expected one of %s, or the absolute path of such a file'
                          % (name, ', '.join(known_surfaces(folder))))
    try:
        with open(path, encoding='utf-8') as file:
            values = yaml.safe_load(file)
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise ConfigError('surface: %s: expected a YAML file: %s' % (path, ' '.join(str(error).split())))
    return read_surface(values, os.path.basename(path)[:-len('.yaml')] if path.endswith('.yaml') else name)


def read_surface(values, name):
    """The Surface of a mapping of all KEYS to values; None, the ideal one, for an empty mapping. Raises ConfigError."""
    section = Section(values, 'surface %s' % name)
    if not values:
        return None
    surface = Surface(name, *(convert(section.number(key, **limits)) for key, (limits, convert) in KEYS.items()))
    if section.unknown():
        raise ConfigError('%s: unknown: expected only %s' % (section.unknown()[0], ', '.join(KEYS)))
    return surface


def read_seed(value):
    """A seed: a whole number from 0 to 2147483647, or its digits as text. Raises ConfigError."""
    seed = int(value) if isinstance(value, str) and re.match(r'^\d{1,10}$', value, re.ASCII) else value
    if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed < 2 ** 31:
        raise ConfigError('seed: %r: expected a whole number from 0 to %d' % (value, 2 ** 31 - 1))
    return seed


def draw(surface, seed):
    """The Run that a seed (a whole number) stands for."""
    normal = random.Random(seed).gauss
    return Run(normal(surface.slip_straight, surface.slip_straight_spread),
               normal(surface.slip_turning, surface.slip_turning_spread),
               normal(0.0, surface.gyro_bias),
               normal(0.0, surface.gyro_scale_error))
