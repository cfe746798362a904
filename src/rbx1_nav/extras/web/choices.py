"""What a learner can choose in the page for a simulated robot: floor, seed, distance and speed.

Each choice is a parameter of the base or of the scripts, as it is set in a terminal.
"""
from __future__ import annotations

import re
from typing import Sequence

from rbx1_nav.node.config import ConfigError, YamlValue, show

NONE = 'none'
FLOOR = {'surface', 'seed'}     # parameters of the base, which reads them at a reset
SCRIPTS = {'distance': 'goal_distance', 'speed': 'linear_speed'}    # parameters of the scripts
CHOICES = 'surface', 'seed', *SCRIPTS
DEFAULTS = {'distance': 1.0, 'speed': 0.2}  # m, m/s: of the scripts
LIMITS = {'distance': (0.1, 3.0), 'speed': (0.05, 0.5)}     # m, m/s


def read_choices(value: YamlValue) -> list[str]:
    """Return the choices in a text such as `surface,seed`. Raises ConfigError."""
    names = [] if value == NONE else str(value).replace(' ', '').split(',')
    if set(names) <= set(CHOICES):
        return names
    raise ConfigError(f"choices: {show(value)}: expected {NONE}, or some of {','.join(CHOICES)}")


def read_choice(name: str, text: str, surfaces: Sequence[str]) -> str | float:
    """Return the value of a choice, given as text. surfaces: known names. Raises ValueError with what was expected."""
    if name == 'surface':
        if text in surfaces:
            return text
        raise ValueError(f"expected one of {', '.join(surfaces)}")
    if name == 'seed':
        if re.fullmatch(r'\d{1,9}|random', text, re.ASCII):
            return text
        raise ValueError('expected a number of at most 9 digits, or random')
    low, high = LIMITS[name]
    if re.fullmatch(r'\d{1,3}(\.\d{1,6})?', text, re.ASCII) and low <= float(text) <= high:
        return float(text)
    raise ValueError(f'expected a number from {low:g} to {high:g}')
