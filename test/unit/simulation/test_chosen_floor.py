"""A running base reads its floor again at a reset: the next run equals a run of a base that was started there."""
import pytest
from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.node import resources
from rbx1_nav.node.config import ConfigError
from rbx1_nav.simulation.floor_parameters import ChosenFloor
from rbx1_nav.simulation.simulated_base import make_base, speed_window

PERIOD = 20_000_000     # ns


def test_only_what_has_changed_is_read():
    stored = {'surface': 'ideal', 'rate': 50}
    floor = ChosenFloor(lambda: dict(stored))
    assert floor.changed() is None
    stored.update(surface='low_ply_carpet', seed='7')
    surface, seed = floor.changed()
    assert (surface.name, seed) == ('low_ply_carpet', 7) and floor.changed() is None
    stored['seed'] = 8
    assert floor.changed()[1] == 8
    stored['surface'] = 'ideal'
    assert floor.changed() == (None, 8)


@pytest.mark.parametrize('name', ['/etc/passwd', 'sand', '../hard_floor', 5])
def test_a_running_base_knows_only_its_own_surfaces(name):
    stored = {}
    floor = ChosenFloor(lambda: dict(stored))
    stored['surface'] = name
    for _ in range(2):
        with pytest.raises(ConfigError, match='surface: .*: expected one of .*hard_floor'):
            floor.changed()
    stored['surface'] = 'ideal'
    assert floor.changed() is None


def drive(base, start):
    for tick in range(1, 100):
        base.command(start + tick * PERIOD, 0.2, 0.3)
    return base.wheels.truth.pose, base.odometry.pose


@pytest.mark.parametrize('before, after', [(None, 'low_ply_carpet'), ('hard_floor', 'low_ply_carpet'),
                                           ('low_ply_carpet', None)])
def test_the_next_run_is_as_on_a_base_that_was_started_there(before, after):
    robot = read_robot({'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'ticks_meter': 4100}}})
    floors = [name and load_surface(name, resources.surfaces()) for name in (before, after)]
    base, fresh = make_base(robot, floors[0], 3), make_base(robot, floors[1], 7)
    drive(base, 0)
    base.change_floor(floors[1], 7, speed_window(robot))
    base.reset()
    # to the last bits: the counted travel of the wheels goes on
    for pose, expected in zip(drive(base, base.now), drive(fresh, 0)):
        assert pose == pytest.approx(expected, abs=1e-9)
