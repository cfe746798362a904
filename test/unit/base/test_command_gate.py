"""The gate: a command in force is finite, within the limits, and has an age."""
from math import inf, nan

import pytest

from rbx1_nav.base.command_gate import MAX_COMMAND, CommandGate, RejectedCommand
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND


def make_gate(linear=inf, angular=inf, timeout=SECOND):
    return CommandGate(Limits(linear, angular), timeout)


def test_a_command_within_the_limits_is_in_force_unchanged():
    gate = make_gate(0.3, 0.5)
    assert not (gate.moving or gate.command(5, -0.3, 0.5))
    assert (gate.linear, gate.angular, gate.command_time) == (-0.3, 0.5, 5)
    assert gate.moving and gate.clamped == 0


@pytest.mark.parametrize('command, value', [
    ((nan, 0.0), 'nan'), ((0.2, inf), 'inf'), ((-inf, nan), '-inf'), ((0.2, 0.3, (0.0, nan)), 'nan'),
    ((1e308, 1e308), '1e+308'), ((0.0, -1.0001 * MAX_COMMAND), '-1000100.0'), ((0.0, 0.0, (-inf,)), '-inf')])
def test_values_that_are_not_finite_or_too_large_are_rejected(command, value):
    gate = make_gate()
    gate.command(0, 0.2, 0.3)
    with pytest.raises(RejectedCommand) as error:
        gate.command(7, *command)
    assert str(error.value) == f'{value}: expected finite numbers of at most 1e+06'
    assert (gate.linear, gate.angular) == (0.0, 0.0) and not gate.moving
    assert (gate.rejected, gate.command_time) == (1, 7)


def test_velocities_that_the_base_cannot_follow_do_not_change_the_command():
    gate = make_gate()
    assert not gate.command(0, 0.2, 0.3, (1.0, -2.0, 0.0, 4.0))
    assert (gate.linear, gate.angular, gate.rejected) == (0.2, 0.3, 0)


def test_a_clamped_command_has_the_speed_of_the_limit():
    gate = make_gate(0.3, 0.5)
    assert gate.command(0, -1.0, 0.1) and (gate.linear, gate.angular) == (-0.3, 0.1)
    assert gate.command(0, 0.1, 2.0) and (gate.linear, gate.angular) == (0.1, 0.5)
    assert gate.command(0, 0.1, MAX_COMMAND) and gate.command(0, 0.1, -MAX_COMMAND)
    assert (gate.clamped, gate.angular) == (4, -0.5)
    gate.forget()
    assert (gate.linear, gate.angular, gate.moving, gate.command_time, gate.expiry) == (0, 0, False, None, inf)


def test_a_command_expires_a_timeout_after_its_arrival():
    gate = make_gate(timeout=SECOND // 2)
    gate.command(3 * SECOND, 0.2, 0.0)
    assert gate.expiry == 3 * SECOND + SECOND // 2
    gate.command(4 * SECOND, 0.2, 0.0)      # the same command again
    assert gate.expiry == 4 * SECOND + SECOND // 2 and gate.command_time == 4 * SECOND


def test_without_a_timeout_a_command_never_expires():
    gate = make_gate(timeout=0)
    gate.command(3 * SECOND, 0.2, 0.0)
    assert gate.expiry == inf
