"""Robots that lose fractions of a degree."""
from math import degrees, pi

import pytest

from rbx1_nav.create.driver.fractions import KEPT, LOST
from rbx1_nav.create.emulator.body import Quirks
from rbx1_nav.simulation.surfaces import load_surface

from driven_create import SURFACES, started


def turn(driven, rate, angle):
    """Turn by an angle (rad) at a rate (rad/s). Returns the turns (degrees) of the odometry and of the wheels."""
    before = driven.pose.yaw, driven.body.angle.total
    driven.drive(0, rate, angle / abs(rate))
    driven.command_zero()
    driven.run(2)
    return degrees(driven.pose.yaw - before[0]), driven.body.angle.total - before[1]


@pytest.mark.parametrize('rate', [0.3, 0.5, 1.0, -1.0])
@pytest.mark.parametrize('lost', [False, True])
@pytest.mark.parametrize('surface', ['ideal', 'hard_floor', 'low_ply_carpet'])
def test_a_turn_is_reported_whatever_the_robot_does_with_fractions(surface, lost, rate):
    driven = started('create', surface=load_surface(surface, SURFACES), quirks=Quirks(drops_fractions=lost))
    reported, true = turn(driven, rate, 2 * pi)
    assert reported == pytest.approx(true, rel=0.03)
    kind = driven.driver.counter.fractions.kind
    assert kind == (LOST if lost else KEPT)
    # at the next turn, the handling of fractions is known
    reported, true = turn(driven, -rate, pi)
    assert reported == pytest.approx(true, rel=0.03)


@pytest.mark.parametrize('drops', [False, True])
def test_the_base_logs_once_that_fractions_are_lost(drops):
    driven = started('create', quirks=Quirks(drops_fractions=drops))
    for _ in range(3):
        turn(driven, 0.5, 2 * pi)
    lines = [line for line in driven.log if 'fractions' in line]
    assert lines == ['The robot loses fractions of a degree: correcting the odometry. Set angle_fractions:=lost to '
                     'correct it from the start'] * drops
