"""Lights and songs: the bytes of both documents, and what is rejected."""
from math import inf, nan

import pytest

from rbx1_nav.base.command_gate import RefusedCommand, RejectedCommand
from rbx1_nav.extras.create.lights_and_songs import Lights, define_song, play_song
from rbx1_nav.extras.create.protocol import CREATE, CREATE_2, command

from driven_create import BOTH, started


def test_the_bytes_of_a_song():
    """140, number, length, then note and duration in 1/64 s (Create p. 11, Create 2 p. 19)."""
    assert define_song([3, 72, 0.5, 0, 0.25, 127, 255 / 64]) == bytes((140, 3, 3, 72, 32, 0, 16, 127, 255))
    assert len(define_song([0] + 16 * [60, 0.1])) == 3 + 2 * 16
    assert play_song(4) == bytes((141, 4))


@pytest.mark.parametrize('data, text', [
    ([], '0 values'), ([1], '1 values'), ([1, 60], '2 values'), ([0] + 17 * [60, 1], '35 values'),
    ([5, 60, 1], 'song 5: expected a whole number from 0 to 4'), ([-1, 60, 1], 'song -1'), ([0.5, 60, 1], 'song 0.5'),
    ([nan, 60, 1], 'song nan'), ([0, 128, 1], 'note 128: expected a whole number from 0 to 127'),
    ([0, 60.5, 1], 'note 60.5'), ([0, nan, 1], 'note nan'), ([0, inf, 1], 'note inf'),
    ([0, 60, 4], 'duration 4 s: expected 0.016 to 3.984 s'), ([0, 60, 0], 'duration 0 s'),
    ([0, 60, -0.1], 'duration -0.1'),
    ([0, 60, nan], 'duration nan')])
def test_a_bad_song(data, text):
    with pytest.raises(RejectedCommand, match=text):
        define_song(data)


def test_the_bytes_of_the_lights():
    """139, bits, color, brightness: debris 1, spot or Play 2, dock 4, check or Advance 8; 164, 4 characters."""
    lights = Lights()
    for name, bit in ('debris_led', 1), ('spot_led', 2), ('dock_led', 4), ('check_led', 8):
        lights.set_led(name, True)
        assert lights.commands == bytes((139, bit, 0, 255))
        lights.set_led(name, False)
    lights.set_led('dock_led', True)
    lights.set_led('check_led', True)
    lights.set_power(b'\x80')
    assert lights.commands == bytes((139, 12, 128, 255))
    lights.set_power(b'\xff\x10')
    lights.set_digits(b'Hi', CREATE_2)
    assert lights.commands == bytes((139, 12, 255, 16)) + b'\xa4Hi  '


def test_bad_lights():
    lights = Lights()
    for data in b'', b'\0\0\0':
        with pytest.raises(RejectedCommand, match='expected a color'):
            lights.set_power(data)
    for data in b'', b'abcde', b'\xff':
        with pytest.raises(RejectedCommand, match='expected 1 to 4 ASCII characters'):
            lights.set_digits(data, CREATE_2)
    with pytest.raises(RejectedCommand, match='a create has none'):
        lights.set_digits(b'Hi', CREATE)
    assert lights.commands == bytes((139, 0, 0, 255))


@BOTH
def test_lights_are_set_again_when_control_is_regained(robot_type):
    driven = started(robot_type)
    lights = Lights()
    lights.set_led('spot_led', True)
    driven.commands.clear()
    driven.driver.orders.lights = lights.commands
    driven.run(1)
    assert [data for _, data in driven.commands].count(lights.commands) == 1
    assert driven.robot.panel.lights == (2, 0, 255)
    driven.body.switches = 8
    driven.run(1)
    driven.commands.clear()
    driven.body.switches = 0
    driven.run(2)
    assert [data for _, data in driven.commands].count(lights.commands) == 1


@BOTH
def test_a_song_is_stored_and_played(robot_type):
    driven = started(robot_type)
    orders = driven.driver.orders
    orders.send(driven.now, define_song([1, 60, 0.5, 64, 0.25]))
    orders.send(driven.now, play_song(1))
    driven.run(0.5)
    assert driven.robot.panel.is_playing and driven.robot.panel.number == 1
    orders.send(driven.now, play_song(1))    # ignored
    driven.run(0.5)
    assert not driven.robot.panel.is_playing and driven.driver.contact.answers


@BOTH
def test_a_song_that_cannot_be_played(robot_type):
    driven = started(robot_type)
    with pytest.raises(RefusedCommand, match='the serial line is busy'):
        for _ in range(20):
            driven.driver.orders.send(driven.now, define_song([0] + 16 * [60, 1]))
    driven.body.switches = 8
    driven.run(1)
    driven.commands.clear()
    with pytest.raises(RefusedCommand, match='not driven: a wheel dropped'):
        driven.driver.orders.send(driven.now, play_song(0))
    driven.driver.leave(driven.now)
    with pytest.raises(RefusedCommand, match='shutting down'):
        driven.driver.orders.send(driven.now, play_song(0))
    driven.run(0.2)
    assert command('play_song', 0) not in [data for _, data in driven.commands]
