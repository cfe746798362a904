"""What the sensors of a robot report, simulated or real, and how uncertain that is."""
from collections import namedtuple

MEASURED = 1e-6         # variance of a good measurement, m^2 or rad^2 (or per s^2): 1 mm, 1 mrad
MIN_VARIANCE = 1e-12    # smallest variance that a sensor may report, same units: 1 um, 1 urad

Uncertainty = namedtuple('Uncertainty', 'position yaw linear angular')
Uncertainty.__doc__ = 'Variances: of x and y (m^2), yaw (rad^2), linear speed (m^2/s^2), angular speed (rad^2/s^2).'

Reading = namedtuple('Reading', 'rate rate_variance yaw yaw_variance')
Reading.__doc__ = """A reading of a gyro: angular velocity with bias and scale error (rad/s) and the variance of its noise
(rad^2/s^2); the heading integrated from calibrated readings (rad, not wrapped) and its variance (rad^2)."""
