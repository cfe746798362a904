"""Scripts of the Create: the examples in the document (Create p. 15), and the conditions that scripts wait for."""
import pytest

from rbx1_nav.create.protocol import CREATE, command, drive_direct
from robots import Robot

FORWARD, HALT = bytes((137, 1, 44, 128, 0)), bytes((137, 0, 0, 0, 0))


@pytest.fixture(name='robot')
def fixture_robot():
    robot = Robot(CREATE)
    robot.send(command('start'), command('safe'))
    return robot


def play(robot, *commands):
    """Play a script. Returns the immediate reply of the robot."""
    script = b''.join(commands)
    return robot.send(command('script', len(script), *script), command('play_script'))


def test_drive_40_cm_and_stop(robot):
    play(robot, FORWARD, bytes((156, 1, 144)), HALT)
    robot.run(10)
    # up to 15 ms late, at 300 mm/s
    assert 0.3995 <= robot.pose.x <= 0.405 and not robot.body.moving


def test_a_script_is_shown_and_the_stream_halts(robot):
    script = FORWARD + HALT
    robot.send(command('stream', 1, 7), command('script', len(script), *script))
    robot.run(0.1)
    assert robot.send(command('show_script')).endswith(bytes((10,)) + script)
    assert robot.run(1) == b''
    robot.send(command('script', 0))
    assert robot.send(command('show_script')) == bytes((0,))


def test_while_it_waits_it_does_not_listen(robot):
    play(robot, FORWARD, command('wait_time', 10), HALT)
    robot.send(drive_direct(-100, -100))
    assert robot.body.left == 300
    robot.run(1)
    assert robot.body.left == -100      # the commands waited, too
