"""The interface of the emulated robot: modes, commands, and replies."""
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rbx1_nav.extras.create.protocol import CREATE, CREATE_2, FULL, OFF, PASSIVE, SAFE, command, drive_direct
from robots import Robot, robot_in, both

COMMANDS = [pytest.param(model, each, id=f'{model.name}-{each.name}')
            for model in (CREATE, CREATE_2) for each in model.commands.values()]


def sample(each):
    """Return the bytes of a command whose data bytes are 0, or are one item of 0."""
    size = {'counted': 2, 'notes': 4}.get(each.size, each.size)
    return bytes((each.opcode,)) + (bytes((1, 0)) if each.size == 'counted' else
                                    bytes((0, 1, 60, 32)) if each.size == 'notes' else bytes(size))


# modes

@pytest.mark.parametrize('mode', [OFF, PASSIVE, SAFE, FULL])
@pytest.mark.parametrize('model, each', COMMANDS)
def test_each_command_takes_its_data_bytes_and_leads_to_the_mode_of_the_table_where_it_is_accepted(model, each, mode):
    robot = robot_in(mode, model)
    robot.commands.clear()
    robot.send(sample(each), command('sensors', 35))
    assert robot.mode == (mode if mode not in each.modes or each.mode is None else each.mode)
    if OFF not in (mode, robot.mode):
        assert [data for _, data in robot.commands] == [sample(each), command('sensors', 35)]


@both
def test_in_passive_mode_it_does_not_drive(model):
    robot = robot_in(PASSIVE, model)
    robot.send(drive_direct(200, 200))
    assert not robot.body.moving


@both
@pytest.mark.parametrize('fault, bits', [('switches', 8), ('cliffs', 6), ('docked', True)])
def test_safe_mode_ends_when_something_happens_and_full_mode_does_not(model, fault, bits):
    for mode, after in (SAFE, PASSIVE), (FULL, FULL):
        robot = robot_in(mode, model)
        robot.send(drive_direct(100, 100))
        setattr(robot.body, fault, bits)
        robot.run(0.015)
        assert robot.mode == after
        stopped = robot.pose
        robot.run(1)
        assert (robot.pose == stopped) == (after == PASSIVE) == (robot.read(41) == {'requested_right_velocity': 0})
        # safe mode stops again while the cause lasts
        if after == PASSIVE and fault != 'cliffs':
            robot.send(command('safe'))
            assert robot.mode == PASSIVE
            setattr(robot.body, fault, 0)
            robot.send(command('safe'))
            assert robot.mode == SAFE


@both
@pytest.mark.parametrize('right, left, mode', [
    (100, 100, PASSIVE), (100, 0, PASSIVE), (-100, -100, SAFE), (0, 0, SAFE), (100, -100, PASSIVE), (-100, -90, SAFE),
    (-100, 0, PASSIVE), (-100, -40, SAFE)])
def test_a_cliff_counts_while_the_robot_moves_forward_or_back_in_a_small_circle(model, right, left, mode):
    robot = robot_in(SAFE, model)
    robot.send(drive_direct(right, left))
    robot.body.cliffs = 6
    robot.run(0.1)
    assert robot.mode == mode


@both
def test_an_interface_that_is_off_listens_for_start_only(model):
    robot = Robot(model)
    assert robot.send(command('sensors', 35), command('safe'), drive_direct(100, 100)) == b'' and robot.mode == OFF
    robot.send(command('start'))
    assert robot.read(35) == {'mode': PASSIVE}


# driving

@both
@pytest.mark.parametrize('data, turn, distance', [
    ((300, 500), 0.3 / 0.5, 0.3), ((300, -500), -0.3 / 0.5, 0.3), ((-200, 500), -0.2 / 0.5, -0.2),
    ((200, 32767), 0, 0.2), ((200, -32768), 0, 0.2), ((-200, 32767), 0, -0.2),
    ((100, 1), None, 0), ((100, -1), None, 0)])
def test_drive(model, data, turn, distance):
    robot = robot_in(FULL, model)
    robot.send(command('drive', *(byte for value in data for byte in value.to_bytes(2, 'big', signed=True))))
    before = robot.pose.yaw, robot.body.distance.total
    robot.run(1.5)      # a whole number of updates
    if turn is None:
        turn = data[1] * 0.1 / (model.wheel_separation / 2)
    assert robot.pose.yaw - before[0] == pytest.approx(1.5 * turn)
    assert robot.body.distance.total - before[1] == pytest.approx(1500 * distance)
    assert robot.read(39)['requested_velocity'] == data[0] and robot.read(40)['requested_radius'] == data[1]


@both
@settings(max_examples=30)
@given(right=st.integers(-500, 500), left=st.integers(-500, 500))
def test_drive_direct_is_exact(model, right, left):
    robot = robot_in(FULL, model)
    robot.send(drive_direct(right, left))
    before = robot.pose.yaw
    robot.run(1)
    assert robot.pose.yaw - before == pytest.approx((right - left) / 1000 / model.wheel_separation)
    values = robot.read(5)
    assert (values['requested_right_velocity'], values['requested_left_velocity']) == (right, left)


@pytest.mark.parametrize('pwm, speed', [(255, 500), (-255, -500), (51, 100), (300, 500), (0, 0)])
def test_pwm_is_a_fraction_of_255(pwm, speed):
    robot = robot_in(FULL, CREATE_2)
    robot.send(command('drive_pwm', *pwm.to_bytes(2, 'big', signed=True), 255, 205))    # left: -51
    assert (robot.body.right, robot.body.left) == pytest.approx((speed, -100))


def test_a_command_takes_effect_when_its_last_byte_has_arrived():
    robot = robot_in(FULL, CREATE_2)
    robot.commands.clear()
    robot.robot.receive(drive_direct(200, 200), robot.now)
    start = robot.now
    robot.run(1)
    (time, data), = robot.commands
    assert data == drive_direct(200, 200) and time - start == pytest.approx(5 * 10 / 115200 * 1e9, abs=10)
    assert robot.pose.x == pytest.approx(0.2 * (robot.now - time) / 1e9)
