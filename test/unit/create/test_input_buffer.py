"""The buffer for bytes that the robot has not executed yet: the longest command fits, and its size is limited."""
import pytest

from rbx1_nav.create.emulator.emulator import INPUT_SIZE
from rbx1_nav.create.protocol import COUNTED, CREATE, MODELS, NOTES, PASSIVE, command
from robots import Robot

LONG = [pytest.param(model, bytes((each.opcode, 255)) + bytes(255) if each.size == COUNTED else
                     bytes((each.opcode, 0, 255)) + bytes(2 * 255), id=f'{model.name}-{each.name}')
        for model in MODELS.values() for each in model.commands.values() if each.size in (COUNTED, NOTES)]


@pytest.mark.parametrize('model, data', LONG)
def test_the_longest_command_can_be_completed(model, data):
    robot = Robot(model)
    robot.send(command('start'), data[:3])
    robot.commands.clear()
    for byte in data[3:]:
        robot.send(bytes((byte,)))
    assert [received for _, received in robot.commands] == [data]
    robot.run(1)    # a query list of 255 packets has an answer
    assert robot.read(35) == {'mode': PASSIVE}


def test_what_waits_is_limited():
    robot = Robot(CREATE)
    robot.send(command('start'), command('wait_time', 50))
    for _ in range(20):
        robot.robot.receive(command('leds', 0, 0, 0) * 100, robot.now)
        robot.run(0.1)
    assert len(robot.robot._input) == INPUT_SIZE
    robot.run(10)
    robot.send(bytes(3))    # completes the last command
    assert len(robot.robot._input) == 0 and robot.read(35) == {'mode': PASSIVE}
