"""A stop takes effect after any incomplete command."""
import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences

from driven_create import started

COMMANDS = [protocol.drive_direct(500, -500), protocol.drive_direct(-1, -1), sequences.query(sequences.QUERIED),
            sequences.query(sequences.QUERIED_WITHOUT_ANGLE), sequences.query(sequences.QUERIED_ENCODERS),
            protocol.command('start'), protocol.command('safe'), protocol.command('full'),
            protocol.command('digital_outputs', 1)]
BEGINNINGS = sorted({command[:size] for command in COMMANDS for size in range(len(command) + 1)})


@pytest.mark.parametrize('robot_type', ['create', 'create2'])
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


@pytest.mark.parametrize('model', protocol.MODELS.values(), ids=protocol.MODELS)
def test_nothing_that_is_sent_to_a_robot_that_is_off_resets_it(model):
    # a robot that is off takes each byte for a command
    reset = protocol.OPCODES['reset']
    for data in (sequences.STOP, sequences.FLUSH, sequences.START, sequences.leave(model),
                 sequences.guardian_stop(model), sequences.ASK_BATTERY, sequences.ASK_ENCODER, sequences.ASK_WALL,
                 *map(sequences.query, sequences.queried(model))):
        assert reset not in data
