"""The filter's assumptions about the floor and the gyro before the first message."""
from __future__ import annotations

from math import inf
from typing import NamedTuple, Protocol

from rbx1_nav.estimation.limits import Limits


class Priors(NamedTuple):
    """Fields of a Surface, in its units."""

    slip_straight: float
    slip_straight_spread: float
    slip_turning: float
    slip_turning_spread: float
    gyro_scale_error: float
    gyro_measurement_range: float
    heading_noise_turning: float
    heading_noise_straight: float
    distance_noise: float


class Floor(Protocol):
    """A named tuple that has all fields of Priors: a Surface."""

    def _asdict(self) -> dict[str, float]: ...


# any floor. The noise was measured with five real robots, config/surfaces/create_lab_floor.yaml; the spreads are as
# wide as the differences between the slips of all files
UNKNOWN_FLOOR = Priors(0.0, 0.05, 0.0, 0.05, Limits().gyro_scale_error, Limits().max_turn_rate, 0.084, 0.066, 0.044)


def priors(surface: Floor | None) -> Priors:
    """Return the Priors of a Surface (None: the ideal surface)."""
    if surface is None:
        return Priors(0.0, 0.0, 0.0, 0.0, 0.0, inf, 0.0, 0.0, 0.0)
    values = surface._asdict()
    return Priors(*(values[field] for field in Priors._fields))
