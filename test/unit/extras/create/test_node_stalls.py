"""The node does not run for a while, in motion: commands that have waited in a queue do not drive the robot."""
import pytest

from driven_create import BOTH, STEP, started

DRIVING = 0.2, 0.3
REFUSAL = 'expected a zero command, or none for 0.6 s, before it is driven again'


def driving(robot_type, **params):
    """Return a DrivenCreate in motion."""
    driven = started(robot_type, **params)
    driven.drive(*DRIVING, seconds=1.0)
    assert any(driven.speeds) and not driven.refusals
    return driven


def stall(driven, seconds, command_first):
    """Stall; then the queued commands arrive, and their sender continues."""
    driven.stall(seconds)
    if command_first:
        driven.command(*DRIVING)
    driven.velocity = DRIVING
    driven.run(1.0)


@BOTH
@pytest.mark.parametrize('command_first', [True, False])
@pytest.mark.parametrize('seconds', [0.6, 0.9, 60])
def test_after_a_stall_a_sender_is_refused(robot_type, command_first, seconds):
    driven = driving(robot_type)
    stall(driven, seconds, command_first)
    assert driven.speeds == (0, 0) and driven.refusals[0].endswith(REFUSAL)     # the robot may not have answered either
    if command_first:
        assert driven.refusals[0] == f'this node did not run for {seconds:.1f} s; {REFUSAL}'
    driven.command_zero()
    driven.run(1.0)
    assert any(driven.speeds)


@BOTH
@pytest.mark.parametrize('seconds, params', [(0.25, {'cmd_vel_timeout': 0.1}), (0.4, {})])
def test_a_stall_in_which_no_command_expires_has_no_effect(robot_type, seconds, params):
    driven = driving(robot_type, **params)
    stall(driven, seconds - STEP / 1e9, True)
    assert any(driven.speeds) and not driven.refusals


@BOTH
def test_when_the_guardian_dies_a_sender_is_refused(robot_type):
    driven = driving(robot_type)
    driven.driver.stop(driven.now, 'the guardian process died')
    driven.pull()
    driven.velocity = DRIVING
    driven.run(0.1)
    assert driven.speeds == (0, 0)
    driven.connect()
    driven.run(2.0)
    assert driven.speeds == (0, 0) and driven.refusals[0] == f'the guardian process died; {REFUSAL}'
    driven.command_zero()
    driven.run(1.0)
    assert any(driven.speeds)
