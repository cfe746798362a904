"""What the filter assumes before the first message: the limits of a robot, and the errors of the floor and the gyro."""
from __future__ import annotations

from math import inf, radians
from typing import NamedTuple

from rbx1_nav.base.surfaces import Surface

# least 1 sigma of the errors on a floor with a surface file, which is never the floor itself: the gyro's scale error,
# slip in turns and straight on, curvature (rad/m)
MIN_SPREADS = dict(gyro_scale_error=0.003, slip_turning_spread=0.05, slip_straight_spread=0.02, curvature_spread=0.02)


class Bounds(NamedTuple):
    """The limits of a robot; the defaults suit robots up to 5 m/s, with a margin for the noise of the odometry."""
    max_speed: float = 6.0                  # m/s: odometry that moves faster has jumped
    max_turn_rate: float = 6.0              # rad/s: odometry that turns faster has jumped
    max_angular_acceleration: float = 10.0  # rad/s^2: how fast the turn rate may change while gyro readings are lost
    gyro_bias: float = radians(10)          # rad/s: the largest bias of a gyro, in either direction
    gyro_scale_error: float = 0.007         # 1 sigma of the gyro's scale error if the floor is unknown; 3 sigma: 2 %


class Priors(NamedTuple):
    """Fields of a Surface, in its units, and the spread of its curvature."""

    slip_straight: float
    slip_straight_spread: float
    slip_turning: float
    slip_turning_spread: float
    curvature: float
    gyro_scale_error: float
    gyro_measurement_range: float
    heading_noise_turning: float
    heading_noise_straight: float
    distance_noise: float
    curvature_spread: float


# any floor. The noise was measured with five real robots, config/surfaces/create_lab_floor.yaml; the spreads are as
# wide as the differences between the slips of all files. Curvature: 0.5 % between the wheels, 0.25 m apart
UNKNOWN_FLOOR = Priors(
    slip_straight=0.0, slip_straight_spread=0.05, slip_turning=0.0, slip_turning_spread=0.3, curvature=0.0,
    gyro_scale_error=Bounds().gyro_scale_error, gyro_measurement_range=Bounds().max_turn_rate,
    heading_noise_turning=0.084, heading_noise_straight=0.066, distance_noise=0.044, curvature_spread=0.02)


def priors(surface: Surface | None) -> Priors:
    """Return the Priors of a Surface (None: the ideal surface)."""
    values = surface._asdict() if surface else {**dict.fromkeys(Priors._fields, 0.0), 'gyro_measurement_range': inf}
    given = Priors(*(values.get(field, 0.0) for field in Priors._fields))
    return given._replace(**{key: max(least, getattr(given, key)) for key, least in MIN_SPREADS.items()})
