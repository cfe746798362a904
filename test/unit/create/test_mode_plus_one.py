"""Robots that report their mode plus one."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.emulator.body import Quirks

from driven_create import DrivenCreate, started

BOTH = pytest.mark.parametrize('robot_type', ['create', 'create2'])
MODES = pytest.mark.parametrize('mode', [protocol.PASSIVE, protocol.SAFE, protocol.FULL])
PLUS_ONE = Quirks(mode_plus_one=True)
REPORTED = 'The robot reports its mode plus one: expected a mode from 0 to 3; corrected, as with ' \
           'oi_mode_workaround:=true'


@BOTH
@MODES
@pytest.mark.parametrize('plus_one', [False, True])
def test_the_offset_of_the_mode_is_found(robot_type, mode, plus_one):
    driven = started(robot_type, quirks=Quirks(mode_plus_one=plus_one), operation_mode=mode)
    assert driven.robot.mode == driven.driver.supervisor.mode == mode
    assert driven.log.count(REPORTED) == plus_one and len(driven.log) == 2 + plus_one
    driven.drive(0.2, 0, 0.2)
    assert driven.body.moving == (mode != protocol.PASSIVE)
    assert driven.driver.queries.reader.rejected == 0


@BOTH
@pytest.mark.parametrize('workaround', [False, True])
def test_a_given_offset_is_not_questioned(robot_type, workaround):
    driven = started(robot_type, quirks=PLUS_ONE, oi_mode_workaround=workaround)
    assert driven.driver.supervisor.in_control
    # without the correction, passive mode is taken for safe mode
    driven.drive(0.2, 0, 0.2)
    assert driven.body.moving == workaround


@BOTH
@pytest.mark.parametrize('fault, reason', [('wheel_dropped', 'a wheel dropped'), ('docked', 'on the dock')])
def test_an_obstacle_at_the_start_does_not_deceive_the_search_for_the_offset(robot_type, fault, reason):
    driven = DrivenCreate(robot_type, quirks=PLUS_ONE)
    setattr(driven.body, fault, True)
    driven.connect()
    driven.run(3)
    # passive mode is reported as safe mode
    assert driven.robot.mode == protocol.PASSIVE and not driven.driver.supervisor.in_control
    assert reason in driven.driver.supervisor.reason
    setattr(driven.body, fault, False)
    driven.run(2)
    assert driven.robot.mode == protocol.SAFE and driven.driver.supervisor.in_control
    driven.drive(0.2, 0, 0.2)
    assert driven.speeds == (200, 200)


@BOTH
def test_a_robot_of_unknown_offset_confirms_the_last_stop(robot_type):
    driven = DrivenCreate(robot_type, quirks=PLUS_ONE)
    driven.body.wheel_dropped = True
    driven.connect()
    driven.run(2)
    driven.driver.leave(driven.now)
    driven.run(0.2)
    assert driven.driver.left


@BOTH
@pytest.mark.parametrize('fault', ['wheel_dropped', 'docked'])
def test_the_offset_survives_what_ends_safe_mode(robot_type, fault):
    driven = started(robot_type, quirks=PLUS_ONE)
    driven.drive(0.2, 0, 0.5)
    setattr(driven.body, fault, True)
    driven.run(1)
    assert driven.driver.supervisor.mode == protocol.PASSIVE
    setattr(driven.body, fault, False)
    driven.run(3)
    assert driven.driver.supervisor.in_control and driven.log.count(REPORTED) == 1
    driven.drive(0.2, 0, 0.2)
    assert driven.speeds == (200, 200)


@BOTH
@MODES
def test_a_wrong_workaround_is_named_with_the_mode_that_was_expected(robot_type, mode):
    driven = started(robot_type, 5, oi_mode_workaround=True, operation_mode=mode)
    name = protocol.MODE_NAMES[mode]
    assert driven.log[1:] == [
        'The robot cannot be driven: it reports mode %d after it was asked for %s mode: expected %d with '
        'oi_mode_workaround:=true; without this parameter the base detects it' % (mode, name, mode + 1)]
    # the node subscribes to commands, and refuses them with the reason
    assert driven.driver.is_ready
    driven.drive(0.2, 0, 1)
    assert not driven.body.moving and any('oi_mode_workaround' in text for text in driven.refusals)


@BOTH
def test_a_robot_in_full_mode_that_reports_one_more_than_allowed_is_driven(robot_type):
    driven = started(robot_type, 5, quirks=PLUS_ONE, oi_mode_workaround=False, operation_mode=protocol.FULL)
    assert driven.log[1:] == ['The robot is in full mode'] and driven.driver.supervisor.in_control


@BOTH
def test_a_robot_that_is_obstructed_does_not_make_the_workaround_suspicious(robot_type):
    driven = DrivenCreate(robot_type, quirks=PLUS_ONE, oi_mode_workaround=True)
    driven.body.wheel_dropped = True
    driven.connect()
    driven.run(5)
    driven.body.wheel_dropped = False
    driven.run(3)
    assert driven.driver.supervisor.in_control and not any('oi_mode_workaround' in line for line in driven.log)


@BOTH
@pytest.mark.parametrize('event', ['silence', 'power cycle'])
def test_the_offset_of_the_mode_is_logged_once(robot_type, event):
    driven = started(robot_type, quirks=PLUS_ONE)
    for _ in range(2):
        if event == 'silence':
            driven.line.silent = True
            driven.run(3)
            driven.line.silent = False
        else:
            driven.robot.switch_on(driven.now)
        driven.run(5)
        assert driven.driver.supervisor.in_control
    assert driven.log.count(REPORTED) == 1
