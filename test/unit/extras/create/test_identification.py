"""The search finds any robot at any rate, and never moves a robot or starts a program."""
from itertools import permutations

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.emulator.emulator import EmulatedCreate
from rbx1_nav.extras.create.emulator.serial_line import misread
from rbx1_nav.extras.create.identification import RATES, is_battery

from driven_create import DrivenCreate, started

KINDS = 'create', 'create2'     # which differ in their replies
ROBOTS = pytest.mark.parametrize('robot', KINDS)
AT_RATES = pytest.mark.parametrize('baud', RATES)
# the commands that do not move a robot, start one of its programs, change its rate, or make it deaf
ALLOWED = {'start', 'sensors', 'pause_resume_stream'}
HARMLESS = {protocol.OPCODES[name] for name in ALLOWED}
OPCODES = {opcode for model in protocol.MODELS.values() for opcode in model.commands} | {protocol.OPCODES['reset']}


def searching(robot, rate=None, robot_type='auto', **params):
    """Return a driver that has just connected to a robot at a rate."""
    driven = DrivenCreate(robot_type, robot=robot, **params)
    if rate:
        driven.line.baud = rate
    driven.run(0.05)        # the robot is on before the driver connects
    driven.connect()
    return driven


def names(driven):
    """Return the names of the commands that the robot has received."""
    return [driven.body.model.commands[data[0]].name for _, data in driven.commands]


@ROBOTS
@AT_RATES
@pytest.mark.parametrize('robot_type', ['auto', *KINDS])
def test_any_robot_is_found_at_any_rate_and_nothing_moves_before(robot, baud, robot_type):
    driven = searching(robot, baud, robot_type)
    while not driven.found and driven.now < 20 * SECOND:
        driven.run(0.002)
        assert not driven.body.moving and not driven.robot.programs_started
    # all commands that it has received, including those in garbage
    assert set(names(driven)) <= ALLOWED
    assert bool(driven.found) == (robot_type in ('auto', robot))
    if driven.found:
        driven.run(1)
        assert driven.found == protocol.MODELS[robot] and driven.driver.contact.found.baud == baud
        assert driven.log == [f'Connected to a {robot} at {baud} baud', 'The robot is in safe mode']
        driven.drive(0.2, 0, 0.5)
        assert driven.speeds == (200, 200)


@pytest.mark.parametrize('robot, robot_type', [*permutations(KINDS, 2), ('create', 'roomba600_wifi')])
def test_a_robot_of_the_wrong_type_is_reported_once_and_not_driven(robot, robot_type):
    driven = searching(robot, robot_type=robot_type)
    driven.drive(0.2, 0, 10)
    assert driven.log == ['A %s answers at %d baud: expected a %s; to drive it, restart this node with robot_type:=%s, '
                          'or auto' % (robot, protocol.MODELS[robot].baud, robot_type, robot)]
    assert not driven.body.moving and 'the robot does not answer' in driven.refusals


def test_another_robot_at_another_adapter_gets_no_command_before_it_is_known():
    driven = started('auto', robot='create')
    driven.pull()
    other = DrivenCreate('auto', robot='create2')
    driven.line, driven.robot, driven.body = other.line, other.robot, other.body
    driven.is_same = False
    driven.run(1)
    driven.connect()
    driven.run(2)
    assert set(names(other)) <= ALLOWED and not other.robot.programs_started
    assert driven.log[-1] == ('A create2 answers at 115200 baud: expected a create; to drive it, restart this node '
                              'with robot_type:=create2, or auto')


@ROBOTS
def test_a_robot_whose_stream_was_left_on_is_found(robot):
    driven = searching(robot)
    driven.connected = False
    driven.line.host_baud = driven.line.baud
    driven.write(sequences.START + protocol.command('stream', 2, 7, 35))
    driven.run(0.2)
    driven.connect()
    driven.run(2)
    assert driven.found and driven.driver.supervisor.in_control


@pytest.mark.parametrize('garbage', [b'\x8c\x00\xff', b'\x94\xff', b'\x91\x01'], ids=['song', 'stream', 'drive'])
@ROBOTS
def test_a_robot_that_waits_for_the_rest_of_garbage_is_found(robot, garbage):
    driven = searching(robot)
    driven.robot.receive(sequences.START + sequences.MODES[protocol.SAFE] + garbage, driven.now)
    driven.run(10)      # 512 bytes, a few at each rate
    assert driven.found and driven.speeds == (0, 0)


# a second line model, different from the emulated robot's: it samples bits at any ratio of the clocks, and after a byte
# without a stop bit, the receiver either continues at once or waits until the line is idle

def levels(data):
    return [level for byte in data for level in [0] + [byte >> bit & 1 for bit in range(8)] + [1]]


def received(data, ratio, patient):
    """Return the bytes that a receiver reads. ratio: bits sent per bit read; patient: whether it waits."""
    line, result, time = levels(data), [], 0.0

    def level(moment):
        return line[int(moment)] if moment < len(line) else 1
    while time < len(line):
        if level(time):
            time = int(time) + 1.0
            continue
        byte = sum(level(time + (bit + 1.5) * ratio) << bit for bit in range(8))
        time += 9.5 * ratio
        if level(time) or not patient:
            result.append(byte)
        while patient and not level(time):
            time += 0.05
    return result


@pytest.mark.parametrize('sent_at, read_at', permutations(RATES, 2))
def test_no_byte_of_the_search_is_a_command_at_another_rate(sent_at, read_at):
    for data in (sequences.START, sequences.ASK_BATTERY):
        assert set(misread(data, sent_at, read_at)) & OPCODES <= HARMLESS
        for error in range(-50, 51):        # the clocks differ by up to 5 %
            for patient in (False, True):
                ratio = sent_at / read_at * (1 + error / 1000)
                assert set(received(data, ratio, patient)) & OPCODES <= HARMLESS, (error, patient)


@pytest.mark.parametrize('data, whole', [
    ('000fa0fed419 0bb8 0bb8', False), ('02 3f80 fed4 19 0bb8 0bb8', True), ('06 3f80 fed4 19 0bb8 0bb8', False),
    ('02 3f80 fed4 19 0bb8 0bb8 00', False), ('02 3f80 fed4 d0 0bb8 0bb8', False), ('', False)])
def test_a_reply_about_the_battery(data, whole):
    assert is_battery(bytes.fromhex(data)) == whole


class SciRobot(EmulatedCreate):
    """A Roomba of the 400 series, whose interface (SCI) knows only the packet groups 0 to 3."""

    def _do_sensors(self, data):
        if data[0] <= 3:
            super()._do_sensors(data)


def test_a_roomba_400_is_named():
    driven = DrivenCreate('auto', robot='create')
    driven.robot = SciRobot(driven.body, driven.line, driven.now)
    driven.run(0.05)
    driven.connect()
    driven.run(20)
    assert driven.log == [
        'A robot answers at 57600 baud, but only the query of its battery, as a Roomba of the 400 series (SCI) does: '
        'expected a Create, Create 2, or Roomba 500 or 600']
    assert not driven.found and not driven.body.moving
