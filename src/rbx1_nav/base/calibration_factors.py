"""Calibration: the correction factor of a sensor, calculated from the reported and the measured value."""
from __future__ import annotations

from math import degrees, inf, isfinite
import re
from typing import Sequence

from rbx1_nav.node.config import ConfigError, Section, YamlValue, show

MAX_ERROR = 2.0         # a distance or turn that is wrong by more than this factor is a mistake, not a calibration
MAX_FACTOR = 10.0       # largest correction factor, and inverse of the smallest one; create_node's highest is 6
MAX_GAP = 0.5           # s between two gyro readings, in which the robot turns by 15 degrees at the script's speed
REST = 1.0              # minimum time at rest (s) to determine a gyro's bias
UNITS = {'m': 'm', 'degrees': 'degrees?|deg|°'}   # unit that may follow the number in an answer


def read_measured(key: str, value: YamlValue, expected: float, what: str, unit: str) -> float:
    """Return a measured value, given as a number or as typed text; at least half and at most twice `expected`.

    unit: m or degrees; key, what: for the error message. Raises ConfigError.
    """
    if isinstance(value, str):
        if re.search(r'\d,\d', value):
            raise ConfigError(f'{key}: {show(value)}: expected a decimal point, not a comma')
        try:
            value = float(re.sub(rf'\s*({UNITS[unit]})\s*$', '', value))
        except ValueError:
            pass
    low, high = (round(limit, 3) for limit in (expected / MAX_ERROR, expected * MAX_ERROR))
    return Section({key: value}).number(key, low, high, what=what, unit=unit)


def corrected(key: str, factor: float, measured: float, reported: float) -> float:
    """Return the new value of the correction factor `key`, which was `factor` during the measurement.

    measured, reported: the same distance or turn, in the same unit. Raises ConfigError.
    """
    new = factor * measured / reported if reported else inf
    if not 1 / MAX_FACTOR <= new <= MAX_FACTOR:
        raise ConfigError(f'{key}: {new:.4g}: expected a factor from {1 / MAX_FACTOR:g} to {MAX_FACTOR:g}: '
                          f'measured {measured:.3f}, reported {reported:.3f}')
    return new


def turn_by_gyro(readings: Sequence[tuple[float, float]], start: float, end: float, expected: float) -> float:
    """Return the angle (rad) that a gyro has measured from `start`, when the robot began to turn, to `end`.

    readings: (time in s, angular velocity in rad/s), in the order of their times. The mean of the readings up to
    `start`, at rest, is the gyro's bias. Each later reading is the mean since the previous one. expected: the turn that
    the odometry measured, rad. Raises ConfigError if the gyro has not measured the whole turn, or has measured no turn.
    """
    rest = [rate for time, rate in readings if time <= start]
    if not rest or start - readings[0][0] < REST:
        raise ConfigError(f'{len(rest)} readings at rest: expected at least {REST:g} s of readings')
    bias = sum(rest) / len(rest)
    turned, before = 0.0, readings[len(rest) - 1][0]
    for time, rate in readings[len(rest):]:
        if not 0 <= time - before <= MAX_GAP:
            raise ConfigError(f'{time - before:.2f} s between two readings: expected at most {MAX_GAP:g} s')
        turned += (rate - bias) * (time - before)
        before = time
    if end - before > MAX_GAP:
        raise ConfigError(f'no reading in the last {end - before:.1f} s of the turn')
    if not isfinite(turned):
        raise ConfigError(f'a turn of {turned:g} rad: expected finite readings')
    if abs(turned) < abs(expected) / MAX_FACTOR:
        raise ConfigError(f'the gyro reports no turn ({degrees(turned):.1f} degrees)')
    return turned
