"""Keys that are held drive the robot, and keys that are released, or no longer repeated, stop it."""
from threading import Event
import time

import pytest

from rbx1_nav.extras.web.hand_drive import KEY_TIMEOUT, LINGER, HandDrive, Keys
from waiting import wait_for


class Base:
    """Takes the place of a base, and of the publisher."""

    def __init__(self):
        self.commands = []
        self.sent = Event()

    def publish(self, linear, angular):
        self.commands.append((linear, angular))
        self.sent.set()


class Clock:
    """A clock that a test sets."""
    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture(name='driven')
def start():
    base, clock = Base(), Clock()
    hand = HandDrive(base.publish, clock)
    hand.start()
    yield hand, base, clock
    hand.end()


def test_keys_of_one_browser_at_a_time():
    keys = Keys()
    assert keys.hold('a', 0.2, 0.0, 1.0) and not keys.hold('b', 0.0, 1.0, 1.1)
    assert keys.velocity(1.1) == (0.2, 0.0)
    assert keys.hold('a', 0.0, 0.0, 1.2) and keys.hold('b', 0.0, 1.0, 1.2)


def test_keys_drive_and_their_release_stops(driven):
    hand, base, _ = driven
    hand.begin('a')
    assert hand.drive('a', 0.2, 0.0)
    wait_for(lambda: base.commands[-3:] == 3 * [(0.2, 0.0)])
    assert hand.drive('a', 0.0, 0.0)
    wait_for(lambda: base.commands[-1] == (0.0, 0.0))


def test_a_browser_that_falls_silent_stops_the_robot(driven):
    hand, base, clock = driven
    hand.begin('a')
    hand.drive('a', 0.2, 0.0)
    wait_for(lambda: base.commands)
    clock.now += KEY_TIMEOUT + 0.01
    wait_for(lambda: base.commands[-1] == (0.0, 0.0))


def test_stop_sends_zeros_though_nobody_drives(driven):
    hand, base, clock = driven
    hand.begin('a')
    hand.stop()
    wait_for(lambda: (0.0, 0.0) in base.commands)
    assert not hand.drive('a', 0.2, 0.0)    # it has to begin again
    clock.now += LINGER + 0.1
    time.sleep(0.1)         # a command on its way
    count = len(base.commands)
    time.sleep(0.2)
    assert len(base.commands) == count


def test_the_end_stops_a_robot_that_moves():
    base = Base()
    hand = HandDrive(base.publish)
    hand.start()
    hand.begin('a')
    hand.drive('a', 0.2, 0.0)
    wait_for(lambda: base.commands)
    hand.end()
    assert base.commands[-1] == (0.0, 0.0)
