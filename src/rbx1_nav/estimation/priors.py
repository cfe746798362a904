"""The filter's assumptions about the floor and the gyro before the first message."""
from __future__ import annotations

from math import inf
from typing import NamedTuple, Protocol

from rbx1_nav.estimation.limits import Limits

# least 1 sigma of the errors on a floor with a surface file, which is never the floor itself: the gyro's scale error,
# slip in turns and straight on, curvature (rad/m)
MIN_SPREADS = dict(gyro_scale_error=0.003, slip_turning_spread=0.05, slip_straight_spread=0.02, curvature_spread=0.02)


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


class Floor(Protocol):
    """A named tuple that has all fields of Priors but the last: a Surface."""

    def _asdict(self) -> dict[str, float]: ...


# any floor. The noise was measured with five real robots, config/surfaces/create_lab_floor.yaml; the spreads are as
# wide as the differences between the slips of all files
UNKNOWN_FLOOR = Priors(0.0, 0.05, 0.0, 0.3, 0.0, Limits().gyro_scale_error, Limits().max_turn_rate, 0.084, 0.066, 0.044,
                       0.05)


def priors(surface: Floor | None) -> Priors:
    """Return the Priors of a Surface (None: the ideal surface)."""
    values = surface._asdict() if surface else {**dict.fromkeys(Priors._fields, 0.0), 'gyro_measurement_range': inf}
    given = Priors(*(values.get(field, 0.0) for field in Priors._fields))
    return given._replace(**{key: max(least, getattr(given, key)) for key, least in MIN_SPREADS.items()})
