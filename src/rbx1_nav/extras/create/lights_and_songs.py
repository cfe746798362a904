"""The buttons, lights and songs of the robot, with the names that the users of create_robot know.

A Create has the buttons Play (clean_button) and Advance (dock_button), and the LEDs Play (spot_led) and Advance
(check_led).
"""
from __future__ import annotations

from math import isfinite
from typing import Sequence

from rbx1_nav.base.command_gate import RejectedCommand
from rbx1_nav.extras.create import protocol

BUTTONS = {'clean_button': 1, 'spot_button': 2, 'dock_button': 4, 'minute_button': 8, 'hour_button': 16,
           'day_button': 32}        # bits of packet 18
LEDS = {'debris_led': 1, 'spot_led': 2, 'dock_led': 4, 'check_led': 8}      # bits of the command
SONGS, NOTES = 5, 16        # a Create 2 stores 5 songs; a Create 16
SHORTEST, LONGEST = 1 / 64, 255 / 64    # s, duration of a note
DIGITS = 4


class Lights:
    """The wanted state of all lights."""

    def __init__(self) -> None:
        self.leds = 0               # bits
        self.power = 0, 255         # color from green (0) to red (255), brightness
        self.digits = b''           # characters of the display of a Roomba; empty: not set

    def set_led(self, name: str, on: bool) -> None:
        self.leds = self.leds | LEDS[name] if on else self.leds & ~LEDS[name]

    def set_power(self, data: Sequence[int]) -> None:
        """data: color, and brightness unless it is the highest. Raises RejectedCommand."""
        if len(data) not in (1, 2):
            raise RejectedCommand(f'{list(data)}: expected a color, or a color and a brightness')
        self.power = data[0], (*data, 255)[1]

    def set_digits(self, data: Sequence[int], model: protocol.Model) -> None:
        """data: 1 to 4 ASCII characters. Raises RejectedCommand."""
        if not model.has('digit_leds_ascii'):
            raise RejectedCommand(f'{bytes(data)!r}: expected a robot with a display: a {model.name} has none')
        if not 1 <= len(data) <= DIGITS or not all(32 <= each <= 126 for each in data):
            raise RejectedCommand(f'{list(data)}: expected 1 to {DIGITS} ASCII characters from 32 to 126')
        self.digits = bytes(data).ljust(DIGITS)

    @property
    def commands(self) -> bytes:
        """The bytes that set all lights."""
        digits = protocol.command('digit_leds_ascii', *self.digits) if self.digits else b''
        return protocol.command('leds', self.leds, *self.power) + digits


def define_song(data: Sequence[float]) -> bytes:
    """Return the bytes that store a song. data: its number, then a MIDI note and a duration (s) for each note; a note
    below 31 is a rest. Raises RejectedCommand."""
    number, notes, durations = data[:1], data[1::2], data[2::2]
    if len(notes) != len(durations) or not 1 <= len(notes) <= NOTES:
        raise RejectedCommand(f'{len(data)} values: expected a number, and 1 to {NOTES} pairs of note and duration')
    _check_song(number[0])
    for note, duration in zip(notes, durations):
        if not (isfinite(note) and note == int(note) and 0 <= note <= 127):
            raise RejectedCommand(f'note {note:g}: expected a whole number from 0 to 127; below 31: a rest')
        if not SHORTEST <= duration <= LONGEST:
            raise RejectedCommand(f'duration {duration:g} s: expected {SHORTEST:.3f} to {LONGEST:.3f} s')
    pairs = (value for note, duration in zip(notes, durations) for value in (int(note), round(64 * duration)))
    return protocol.command('song', int(number[0]), len(notes), *pairs)


def play_song(number: int) -> bytes:
    """Return the bytes that play a stored song. Raises RejectedCommand."""
    _check_song(number)
    return protocol.command('play_song', number)


def _check_song(number: float) -> None:
    if number not in range(SONGS):
        raise RejectedCommand(f'song {number:g}: expected a whole number from 0 to {SONGS - 1}')
