"""Scripts of the Create: the examples in the document (Create p. 15), and the conditions that scripts wait for."""
import pytest

from rbx1_nav.create.protocol import CREATE, PASSIVE, SAFE, command, drive_direct
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


def test_drive_in_a_square(robot):
    play(robot, FORWARD, bytes((156, 1, 144)), bytes((137, 1, 44, 0, 1)), bytes((157, 0, 90)), bytes((153,)))
    seen = []
    for _ in range(1000):
        robot.run(0.01)
        seen.append((robot.pose.x, robot.pose.y))
    # one round takes 4 * (400 / 300 + pi / 2 * 130 / 300) s = 8.06 s, and each turn may be 1 degree and 15 ms off
    assert max(x for x, _ in seen) == pytest.approx(0.4, abs=0.06)
    assert max(y for _, y in seen) == pytest.approx(0.4, abs=0.06)
    assert robot.body.moving


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


@pytest.mark.parametrize('data', [(156, 255, 156), (157, 255, 166)])    # -100 mm, -90 degrees
def test_negative_goals(robot, data):
    play(robot, drive_direct(-300, -100), bytes(data), HALT)
    robot.run(10)
    assert not robot.body.moving
    assert robot.body.distance.total < -99 and robot.body.angle.total < 0


@pytest.mark.parametrize('number, fault', [(1, 'wheel_dropped'), (3, 'wheel_dropped'), (5, 'bumped'), (6, 'bumped'),
                                           (7, 'bumped'), (10, 'cliff'), (12, 'cliff'), (13, 'cliff'), (15, 'docked')])
def test_events(robot, number, fault):
    play(robot, command('wait_event', number), command('leds', 1, 0, 0), command('wait_event', 256 - number),
         command('leds', 2, 0, 0))
    robot.run(1)
    assert 'leds' not in robot.robot.outputs
    robot.robot._enter(SAFE)
    setattr(robot.body, fault, True)
    robot.run(0.1)
    lit = robot.robot.outputs.get('leds')
    assert lit == bytes((1, 0, 0)) or robot.mode == PASSIVE     # LEDs cannot be changed in passive mode
    setattr(robot.body, fault, False)
    robot.run(0.1)
    assert not robot.robot._scripts.waiting


def test_an_event_of_the_interface_itself(robot):
    assert play(robot, command('wait_event', 22), command('sensors', 35)) == b''
    robot.body.wheel_dropped = True
    assert robot.run(0.1) == bytes((PASSIVE,))


def test_digital_inputs_are_high(robot):
    assert play(robot, command('wait_event', 18), command('sensors', 35)) == bytes((SAFE,))


@pytest.mark.parametrize('number', [0, 23, 128])
def test_an_event_that_does_not_exist_is_not_waited_for(robot, number):
    play(robot, command('wait_event', number), HALT)
    robot.run(0.1)
    assert not robot.robot._scripts.waiting


def test_a_script_that_only_plays_itself_leaves_the_robot_responsive(robot):
    play(robot, command('play_script'))
    robot.run(1)
    assert robot.read(35) == {'mode': SAFE}


def test_a_script_that_is_too_long_is_ignored(robot):
    robot.send(command('script', 101, *bytes(101)))
    assert robot.send(command('show_script')) == bytes((0,))
