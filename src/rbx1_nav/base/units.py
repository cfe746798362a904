"""Units, arithmetic on single numbers, and the type of an array.

Meters, radians and seconds (REP 103) unless a name indicates another unit. Times that are compared or added up are
whole nanoseconds, so that fifty steps of 20 ms are exactly one second.
"""
from __future__ import annotations

from math import copysign, pi, remainder
from typing import TYPE_CHECKING, Tuple

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray as NDArray     # not available in Debian 11's numpy
    Array = NDArray[numpy.float64]
else:
    Array = NDArray = 'an array of numbers'     # only for type hints, which need no numpy

SECOND = 10 ** 9    # ns

Row = Tuple[float, float, float]
Covariance = Tuple[Row, Row, Row]   # 3x3: of x, y (m) and yaw (rad)


def clamp(value: float, limit: float) -> float:
    """Return `value`, limited to the range from -limit to limit."""
    return copysign(min(abs(value), limit), value)


def wrap_angle(angle: float) -> float:
    """Return the equivalent angle between -pi and pi, rad."""
    return remainder(angle, 2 * pi)


def rounded(value: float, digits: int) -> float:
    """Return `value`, rounded for printing with `digits` decimals, and 0 instead of -0."""
    return round(value, digits) + 0.0
