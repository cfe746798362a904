"""Differences between some robots and the documents: the mode, fractions of the angle, a stuck gyro."""
import pytest

from rbx1_nav.create.emulator.body import Quirks
from rbx1_nav.create.protocol import CREATE, command, drive_direct
from robots import Robot

PLUS_ONE, DROPPING = Quirks(mode_plus_one=True), Quirks(drops_fractions=True)


def streamed(robot, number, right, left, seconds=1.5):
    """Return the values of a 2-byte packet in each frame while the robot drives."""
    robot.send(command('start'), command('full'), drive_direct(right, left))
    robot.read(number)
    robot.send(command('stream', 1, number))
    data = robot.run(seconds)
    return [int.from_bytes(data[index + 3:index + 5], 'big', signed=True) for index in range(0, len(data) - 5, 6)]


# mm/s of the right wheel; the left wheel turns backward at this speed: 30 and 100 degrees/s, 0.45 and 1.5 per frame
@pytest.mark.parametrize('speed, expected', [(68, 0), (-68, 0), (227, 1), (-227, -1)])
def test_an_angle_whose_fractions_are_lost(speed, expected):
    values = streamed(Robot(CREATE, quirks=DROPPING), 20, speed, -speed)
    assert len(values) == 100 and set(values) == {expected}


@pytest.mark.parametrize('speed, rate', [(68, 30), (-68, -30), (227, 100), (-227, -100)])
def test_an_angle_whose_fractions_are_kept(speed, rate):
    values = streamed(Robot(CREATE), 20, speed, -speed)
    assert sum(values) == pytest.approx(1.5 * rate, abs=2)      # a degree at the start and at the end
