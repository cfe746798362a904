"""Units and the arithmetic of single numbers. Metres, radians and seconds (REP 103) unless a name says otherwise.

Times that are compared or added up are whole nanoseconds, so that fifty steps of 20 ms are exactly one second.
"""
from __future__ import annotations

from math import copysign, pi, remainder

SECOND = 10 ** 9    # ns


def clamp(value: float, limit: float) -> float:
    """value, limited to the range from -limit to limit."""
    return copysign(min(abs(value), limit), value)


def wrap_angle(angle: float) -> float:
    """The equivalent angle between -pi and pi, rad."""
    return remainder(angle, 2 * pi)


def rounded(value: float, digits: int) -> float:
    """value, rounded to be printed with so many decimals: 0 in place of -0."""
    return round(value, digits) + 0.0
