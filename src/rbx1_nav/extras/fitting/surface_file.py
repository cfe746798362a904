"""Formats the result of a fit as text: a surface file with comments, and a table to print."""
from __future__ import annotations

import textwrap
from typing import Sequence

import numpy

from rbx1_nav.base.surfaces import KEYS
from rbx1_nav.extras.fitting.surface_fit import FitResult, Value
from rbx1_nav.node.config import as_yaml_number, show_name

PARTS = [
    ('Motors: delay and lag after a command, and the speed that a wheel loses by drag.',
     ('delay', 'lag', 'accel_limit', 'drag_straight', 'drag_turning')),
    ('Slip: the fraction of the wheel travel that is lost, and its spread from run to run.',
     ('slip_straight', 'slip_straight_spread', 'slip_turning', 'slip_turning_spread')),
    ('Constant in all runs: drift to the left, and distance lost in an arc.', ('curvature', 'turning_loss')),
    ('Noise that varies along the path, 1 sigma after 1 m or 1 rad.',
     ('heading_noise_turning', 'heading_noise_straight', 'distance_noise')),
    ('Encoders.', ('ticks_meter',)),
    ('Gyro: bias and scale error are constant in a run.',
     ('gyro_noise', 'gyro_bias', 'gyro_scale_error', 'gyro_measurement_range'))]
PARTS.append(('Others.', tuple(key for key in KEYS if not any(key in keys for _, keys in PARTS))))
WIDTH = 117     # of a line


def shown(value: Value) -> tuple[str, str | None]:
    """Return (value, standard error or None) of a Value as text in the unit of the file, to two digits of the error."""
    number = KEYS[value.key].from_si(value.value)
    if value.error is None:
        return f'{number:.6g}', None
    error = KEYS[value.key].from_si(value.error)
    digits = int(numpy.clip(1 - numpy.floor(numpy.log10(error)), 0, 9)) if error > 0 else 6
    return f'{number:.{digits}f}', f'{error:.2g}'


def yaml_number(value: Value) -> str:
    """Return a Value as a YAML number within the range of its key."""
    text = shown(value)[0]
    key = KEYS[value.key]
    low, high = map(key.from_si, key.limits)
    if not low <= float(text) <= high:      # due to rounding
        text = repr(min(max(key.from_si(value.value), low), high))
    return as_yaml_number(text) if 'e' in text else text


def comment(value: Value) -> str:
    """Return the comment after a Value."""
    unit = KEYS[value.key].unit
    error = shown(value)[1]
    text = f'not fitted: {value.reason}' if error is None else f'fitted, +- {error}'
    return f'{unit}; {text}' if unit else text


def wrapped(text: str) -> list[str]:
    """Wrap text to the lines of a comment."""
    return textwrap.wrap(text, WIDTH, initial_indent='# ', subsequent_indent='# ', break_long_words=False,
                         break_on_hyphens=False)


def surface_text(result: FitResult, start_name: str, names: Sequence[str]) -> str:
    """Return the text of a surface file. start_name: name of the starting surface; names: names of the recordings."""
    lines = wrapped(f"Fitted by fit_surface.py to {len(names)} recording{'' if len(names) == 1 else 's'}: "
                    f"{', '.join(show_name(name) for name in names)}.")
    lines += wrapped(f'Fitted: {result.description}. "+-" is one standard error. A value marked "not fitted" is taken '
                     f'from {show_name(start_name)}.')
    for text in result.notes:
        lines += wrapped(text)
    for text in result.warnings:
        lines += wrapped(f'Warning: {text}.')
    values = {value.key: value for value in result.values}
    for title, keys in PARTS:
        lines += ['', *wrapped(title)] if keys else []
        for key in keys:
            setting = f'{key}: {yaml_number(values[key])}'
            lines.append(f'{setting:<36} # {comment(values[key])}')
    return '\n'.join(lines) + '\n'


def table(result: FitResult, start_name: str) -> list[str]:
    """Return the lines to print."""
    values = {value.key: value for value in result.values}
    ordered = [values[key] for _, keys in PARTS for key in keys]
    lines = [f'Fitted: {result.description}']
    for value in ordered:
        number, error = shown(value)
        if error is not None:
            lines.append(f"  {value.key:<24} {number:>10} +- {error:<8} {KEYS[value.key].unit}".rstrip())
    left = [value for value in ordered if value.error is None]
    if left:
        lines.append(f'Not fitted, taken from {show_name(start_name)}:')
        lines += [f'  {value.key:<24} {shown(value)[0]:>10}    {value.reason}' for value in left]
    return lines + [f'Note: {text}' for text in result.notes] + [f'Warning: {text}' for text in result.warnings]
