"""The robot's own programs move it in passive mode until something stops them, or the power is switched off."""
from math import hypot

import pytest

from rbx1_nav.extras.create.protocol import CREATE, CREATE_2, OFF, OPCODES, PASSIVE, command, drive_direct

from robots import Robot, both

CLEANING = {CREATE.name: ['spot', 'cover', 'dock'], CREATE_2.name: ['spot', 'cover', 'max', 'dock']}
CLEANING_OF = [pytest.param(model, name, id=f'{model.name}-{name}')
               for model in (CREATE, CREATE_2) for name in CLEANING[model.name]]


def running(model, *commands):
    """Return a robot after `start` and these commands."""
    robot = Robot(model)
    robot.send(command('start'), *commands)
    return robot


def check_it_is_over(robot):
    """Check that the robot is stationary and remains so."""
    stopped = robot.pose
    robot.run(5)
    assert not robot.robot.program_runs and not robot.body.moving and robot.pose == stopped


@pytest.mark.parametrize('model, name', CLEANING_OF)
def test_a_cleaning_program_drives_the_robot_in_passive_mode(model, name):
    robot = running(model, command(name))
    robot.run(5)
    assert robot.mode == PASSIVE and robot.body.moving and robot.robot.programs_started == 1
    assert hypot(robot.pose.x, robot.pose.y) > 0.1
    assert robot.read(39) == {'requested_velocity': 0}      # the motion was not requested
    # 5 s at 0.2 m/s, from the first update on, read within 50 ms of the next
    assert robot.read(19)['distance'] == pytest.approx(1000, abs=25)


@pytest.mark.parametrize('model, name', [
    pytest.param(model, name, id=f'{model.name}-{name}') for model in (CREATE, CREATE_2)
    for name in ('start', 'control', 'safe', 'full', 'power', 'reset', 'stop') if OPCODES[name] in model.commands])
def test_commands_that_stop_a_program(model, name):
    robot = running(model, command('cover'))
    robot.run(3)
    assert robot.body.moving
    robot.send(command(name))
    check_it_is_over(robot)
    assert robot.robot.programs_started == 1


@pytest.mark.parametrize('fault, bits', [('switches', 8), ('cliffs', 6), ('docked', True)])
@pytest.mark.parametrize('model, name', CLEANING_OF)
def test_a_wheel_drop_a_cliff_and_the_dock_end_it(model, name, fault, bits):
    robot = running(model, command(name))
    robot.run(2)
    setattr(robot.body, fault, bits)
    robot.run(0.02)     # more than an update
    check_it_is_over(robot)
    setattr(robot.body, fault, 0)
    check_it_is_over(robot)


@pytest.mark.parametrize('model, name', CLEANING_OF)
def test_a_second_cleaning_command_pauses(model, name):
    robot = running(model, command('cover'))
    robot.run(2)
    robot.send(command(name))
    check_it_is_over(robot)
    assert robot.robot.programs_started == 1
    robot.send(command(name))
    robot.run(1)
    assert robot.body.moving and robot.robot.programs_started == 2


def driving(model, **options):
    """Return a robot that drives and streams."""
    robot = Robot(model, **options)
    robot.robot.line.host_baud = robot.robot.line.baud
    robot.send(command('start'), command('full'), command('stream', 1, 7), drive_direct(200, 200))
    robot.run(1)
    return robot


def check_it_is_off(robot):
    """Check that no command has an effect."""
    robot.commands.clear()
    stopped = robot.pose
    for data in (command('start') + command('full') + drive_direct(200, 200), command('cover'), command('reset'),
                 command('sensors', 35)):
        assert robot.send(data) == b''
    assert robot.run(5) == b''
    assert robot.mode == OFF and robot.pose == stopped and robot.commands == [] and robot.robot.programs_started == 0


@both
def test_a_robot_that_was_switched_off_does_nothing_until_it_is_switched_on(model):
    robot = driving(model)
    robot.send(command('power'))
    robot.run(0.1)
    check_it_is_off(robot)
    robot.robot.switch_on(robot.now)
    robot.run(1)
    robot.send(command('start'))
    assert robot.mode == PASSIVE and robot.read(19) == {'distance': 0}


@pytest.mark.parametrize('model, seconds', [(CREATE, 3), (CREATE_2, 1)])
def test_reset_restarts_the_robot_and_only_a_create_2_names_its_firmware(model, seconds):
    robot = driving(model)
    robot.send(command('baud', 7), command('pause_resume_stream', 0))
    robot.robot.line.host_baud = 19200
    robot.run(0.1)
    assert bool(robot.send(command('reset'))) == (model is CREATE_2)
    assert robot.mode == OFF and not robot.body.moving
    robot.robot.line.host_baud = model.baud
    robot.run(seconds - 0.2)
    robot.send(command('start'))    # too early
    assert robot.mode == OFF
    robot.run(0.15)
    robot.send(command('start'))
    assert robot.mode == PASSIVE and robot.run(1) == b''
    assert robot.read(19) == {'distance': 0} and not robot.body.values.get('left_encoder')
