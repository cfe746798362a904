"""The assumptions of the filter about a floor."""
from math import inf

import pytest

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import MIN_SPREADS, UNKNOWN_FLOOR, Bounds, Priors, priors
from sample_priors import IDEAL, SURFACES


def test_the_ideal_surface_has_no_errors_but_may_not_be_the_floor():
    # docs/filter.md: at least 0.02 in straight motion and 0.05 in turns
    assert IDEAL == Priors(slip_straight=0.0, slip_straight_spread=0.02, slip_turning=0.0, slip_turning_spread=0.05,
                           curvature=0.0, gyro_scale_error=0.003, gyro_measurement_range=inf,
                           heading_noise_turning=0.0, heading_noise_straight=0.0, distance_noise=0.0,
                           curvature_spread=0.02)


@pytest.mark.parametrize('name', ['hard_floor', 'low_ply_carpet', 'create_lab_floor'])
def test_the_priors_of_a_surface_are_its_values_with_at_least_the_differences_between_floors(name):
    surface = load_surface(name, SURFACES)
    values = priors(surface)._asdict()
    assert values.pop('curvature_spread') == 0.02
    for field, value in values.items():
        assert value == max(getattr(surface, field), MIN_SPREADS.get(field, -inf))


def test_an_unknown_floor_has_the_noise_of_a_lab_floor_and_any_slip():
    lab = priors(load_surface('create_lab_floor', SURFACES))
    for field in 'heading_noise_turning', 'heading_noise_straight', 'distance_noise':
        # the values of the file have two digits more
        assert getattr(UNKNOWN_FLOOR, field) == pytest.approx(getattr(lab, field), abs=5e-4)
    assert (UNKNOWN_FLOOR.slip_straight, UNKNOWN_FLOOR.slip_turning) == (0.0, 0.0)
    assert (UNKNOWN_FLOOR.slip_straight_spread, UNKNOWN_FLOOR.slip_turning_spread) == (0.05, 0.3)
    assert (UNKNOWN_FLOOR.curvature, UNKNOWN_FLOOR.curvature_spread) == (0.0, 0.02)


def test_on_an_unknown_floor_the_limits_are_the_errors_of_the_gyro():
    limits = Bounds(max_turn_rate=2.0, gyro_scale_error=0.03)
    assert CombinedOdometry(UNKNOWN_FLOOR, SECOND, limits=limits).prior == UNKNOWN_FLOOR._replace(
        gyro_scale_error=0.03, gyro_measurement_range=2.0)
    known = UNKNOWN_FLOOR._replace(slip_straight=0.01)
    assert CombinedOdometry(known, SECOND, limits=limits).prior == known
