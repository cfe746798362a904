"""The bytes that are sent to the robot; a stop takes effect after any incomplete command."""
import pytest

from rbx1_nav.extras.create import protocol, sequences

from rbx1_nav.extras.create.queries import probe

from driven_create import BOTH, started

COMMANDS = [protocol.drive_direct(500, -500), protocol.drive_direct(-1, -1), sequences.query(sequences.QUERIED),
            sequences.query(sequences.QUERIED_WITHOUT_ANGLE), sequences.query(sequences.QUERIED_ENCODERS),
            protocol.command('start'), protocol.command('safe'), protocol.command('full'),
            protocol.command('digital_outputs', 1), protocol.command('leds', 15, 255, 255),
            protocol.command('play_song', 1), protocol.command('digit_leds_ascii', *b'Stop')]
BEGINNINGS = sorted({command[:size] for command in COMMANDS for size in range(len(command) + 1)})


@BOTH
@pytest.mark.parametrize('stop', [lambda model: sequences.STOP, sequences.leave], ids=['stop', 'leave'])
def test_the_robot_stands_after_any_beginning_of_a_command(robot_type, stop):
    for mode in (2, 3):
        for beginning in BEGINNINGS:
            driven = started(robot_type, seconds=0.6, operation_mode=mode)
            driven.drive(0.3, 0.2, 0.1)
            assert driven.body.moving
            driven.connected = False
            driven.robot.receive(beginning + stop(driven.settings.model), driven.now)
            driven.run(0.05)
            assert driven.speeds == (0, 0), beginning.hex()


@pytest.mark.parametrize('model', protocol.MODELS.values(), ids=list(protocol.MODELS))
def test_nothing_that_is_sent_to_a_robot_that_is_off_resets_it(model):
    # a robot that is off takes each byte for a command
    reset = protocol.OPCODES['reset']
    for data in (sequences.STOP, sequences.FLUSH, sequences.START, sequences.leave(model),
                 sequences.guardian_stop(model), sequences.ASK_BATTERY, sequences.ASK_ENCODER, sequences.ASK_WALL,
                 *map(sequences.query, sequences.queried(model)),
                 *(sequences.query(probe(number)) for number in range(64))):
        assert reset not in data


def test_how_a_robot_is_left():
    create, create_2 = protocol.CREATE, protocol.CREATE_2
    assert sequences.leave(create) == sequences.STOP + bytes((147, 0, 128))
    assert sequences.leave(create_2) == sequences.STOP + bytes((128,))
    for model in create, create_2:
        assert sequences.guardian_stop(model) == sequences.leave(model) + bytes(512) + sequences.leave(model)


@pytest.mark.parametrize('mode, opcode', [(1, 128), (2, 131), (3, 132)])
def test_how_control_is_taken(mode, opcode):
    """Digital output 0 (147 1) switches on the power of the TurtleBot's sensors, unless the robot is not driven."""
    output = b'' if mode == 1 else bytes((147, 1))
    assert sequences.take_control(protocol.CREATE, mode) == bytes((opcode,)) + output
    assert sequences.take_control(protocol.CREATE_2, mode) == bytes((opcode,))
