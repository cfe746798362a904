"""A surface file: what config/surfaces/*.yaml says about the floor, the motors and the gyro of a robot.

The simulated base and the filter use the same file: the base draws its slip and its gyro's errors from it, and the
filter takes its initial uncertainties from it.
"""
from __future__ import annotations

from math import degrees, radians
import os
from typing import NamedTuple

from rbx1_nav.node.config import ConfigError, Section, YamlValue, load_yaml, show, show_name, suggestion

CELL_TURNED = 0.25      # rad } path over which the noise of a floor is constant, determined from recordings of five
CELL_TRAVELLED = 0.1    # m   } Creates: docs/your_floor.md


class Key(NamedTuple):
    """A key of a surface file."""

    unit: str       # in the file; '' for a ratio
    low: float
    high: float
    text: str
    what: str = 'a number'

    def to_si(self, number: float) -> float:
        """Convert a number from the unit of the file to SI units."""
        return radians(number) if self.unit == 'degrees/s' else float(number)

    @property
    def limits(self) -> tuple[float, float]:
        """The lowest and the highest value, in SI units."""
        return self.to_si(self.low), self.to_si(self.high)

    def from_si(self, number: float) -> float:
        """Convert a number from SI units to the unit of the file."""
        return degrees(number) if self.unit == 'degrees/s' else number


class Surface(NamedTuple):
    """A surface: its name, and a value for each of KEYS. With a default, the key of the file is optional. Values are in
    the units of the file, but rad/s instead of degrees/s."""

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


# the keys of a file, in the order of the fields of a Surface
KEYS: dict[str, Key] = {
    'lag': Key('s', 1e-4, 60, 'time constant of a motor'),
    'accel_limit': Key('m/s^2', 1e-3, 1000, 'largest acceleration of a wheel'),
    'drag_straight': Key('m/s', 1e-6, 10, 'speed lost in straight motion'),
    'drag_turning': Key('m/s', 1e-6, 10, 'speed lost in a turn on the spot, at the wheel'),
    'slip_straight': Key('', -0.5, 0.5,
        "mean fraction of the wheels' travel that does not move the robot straight ahead", 'a fraction'),
    'slip_straight_spread': Key('', 0, 0.5,
        'its standard deviation from run to run', 'a fraction'),
    'slip_turning': Key('', -0.5, 0.5,
        "mean fraction of the wheels' travel that does not turn the robot", 'a fraction'),
    'slip_turning_spread': Key('', 0, 0.5,
        'its standard deviation from run to run', 'a fraction'),
    'ticks_meter': Key('1/m', 1, 1e6, 'encoder ticks per meter'),
    'gyro_noise': Key('degrees/s', 1e-3, 1000, 'noise of a reading at 50 readings per second, rms'),
    'gyro_bias': Key('degrees/s', 0, 1000,
        'standard deviation of the bias from run to run'),
    'gyro_scale_error': Key('', 0, 0.5,
        'standard deviation of the scale error from run to run, a fraction', 'a fraction'),
    'gyro_measurement_range': Key('degrees/s', 1, 1e5, 'largest reading in either direction'),
    'delay': Key('s', 0, 5, 'time from a command to its arrival at the motors'),
    'curvature': Key('rad/m', -10, 10,
        'turn to the left of a robot that is commanded to go straight'),
    'turning_loss': Key('m/rad', 0, 1,
        'forward travel lost for each radian turned while driving'),
    'heading_noise_turning': Key('rad', 0, 1,
        'heading error after 1 rad, 1 sigma'),
    'heading_noise_straight': Key('rad', 0, 1,
        'heading error after 1 m, 1 sigma'),
    'distance_noise': Key('m', 0, 1,
        'distance error after 1 m, 1 sigma'),
}
assert tuple(KEYS) == Surface._fields[1:]


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
    """Return the Surface of a mapping with KEYS, of which the optional ones may be missing. Raises ConfigError.

    The result is None, the ideal surface, for an empty mapping.
    """
    section = Section(values, f'surface {show_name(name)}')
    if not values:
        return None
    for each in section.values:
        if each not in KEYS:
            raise ConfigError(f"{section.path(each)}{suggestion(each, KEYS)}: unknown: expected only {', '.join(KEYS)}")
    numbers = (section.number(each, key.low, key.high, Surface._field_defaults.get(each), key.what, key.unit)
               for each, key in KEYS.items())
    return Surface(name, *(key.to_si(number) for key, number in zip(KEYS.values(), numbers)))
