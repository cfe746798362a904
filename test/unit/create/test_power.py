"""Power-off, reset, and the initial baud rate of the robot."""
from rbx1_nav.create.protocol import CREATE, OFF, PASSIVE, command, drive_direct
from robots import Robot, both


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
    assert robot.mode == OFF and robot.pose == stopped and robot.commands == [] and robot.robot.programs.started == 0


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


def test_reset_restarts_a_create_without_a_word():
    robot = driving(CREATE)
    robot.send(command('baud', 7), command('pause_resume_stream', 0))
    robot.robot.line.host_baud = 19200
    robot.run(0.1)
    assert robot.send(command('reset')) == b'' and robot.mode == OFF and not robot.body.moving
    robot.robot.line.host_baud = 57600
    robot.run(2.8)
    robot.send(command('start'))    # too early
    assert robot.mode == OFF
    robot.run(0.15)
    robot.send(command('start'))
    assert robot.mode == PASSIVE and robot.read(19) == {'distance': 0} and robot.run(1) == b''
