"""Details of the emulated robot's interface: frames, restarts, and what completes a command."""
import pytest

from rbx1_nav.create.protocol import (
    CREATE, CREATE_2, FULL, MODELS, OFF, PASSIVE, SAFE, command, drive_direct, encode_frame)
from robots import Robot, robot_in

both = pytest.mark.parametrize('model', list(MODELS.values()), ids=list(MODELS))


def pair(first, second):
    """Return the data bytes of two 16-bit numbers."""
    return [byte for value in (first, second) for byte in value.to_bytes(2, 'big', signed=True)]


@both
def test_a_frame_has_up_to_255_data_bytes(model):
    robot = robot_in(PASSIVE, model)
    # group 6 has 52 bytes and its number; packets of one and of two bytes have two and three
    numbers = [6] * 4 + [7] * 20 + [22]
    robot.send(command('stream', len(numbers), *numbers))
    assert robot.run(0.1) and robot.robot.line.next_to_host is not None
    robot.send(command('stream', 0))
    robot.run(5)        # until the line is free
    assert robot.send(command('stream', len(numbers) + 1, *numbers, 7)) == b'' and robot.run(1) == b''
    assert robot.send(command('sensors', 38)) == bytes(1)


@both
def test_outputs_and_requests_are_cleared_by_a_restart(model):
    robot = robot_in(FULL, model)
    robot.send(command('leds', 1, 2, 3), command('stream', 1, 7), drive_direct(100, 100))
    robot.robot.switch_on(robot.now)
    assert robot.robot.outputs == {} and not robot.body.moving
    robot.run(1)
    robot.send(command('start'))
    values = robot.read(5)
    assert values == {**dict.fromkeys(values, 0), 'mode': PASSIVE}


@both
def test_the_time_until_a_robot_listens(model):
    """1 s after power-on; after a reset, a Create needs 3 s."""
    for action, seconds in ('switch_on', 1), ('reset', 3 if model is CREATE else 1):
        robot = robot_in(FULL, model)
        if action == 'reset':
            robot.robot.receive(command('reset'), robot.now)
            robot.run(10 / model.baud)
        else:
            robot.robot.switch_on(robot.now)
        robot.run(seconds - 0.005)
        robot.robot.receive(command('start'), robot.now)
        robot.run(0.004)
        assert robot.mode == OFF
        robot.run(0.001)
        robot.robot.receive(command('start'), robot.now)
        robot.run(0.01)
        assert robot.mode == PASSIVE


def test_the_firmware_of_a_create_2_is_sent_at_power_on_and_a_create_is_silent():
    for model, text in (CREATE, b''), (CREATE_2, b'bl-start\r\nSTR730\r\nRoomba by iRobot!\r\n'):
        robot = Robot(model)
        robot.robot.switch_on(0)
        assert robot.run(0.5).startswith(text) and bool(text) == (model is CREATE_2)


@both
def test_baud_codes(model):
    robot = robot_in(PASSIVE, model)
    robot.send(command('baud', 12))     # no such code
    assert robot.robot.line.baud == model.baud
    robot.send(command('baud', 11))
    assert robot.robot.line.baud == 115200


@both
def test_an_unknown_byte_is_skipped(model):
    robot = robot_in(PASSIVE, model)
    robot.send(bytes((0, 255, 159)), command('safe'))
    assert robot.mode == SAFE


@both
def test_the_next_event_of_the_robot(model):
    robot = Robot(model)
    assert robot.robot.next_time == 15_000_000
    robot.robot.receive(command('start'), 0)
    assert robot.robot.next_time == 10 * 10 ** 9 // model.baud
    robot.run(0.01)
    robot.send(command('stream', 1, 35))
    robot.run(0.0101)
    frame = encode_frame(model, [35], {'mode': PASSIVE})
    assert frame in robot.run(0.1) and robot.robot.next_time <= robot.now + 15_000_000


@both
def test_a_circle_with_a_radius_of_the_robot_is_not_small(model):
    robot = robot_in(SAFE, model)
    # backward with the center 0.17 m to the side, and 0.16 m: the robot has a radius of 0.165 m
    for radius, after in (170, SAFE), (160, PASSIVE):
        robot.send(command('drive', *pair(-100, radius)))
        robot.body.cliff = True
        robot.run(0.02)
        assert robot.mode == after


@both
@pytest.mark.parametrize('data', [command('song', 0, 0), command('song', 0, 1, 60, 32), command('query_list', 0),
                                  command('stream', 0), command('stream', 1, 7)])
def test_a_command_is_complete_with_its_last_byte(model, data):
    robot = robot_in(PASSIVE, model)
    robot.commands.clear()
    robot.send(data[:-1])
    assert robot.commands == []
    robot.send(data[-1:])
    assert [each for _, each in robot.commands] == [data]


@both
def test_a_request_is_forgotten_in_passive_mode(model):
    robot = robot_in(FULL, model)
    robot.send(command('drive', *pair(200, 500)), drive_direct(100, -100))
    assert robot.read(40) == {'requested_radius': 500} and robot.read(42) == {'requested_left_velocity': -100}
    robot.send(command('start'))
    values = robot.read(5)
    assert [value for name, value in values.items() if name.startswith('requested')] == [0] * 4


@both
def test_while_a_stream_is_paused_another_one_may_be_requested(model):
    robot = robot_in(PASSIVE, model)
    robot.send(command('pause_resume_stream', 1))
    assert robot.run(0.1) == b''        # nothing was requested
    robot.send(command('stream', 1, 35), command('pause_resume_stream', 0))
    robot.run(0.1)
    robot.send(command('stream', 2, 35, 7))
    assert encode_frame(model, [35, 7], {'mode': PASSIVE, 'bumps_and_wheel_drops': 0}) in robot.run(0.1)


@both
def test_a_command_is_executed_at_the_time_when_its_last_byte_arrives(model):
    robot = Robot(model)
    robot.robot.receive(command('start'), 0)
    arrival = robot.robot.line.next_to_robot
    robot.robot.advance(arrival - 1)
    assert robot.commands == []
    robot.robot.advance(arrival)
    assert robot.commands == [(arrival, command('start'))]
