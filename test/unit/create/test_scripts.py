"""Scripts of the Create: the examples in the document (Create p. 15), and what scripts wait for (p. 15 and 16)."""
import pytest

from rbx1_nav.create.emulator.body import Body
from rbx1_nav.create.emulator.programs import Scripts, event
from rbx1_nav.create.protocol import CREATE, FULL, OFF, PASSIVE, SAFE, command, drive_direct
from rbx1_nav.units import SECOND

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


PACKETS = ('bumps_and_wheel_drops', 'virtual_wall', 'wall', 'cliff_left', 'cliff_front_left', 'cliff_front_right',
           'cliff_right', 'charging_sources', 'buttons', 'digital_inputs', 'mode')
# number of an event: (packet, bits that cause it)
EVENTS = {
    1: [('bumps_and_wheel_drops', 4 + 8 + 16)], 2: [('bumps_and_wheel_drops', 16)], 3: [('bumps_and_wheel_drops', 8)],
    4: [('bumps_and_wheel_drops', 4)], 5: [('bumps_and_wheel_drops', 1 + 2)], 6: [('bumps_and_wheel_drops', 2)],
    7: [('bumps_and_wheel_drops', 1)], 8: [('virtual_wall', 1)], 9: [('wall', 1)],
    10: [('cliff_left', 1), ('cliff_front_left', 1), ('cliff_front_right', 1), ('cliff_right', 1)],
    11: [('cliff_left', 1)], 12: [('cliff_front_left', 1)], 13: [('cliff_front_right', 1)], 14: [('cliff_right', 1)],
    15: [('charging_sources', 2)], 16: [('buttons', 4)], 17: [('buttons', 1)], 18: [('digital_inputs', 1)],
    19: [('digital_inputs', 2)], 20: [('digital_inputs', 4)], 21: [('digital_inputs', 8)]}


@pytest.mark.parametrize('number', EVENTS)
def test_an_event_happens_for_its_bits_only(number):
    for name in PACKETS[:-1]:
        for bit in (1 << index for index in range(8)):
            values = {**dict.fromkeys(PACKETS, 0), name: bit}
            happens = any(packet == name and bits & bit for packet, bits in EVENTS[number])
            assert bool(event(number)(values)) == happens
            # a negative number is the inverse
            assert bool(event(256 - number)(values)) == (not happens)


def test_the_event_of_passive_mode():
    for mode in (OFF, PASSIVE, SAFE, FULL):
        assert event(22)({'mode': mode}) == (mode == PASSIVE) and event(234)({'mode': mode}) == (mode != PASSIVE)


@pytest.fixture(name='scripts')
def make_scripts():
    return Scripts(Body(CREATE), dict)


def waits(scripts, now):
    """Return whether the script still waits after an update at a time (s)."""
    scripts.update(round(now * SECOND))
    return scripts.waiting


@pytest.mark.parametrize('tenths', [1, 10, 255])
def test_a_wait_for_tenths_of_a_second(scripts, tenths):
    scripts.update(5 * SECOND)
    scripts.do_wait_time(bytes((tenths,)))
    assert waits(scripts, 5) and waits(scripts, 5 + tenths / 10 - 1e-6) and not waits(scripts, 5 + tenths / 10)


@pytest.mark.parametrize('goal, before, after', [
    (100, 99.4, 99.6), (-100, -99.4, -99.6), (-1, -0.4, -0.6), (1, 0.4, 0.6), (300, 299, 300)])
@pytest.mark.parametrize('what', ['distance', 'angle'])
def test_a_wait_for_a_distance_or_an_angle(scripts, what, goal, before, after):
    tally = getattr(scripts.body, what)
    tally.total = 1000.0        # driven before
    getattr(scripts, f'do_wait_{what}')(goal.to_bytes(2, 'big', signed=True))
    assert waits(scripts, 0)
    tally.total = 1000.0 + before
    assert waits(scripts, 1)
    tally.total = 1000.0 + after
    assert not waits(scripts, 2)
