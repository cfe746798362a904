"""Readings of a robot's sensors, simulated or real, and their uncertainties."""
from __future__ import annotations

from typing import NamedTuple

MEASURED = 1e-6         # variance of a good measurement, m^2 or rad^2 (or per s^2): 1 mm, 1 mrad
MIN_VARIANCE = 1e-12    # smallest variance that a sensor may report, same units: 1 um, 1 urad


class Uncertainty(NamedTuple):
    """Variances of a pose and of the speeds."""

    position: float     # variance of x and y, m^2
    yaw: float          # variance of the yaw, rad^2
    linear: float       # variance of the linear speed, m^2/s^2
    angular: float      # variance of the angular speed, rad^2/s^2


class Reading(NamedTuple):
    """A reading of a gyro."""

    rate: float             # angular velocity with bias and scale error, rad/s
    rate_variance: float    # variance of the noise of the rate, rad^2/s^2
    yaw: float              # the heading integrated from calibrated readings, rad, not wrapped
    yaw_variance: float     # rad^2
