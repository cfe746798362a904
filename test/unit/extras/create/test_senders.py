"""Whatever stops the robot, a sender that has not noticed it does not drive it on: scenario x what the sender does."""
from itertools import product

import pytest

from rbx1_nav.extras.create import protocol

from driven_create import BOTH, started

DRIVING = 0.2, 0.3
REFUSAL = 'expected a zero command, or none for 0.6 s, before it is driven again'


def drop_a_wheel(driven):
    driven.body.switches = 8
    driven.run(1)
    driven.body.switches = 0
    driven.run(2)       # the driver takes control again


def see_a_cliff(driven):
    driven.body.cliffs = 6
    driven.run(0.5)
    driven.body.cliffs = 0


def reset(driven):
    driven.robot.switch_on(driven.now)
    driven.run(4)


def pull_the_cable(driven):
    driven.pull()
    driven.run(0.5)
    driven.connect()


def silence(driven):
    driven.line.silent = True
    driven.run(1)
    driven.line.silent = False


def hang(driven):
    driven.hang(1.5)
    driven.run(1.5)


def stall_the_node(driven):
    driven.stall(0.9)
    driven.command(*DRIVING)        # the commands that have waited


def suspend_the_computer(driven):
    driven.connected, driven.velocity = False, None     # the robot drives on
    driven.run(20)
    driven.connected = True


def kill_the_guardian(driven):
    driven.driver.stop(driven.now, 'the guardian process died')
    driven.pull()
    driven.run(0.1)
    driven.connect()


SCENARIOS = [drop_a_wheel, reset, pull_the_cable, silence, hang, stall_the_node, suspend_the_computer,
             kill_the_guardian]


def goes_on(driven):
    """It is refused until it sends a zero command."""
    for _ in range(20):
        driven.drive(*DRIVING, 0.1)
        assert driven.speeds == (0, 0)
    assert driven.refusals[-1].endswith(REFUSAL)
    driven.command_zero()


def gives_up(driven):
    driven.run(2)
    assert driven.speeds == (0, 0)


def another_helps(driven):
    """Another node is obeyed, and the first one is not."""
    driven.run(0.6)
    driven.command(*DRIVING, sender='hand')
    driven.run(0.1)
    assert any(driven.speeds)
    driven.command(0, 0, sender='hand')


@BOTH
@pytest.mark.parametrize('mode, scenario', [
    *product([protocol.SAFE, protocol.FULL], SCENARIOS), (protocol.SAFE, see_a_cliff)])
@pytest.mark.parametrize('sender', [goes_on, gives_up, another_helps])
def test_after_a_stop_only_who_has_noticed_it_drives_the_robot(scenario, sender, mode, robot_type):
    driven = started(robot_type, 1.2, operation_mode=mode)
    driven.drive(*DRIVING, 0.5)
    assert any(driven.speeds) and not driven.refusals
    driven.velocity = DRIVING if sender is goes_on else None
    scenario(driven)
    driven.velocity = DRIVING if sender is goes_on else None
    driven.run(0.6)
    assert driven.speeds == (0, 0)
    sender(driven)
    if sender is another_helps:
        return
    driven.run(0.7)
    driven.refusals.clear()
    driven.drive(*DRIVING, 0.3)
    assert any(driven.speeds) and not driven.refusals


@BOTH
@pytest.mark.parametrize('seconds, params', [(0.25, {'cmd_vel_timeout': 0.1}), (0.4, {})])
def test_a_stall_in_which_no_command_expires_has_no_effect(robot_type, seconds, params):
    driven = started(robot_type, **params)
    driven.drive(*DRIVING, 1)
    driven.stall(seconds)
    driven.command(*DRIVING)
    driven.drive(*DRIVING, 1)
    assert any(driven.speeds) and not driven.refusals


@BOTH
def test_a_short_outage_does_no_harm(robot_type):
    driven = started(robot_type)
    driven.drive(*DRIVING, 1)
    driven.pull()
    driven.drive(*DRIVING, 0.2)
    driven.connect()
    driven.drive(*DRIVING, 0.3)
    assert any(driven.speeds) and not driven.refusals
