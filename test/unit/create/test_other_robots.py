"""The driver with robots that differ from their specification, and with what happens to them."""
from math import degrees, pi

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.fractions import AUTO, KEPT, LOST
from rbx1_nav.create.emulator.body import Quirks
from rbx1_nav.create.emulator.emulator import EmulatedCreate
from rbx1_nav.create.emulator.serial_line import SerialLine
from rbx1_nav.simulation.surfaces import load_surface

from driven_create import SURFACES, DrivenCreate, started

BOTH = pytest.mark.parametrize('robot_type', ['create', 'create2'])
MODES = pytest.mark.parametrize('mode', [protocol.PASSIVE, protocol.SAFE, protocol.FULL])
PLUS_ONE = Quirks(mode_plus_one=True)
REPORTED = 'The robot reports its mode plus one: expected a mode from 0 to 3; corrected, as with ' \
           'oi_mode_workaround:=true'


# robots that report their mode plus one

@BOTH
@MODES
@pytest.mark.parametrize('plus_one', [False, True])
def test_the_offset_of_the_mode_is_found(robot_type, mode, plus_one):
    driven = started(robot_type, quirks=Quirks(mode_plus_one=plus_one), operation_mode=mode)
    assert driven.robot.mode == driven.driver.supervisor.mode == mode
    assert driven.log.count(REPORTED) == plus_one and len(driven.log) == 2 + plus_one
    driven.drive(0.2, 0, 0.2)
    assert driven.body.moving == (mode != protocol.PASSIVE)
    assert driven.driver.reader.rejected == 0


@BOTH
@pytest.mark.parametrize('workaround', [False, True])
def test_a_given_offset_is_not_questioned(robot_type, workaround):
    driven = started(robot_type, quirks=PLUS_ONE, oi_mode_workaround=workaround)
    assert driven.driver.supervisor.in_control
    # without the correction, safe mode is passive mode: that is how it was
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


# robots that lose fractions of a degree

def turn(driven, rate, angle):
    """Turn by an angle (rad) at a rate (rad/s). Returns what the odometry reports and what the wheels did, degrees."""
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
    assert kind == LOST if lost else kind in (AUTO, KEPT)
    # the next turn is one of a robot that is known
    reported, true = turn(driven, -rate, pi)
    assert reported == pytest.approx(true, rel=0.03)


@pytest.mark.parametrize('kind, drops', [(LOST, True), (KEPT, False)])
def test_a_robot_that_is_known_is_not_examined(kind, drops):
    driven = started('create', quirks=Quirks(drops_fractions=drops), angle_fractions=kind)
    assert driven.driver.counter.fractions.coarse == (kind == LOST)
    reported, true = turn(driven, 1.0, pi / 2)
    assert reported == pytest.approx(true, rel=0.03)


def test_a_robot_that_keeps_fractions_is_asked_for_the_angle_each_time():
    driven = started('create')
    turn(driven, 1.0, 2 * pi)
    queries = [data for _, data in driven.commands if data[0] == protocol.OPCODES['query_list']]
    assert set(queries) == {sequences.query(sequences.QUERIED)}


# senders that go on as if nothing had happened

def drop_a_wheel(driven):
    driven.body.wheel_dropped = True
    driven.drive(0.2, 0, 1)
    driven.body.wheel_dropped = False


def reset(driven):
    driven.robot.switch_on(driven.now)


def pull_the_cable(driven):
    driven.pull()
    driven.drive(0.2, 0, 0.5)
    driven.connect()


def silence(driven):
    driven.line.silent = True
    driven.drive(0.2, 0, 1)
    driven.line.silent = False


@BOTH
@pytest.mark.parametrize('mode', [protocol.SAFE, protocol.FULL])
@pytest.mark.parametrize('event', [drop_a_wheel, reset, pull_the_cable, silence])
def test_a_sender_that_has_not_noticed_does_not_drive_the_robot_on(robot_type, mode, event):
    driven = started(robot_type, operation_mode=mode)
    driven.drive(0.2, 0, 1)
    assert driven.speeds == (200, 200) and not driven.refusals
    event(driven)
    driven.drive(0.2, 0, 0.1)       # as long as nothing has reached the robot, it goes on
    for _ in range(50):
        driven.drive(0.2, 0, 0.1)
        assert driven.speeds == (0, 0)
    assert driven.driver.supervisor.in_control and driven.refusals
    driven.command_zero()
    driven.drive(0.2, 0, 0.2)
    assert driven.speeds == (200, 200)


@BOTH
def test_a_short_outage_does_no_harm(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 1)
    driven.pull()
    driven.drive(0.2, 0, 0.2)
    driven.connect()
    driven.drive(0.2, 0, 0.3)
    assert driven.speeds == (200, 200) and not driven.refusals


@BOTH
def test_a_bump_refuses_forward_motion_at_once_and_no_longer_than_it_lasts(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.body.bumped = True
    driven.drive(0.2, 0, 0.1)
    assert set(driven.refusals) == {'a bumper is pressed'}
    count = len(driven.refusals)
    driven.drive(-0.2, 0, 0.5)
    driven.body.bumped = False
    driven.run(0.1)
    driven.drive(0.2, 0, 0.5)
    assert driven.speeds == (200, 200) and len(driven.refusals) == count


# the last stop

@BOTH
def test_the_robot_confirms_the_last_stop(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.driver.leave(driven.now)
    assert not driven.driver.left
    driven.run(0.1)
    assert driven.driver.left and driven.robot.mode == protocol.PASSIVE and driven.speeds == (0, 0)


@BOTH
@pytest.mark.parametrize('garbage', [b'\x8c\x00\xff', b'\x94\xff'], ids=['song', 'stream'])
def test_the_last_stop_holds_after_garbage(robot_type, garbage):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.write(garbage)
    driven.driver.leave(driven.now)
    driven.run(0.3)
    assert driven.driver.left and driven.speeds == (0, 0)


@BOTH
@pytest.mark.parametrize('garbage', [b'\x8c\x00\xff', b'\x94\xff'], ids=['song', 'stream'])
def test_a_stop_after_a_reconnection_holds_after_garbage(robot_type, garbage):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.pull()
    driven.robot.receive(garbage, driven.now)
    driven.run(0.5)
    driven.connect()
    driven.run(0.3)
    assert driven.speeds == (0, 0) and driven.driver.contact.answers


@BOTH
@pytest.mark.parametrize('drives', [False, True])
def test_only_a_robot_that_may_still_move_must_confirm_the_last_stop(robot_type, drives):
    driven = started(robot_type)
    if drives:
        driven.drive(0.2, 0, 0.5)
    driven.line.silent = True
    driven.run(1.5)
    driven.driver.leave(driven.now)
    driven.run(0.6)
    assert driven.driver.left == (not drives) and driven.body.moving == drives


def test_a_line_without_a_robot_needs_no_confirmation():
    driven = DrivenCreate('auto', robot='create')
    driven.line.silent = True
    driven.connect()
    driven.run(1)
    driven.driver.leave(driven.now)
    assert driven.driver.left


# robots that are exchanged, disturbed or blocked

@BOTH
def test_a_create_at_the_slowest_rate_is_driven(robot_type):
    driven = DrivenCreate(robot_type)
    driven.robot = EmulatedCreate(driven.robot.model, driven.body, SerialLine(19200), driven.now)
    driven.line = driven.robot.line
    driven.connect()
    driven.run(2)
    driven.drive(0.2, 0.5, 10)
    driven.run(1)
    assert driven.driver.contact.dropouts == driven.driver.reader.rejected == 0
    assert driven.pose.x == pytest.approx(driven.truth.x, abs=0.01) and len(driven.states) > 200


def test_another_robot_at_another_adapter_gets_no_command_before_it_is_known():
    driven = started('auto', robot='create')
    driven.pull()
    other = DrivenCreate('auto', robot='create2')
    driven.line, driven.robot, driven.body = other.line, other.robot, other.body
    driven.is_same = False
    driven.run(1)
    driven.connect()
    driven.run(2)
    assert {data for _, data in other.commands} <= {sequences.START, b'\x8e\x03', b'\x8e\x2b', b'\x8e\x08', b'\x96\x00'}
    assert not other.robot.programs.started
    assert driven.log[-1] == 'A create2 answers at 115200 baud, in place of a create: restart this node to drive it'


@BOTH
@pytest.mark.parametrize('seconds', [0.0, 0.05, 0.3])
def test_a_program_that_another_process_has_started_ends(robot_type, seconds):
    driven = started(robot_type)
    driven.robot.receive(protocol.command('spot'), driven.now)
    driven.run(seconds)
    driven.driver.restore(driven.now)
    driven.run(0.03)
    assert driven.robot.programs.started == 1 and driven.speeds == (0, 0)


@BOTH
def test_a_robot_whose_settings_were_restored_drives_on(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.driver.restore(driven.now)
    driven.drive(0.2, 0, 0.5)
    assert not driven.refusals and driven.speeds == (200, 200)


@BOTH
def test_a_command_is_refused_if_the_wheels_do_not_turn(robot_type):
    # safe mode is reported, passive mode is meant
    driven = started(robot_type, quirks=PLUS_ONE, oi_mode_workaround=False)
    driven.drive(0.2, 0, 0.4)
    assert not driven.refusals
    driven.drive(0.2, 0, 0.4)
    assert driven.refusals[0].startswith(
        'its wheels do not turn: expected wheels that are free, and oi_mode_workaround: auto')


@BOTH
def test_a_robot_that_stood_while_it_was_out_of_reach_has_wheels_that_turn(robot_type):
    driven = started(robot_type)
    driven.drive(0.2, 0, 0.5)
    driven.pull()
    driven.body.wheel_dropped = True
    driven.run(2)
    driven.body.wheel_dropped = False
    driven.connect()
    driven.run(2)
    driven.command_zero()
    driven.refusals.clear()
    driven.drive(0.2, 0, 0.5)
    assert not driven.refusals and driven.speeds == (200, 200)


def test_a_create_2_that_was_not_reset_while_it_stood_is_not_said_to_be():
    driven = started('create2')
    driven.pull()
    driven.run(1)
    driven.is_same = False
    driven.connect()
    driven.run(2)
    assert not any('reset' in line for line in driven.log)


# a given offset that is wrong

@BOTH
@MODES
def test_a_wrong_workaround_is_named_with_the_mode_that_was_expected(robot_type, mode):
    driven = started(robot_type, 5, oi_mode_workaround=True, operation_mode=mode)
    name = protocol.MODE_NAMES[mode]
    assert driven.log[1:] == [
        'The robot is not driven: it reports mode %d after it was asked for %s mode: expected %d with '
        'oi_mode_workaround:=true; without this parameter the base finds out' % (mode, name, mode + 1)]
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


# fractions that are lost

@pytest.mark.parametrize('drops', [False, True])
def test_the_base_logs_once_that_fractions_are_lost(drops):
    driven = started('create', quirks=Quirks(drops_fractions=drops))
    for _ in range(3):
        turn(driven, 0.5, 2 * pi)
    lines = [line for line in driven.log if 'fractions' in line]
    assert lines == ['The robot loses fractions of a degree: the odometry is corrected. angle_fractions:=lost corrects '
                     'it from the start'] * drops


def test_what_is_known_of_fractions_is_not_logged():
    driven = started('create', quirks=Quirks(drops_fractions=True), angle_fractions=LOST)
    turn(driven, 0.5, 2 * pi)
    assert not any('fractions' in line for line in driven.log)
