"""A sender that has not noticed that the robot was stopped cannot drive it."""
import pytest

from rbx1_nav.extras.create.acceptance import Lockout

SILENCE = 600       # ns; any value works


@pytest.fixture(name='locked')
def make_locked():
    """Return a Lockout that was locked at 100 while a sender was driving."""
    lockout = Lockout(SILENCE)
    assert not lockout.refuses(90, 'driver', True)
    lockout.lock('a wheel dropped')
    return lockout


def test_a_sender_that_goes_on_is_refused_for_as_long_as_it_does(locked):
    assert all(locked.refuses(time, 'driver', True) for time in range(100, 5000, 20))
    assert locked.reason == 'a wheel dropped'


def test_a_zero_command_ends_it(locked):
    assert locked.refuses(100, 'driver', True)
    assert not locked.refuses(120, 'driver', False)
    assert not locked.refuses(140, 'driver', True)


@pytest.mark.parametrize('pause, refused', [(SILENCE, True), (SILENCE + 1, False)])
def test_silence_ends_it(locked, pause, refused):
    assert locked.refuses(100, 'driver', True)
    assert locked.refuses(100 + pause, 'driver', True) == refused


def test_a_sender_that_begins_afterwards_is_obeyed(locked):
    assert not locked.refuses(100, 'other', True)
    assert locked.refuses(110, 'driver', True)


def test_the_next_event_concerns_everybody_again(locked):
    assert not locked.refuses(120, 'driver', False)
    locked.lock('the robot was reset')
    assert locked.refuses(140, 'driver', True) and locked.reason == 'the robot was reset'
