"""Reads end poses of runs that were measured by hand."""
from __future__ import annotations

from math import radians
import os
from typing import Sequence

from rbx1_nav.config import ConfigError, Section, load_yaml, show, show_name
from rbx1_nav.robot.kinematics import Pose

FARTHEST, MOST = 1000.0, 36000.0    # m, degrees
ERRORS = dict(position_error=(1e-4, 10.0, 0.01, 'm'), heading_error=(0.01, 90.0, 2.0, 'degrees'))


def read_ends(path: str, bags: Sequence[str]) -> tuple[list[Pose], tuple[float, float, float]]:
    """Read ([Pose of each bag], (error of x in m, of y in m, of the heading in rad)) from a YAML file. bags: paths.

    The file maps the name of each bag, without folder, to its end pose [x (m), y (m), heading (degrees)] in the frame
    of its start pose. position_error (m) and heading_error (degrees) give the measurement error. Raises ConfigError.
    """
    try:
        section = Section(load_yaml(path))
        errors = {key: section.number(key, low, high, default, unit=unit)
                  for key, (low, high, default, unit) in ERRORS.items()}
        names = [os.path.basename(bag) for bag in bags]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise ConfigError(f'{show_name(twice[0])}: two bags have this name: expected unique names')
        ends = [read_end(section, name) for name in names]
        if section.unknown():
            raise ConfigError(f"{section.unknown()[0]}: unknown: expected {', '.join(ERRORS)} and names of bags on "
                              'the command line')
    except ConfigError as error:
        raise ConfigError(f'{show_name(path)}: {error}') from error
    return ends, (errors['position_error'], errors['position_error'], radians(errors['heading_error']))


def read_end(section: Section, name: str) -> Pose:
    """Read the Pose of one bag. Raises ConfigError."""
    expected = '[x in m, y in m, heading in degrees]'
    values = section.get(name, expected=expected)
    if not (isinstance(values, list) and len(values) == 3):
        raise ConfigError(f'{section.path(name)}: {show(values)}: expected {expected}')
    part = Section(dict(zip(('x', 'y', 'heading'), values)), section.path(name))
    return Pose(part.number('x', -FARTHEST, FARTHEST, unit='m'), part.number('y', -FARTHEST, FARTHEST, unit='m'),
                radians(part.number('heading', -MOST, MOST, unit='degrees')))
