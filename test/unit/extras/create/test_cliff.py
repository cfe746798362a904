"""At a cliff, a robot in safe mode can only be backed up."""
import pytest

from rbx1_nav.extras.create import protocol

from driven_create import BOTH, started

REFUSAL = 'a cliff: expected a command that backs up'


def at_a_cliff(robot_type, **params):
    """Return a robot that has stopped at a cliff."""
    driven = started(robot_type, **params)
    driven.drive(0.2, 0, 1)
    driven.body.cliffs = 6
    driven.drive(0.2, 0, 0.5)
    driven.command_zero()
    driven.run(0.5)
    driven.refusals.clear()
    driven.commands.clear()
    return driven


def asks_for_mode(driven):
    return any(data[0] == protocol.OPCODES['safe'] for _, data in driven.commands)


@BOTH
@pytest.mark.parametrize('angular', [0.0, 1.0])
def test_the_robot_can_be_backed_up(robot_type, angular):
    driven = at_a_cliff(robot_type)
    assert driven.speeds == (0, 0) and driven.robot.mode == protocol.PASSIVE
    x = driven.truth.x
    driven.drive(-0.2, angular, 1)
    assert driven.truth.x < x - 0.1 and not driven.refusals
    # the sensors still see the cliff
    driven.command_zero()
    driven.drive(0.2, 0, 0.5)
    assert driven.speeds == (0, 0) and set(driven.refusals) == {REFUSAL}
    driven.body.cliffs = 0
    driven.command_zero()
    driven.run(0.1)
    driven.drive(0.2, 0, 0.5)
    assert driven.speeds == (200, 200)


@BOTH
@pytest.mark.parametrize('velocity', [(0.2, 0.0), (0.0, 1.0), (-0.1, 1.0)])
def test_other_commands_do_not_ask_for_the_mode(robot_type, velocity):
    driven = at_a_cliff(robot_type)
    driven.drive(*velocity, 3)
    assert driven.speeds == (0, 0) and not asks_for_mode(driven) and REFUSAL in driven.refusals


@BOTH
def test_one_corrupted_reading_is_no_cliff(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 1)
    driven.driver.acceptance.feel(dict(driven.driver.reading, cliff_left=1))
    driven.command(0.2, 0)
    driven.drive(0.2, 0, 0.3)
    assert not driven.refusals and driven.speeds == (200, 200)
    # two are a cliff
    for _ in range(2):
        driven.driver.acceptance.feel(dict(driven.driver.reading, cliff_left=1))
    driven.command(0.2, 0)
    assert driven.refusals == [REFUSAL]
