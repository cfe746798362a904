"""Robots that report their mode plus one, with and without oi_mode_workaround."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.emulator.body import Quirks

from driven_create import BOTH, started

MODES = pytest.mark.parametrize('mode', [protocol.PASSIVE, protocol.SAFE, protocol.FULL])


@BOTH
@MODES
@pytest.mark.parametrize('plus_one', [False, True])
def test_with_the_right_workaround_the_robot_is_driven(robot_type, mode, plus_one):
    driven = started(robot_type, quirks=Quirks(mode_plus_one=plus_one), operation_mode=mode,
                     oi_mode_workaround=plus_one)
    assert driven.robot.mode == driven.driver.supervisor.mode == mode and len(driven.log) == 2
    driven.drive(0.2, 0, 0.2)
    assert driven.body.moving == (mode != protocol.PASSIVE)
    driven.body.wheel_dropped = True
    driven.run(1)
    driven.body.wheel_dropped = False
    driven.run(2)
    driven.command_zero()
    assert driven.driver.supervisor.in_control
    driven.driver.leave(driven.now)
    driven.run(0.2)
    assert driven.driver.left


@BOTH
@pytest.mark.parametrize('mode', [protocol.PASSIVE, protocol.SAFE])
@pytest.mark.parametrize('plus_one', [False, True])
def test_a_wrong_workaround_is_named_and_the_robot_is_not_driven(robot_type, mode, plus_one):
    driven = started(robot_type, 5, quirks=Quirks(mode_plus_one=plus_one), operation_mode=mode,
                     oi_mode_workaround=not plus_one)
    assert driven.log[1:] == [
        'The robot cannot be driven: it reports mode %d after it was asked for %s mode: expected %d, or '
        'oi_mode_workaround:=%s' % (mode + plus_one, protocol.MODE_NAMES[mode], mode + 1 - plus_one,
                                    str(plus_one).lower())]
    # the node subscribes to commands, and refuses them with the reason
    assert driven.driver.is_ready
    driven.drive(0.2, 0, 1)
    assert not driven.body.moving or plus_one       # in that case, it is in safe mode
    assert any('oi_mode_workaround' in text for text in driven.refusals)
