"""The emulated Create: its sensors and their packets, its battery, and its longest commands."""
from math import pi

from hypothesis import given, strategies as st
import pytest

from rbx1_nav.extras.create.protocol import (
    COUNTED, CREATE, CREATE_2, FULL, NOTES, OFF, PASSIVE, SAFE, command, drive_direct, encode_frame,
    packets_format, single_packets)

from robots import Robot, both, robot_in


@both
def test_every_packet_and_group_is_answered(model):
    robot = robot_in(SAFE, model)
    for number in [*model.packets, *model.groups]:
        packets = single_packets(model, [number])
        data = robot.send(command('sensors', number))
        values = packets_format(packets).unpack(data)
        for packet, value in zip(packets, values):
            assert packet.low <= value <= packet.high


@both
def test_a_query_list_is_answered_in_its_order(model):
    robot = robot_in(SAFE, model)
    robot.body.switches = 3
    robot.run(0.1)
    assert robot.send(command('query_list', 3, 35, 7, 1)) == bytes((SAFE, 3, 3)) + bytes(9)


@both
def test_a_stream_sends_a_frame_every_15_ms_until_it_is_paused(model):
    robot = robot_in(SAFE, model)
    frame = encode_frame(model, [7, 35], {'bumps_and_wheel_drops': 0, 'mode': SAFE})
    robot.send(command('stream', 2, 7, 35))
    assert robot.run(1.5) == 100 * frame
    robot.send(command('pause_resume_stream', 0))
    assert robot.run(1) == b''
    assert robot.read(38) == {'stream_packets': 2}
    robot.send(command('pause_resume_stream', 1))
    assert robot.run(0.15)[:2 * len(frame)].startswith(frame)
    robot.send(command('stream', 0))
    assert robot.run(1) == b''


@both
def test_distance_and_angle_are_those_since_the_last_reading(model):
    robot = robot_in(FULL, model)
    robot.send(drive_direct(200, 100))
    robot.run(2)
    robot.send(drive_direct(0, 0))
    whole = robot.body.distance.total, robot.body.angle.total
    first = robot.read(2)
    assert first['distance'] == pytest.approx(whole[0], abs=0.5) and first['angle'] == pytest.approx(whole[1], abs=0.5)
    assert robot.read(19) == {'distance': 0} and robot.read(20) == {'angle': 0}


def test_encoders_wrap():
    robot = robot_in(FULL, CREATE_2)
    robot.send(drive_direct(500, -500))
    robot.run(60)
    robot.send(drive_direct(0, 0))
    travel = robot.pose.yaw * CREATE_2.wheel_separation / 2
    counts = round(travel * 508.8 / (pi * 0.072))
    assert counts > 65536
    values = robot.read(101)
    assert values['right_encoder'] == counts % 65536
    assert values['left_encoder'] == -counts % 65536 and values['left_encoder'] != values['right_encoder']


# battery

@both
def test_the_battery_runs_down_and_a_dock_charges_it(model):
    robot = robot_in(PASSIVE, model)
    full = robot.read(3)
    assert full['charge'] == full['capacity'] and full['current'] < 0 and full['charging_state'] == 0
    robot.run(60)
    low = robot.read(3)
    assert low['charge'] == full['charge'] - 5 and low['voltage'] < full['voltage']
    robot.body.docked = True
    robot.run(6)
    charging = robot.read(3)
    assert charging['charge'] > low['charge'] and charging['current'] > 0 and charging['charging_state'] == 2
    assert robot.read(34) == {'charging_sources': 2}
    robot.send(command('full'))
    assert robot.read(3)['charging_state'] == 0


@both
def test_an_empty_battery_switches_the_robot_off(model):
    robot = robot_in(FULL, model)
    robot.send(drive_direct(200, 200), command('stream', 1, 7))
    robot.body.charge = 0
    robot.run(0.1)
    assert robot.mode == OFF and not robot.body.moving
    assert robot.send(command('start'), command('sensors', 35)) == b'' and robot.mode == OFF
    robot.body.charge = 3000
    robot.send(command('start'))
    assert robot.mode == PASSIVE and robot.read(19) == {'distance': 0}
    assert robot.run(1) == b''      # the stream is no longer requested


@both
@given(st.binary(max_size=400))
def test_no_bytes_upset_it(model, data):
    robot = robot_in(FULL, model)
    robot.send(data)
    robot.run(1)
    assert robot.mode in (OFF, PASSIVE, SAFE, FULL)


LONG = [pytest.param(model, bytes((each.opcode, 255)) + bytes(255) if each.size == COUNTED else
                     bytes((each.opcode, 0, 255)) + bytes(2 * 255), id=f'{model.name}-{each.name}')
        for model in (CREATE, CREATE_2) for each in model.commands.values() if each.size in (COUNTED, NOTES)]


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
