"""Each key that a surface declares changes what a simulated robot does, or what it measures, and suits the fit."""
import numpy
import pytest

from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.surfaces import KEYS
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation.simulated_base import make_base
from rbx1_nav.simulation.slip import floor_travel
from sample_surface import SURFACE

ROBOT = read_robot({'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26}}})
COMMANDS = (0.0, 0.0), (0.3, 0.0), (0.0, 0.0), (0.0, 1.0), (0.2, 0.5), (-0.2, 0.5)     # m/s, rad/s, for a second each


def drive(surface):
    """Return the true pose, the odometry and the reading of the gyro after each second."""
    base, found = make_base(ROBOT, surface, seed=1), []
    base.read_gyro()
    for number, (linear, angular) in enumerate(COMMANDS):
        for tick in range(50):
            base.command(number * SECOND + tick * SECOND // 50, linear, angular)
        base.advance((number + 1) * SECOND)
        found.append((base.wheels.truth.pose, base.odometry.pose, base.read_gyro()))
    return found


@pytest.mark.parametrize('key', KEYS)
def test_a_key_that_is_declared_is_used(key):
    limits = (KEYS[key].to_si(limit) for limit in (KEYS[key].low, KEYS[key].high))
    assert any(drive(SURFACE._replace(**{key: limit})) != drive(SURFACE) for limit in limits)


@pytest.mark.parametrize('key', KEYS)
def test_the_travel_of_arrays_is_that_of_numbers(key):
    surface = SURFACE._replace(**{key: KEYS[key].limits[1]})
    found = floor_travel(surface, surface, *numpy.transpose(COMMANDS), numpy.copysign, numpy.maximum)
    assert numpy.allclose(numpy.transpose(found), [floor_travel(surface, surface, *each) for each in COMMANDS])
