"""Sequences of bytes that the driver and its guardian send."""
from __future__ import annotations

from typing import Sequence

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.protocol import command

# bumps, wheel drops and cliffs; charging state to capacity; then single packets
_NUMBERS = (1, 3, 34, 35)
# infrared, buttons and encoders of the Create 2. No query has seven numbers: a robot that is off would take the byte 7
# for a reset
QUERIED_ENCODERS = _NUMBERS + (17, 18, 43, 44)
# of the Create, which resets distance and angle to 0 when it sends them. Group 2: infrared, buttons, distance and angle
QUERIED = _NUMBERS + (2, 33)
QUERIED_WITHOUT_ANGLE = _NUMBERS + (17, 18, 19, 33)
START = command('start')
MODES = {protocol.PASSIVE: START, protocol.SAFE: command('safe'), protocol.FULL: command('full')}

# the search for a robot: see identification.py
PAUSE_STREAM = command('pause_resume_stream', 0)
BATTERY = 3                         # a group of 10 bytes
ASK_BATTERY = START + command('sensors', BATTERY)
ASK_ENCODER, ASK_WALL = command('sensors', 43), command('sensors', 8)
PAUSE = SECOND // 500               # ns between two bytes that a receiver must not merge into one


def query(numbers: Sequence[int]) -> bytes:
    """Return the query for packets and groups, all in one reply."""
    return command('query_list', len(numbers), *numbers)


# The last bytes sent may be the beginning of any of the driver's commands, except a song, which FLUSH completes. Zeros
# complete it: with zeros as data no command causes a lasting motion, and 0 is not a command.
_PADDING = bytes(len(query(QUERIED_WITHOUT_ANGLE)) - 1)
STOP = _PADDING + protocol.drive_direct(0, 0)
# The longest command has 513 bytes: a song of 255 notes. This many zeros complete any command that garbage has begun.
FLUSH = bytes(512)


def queried(model: protocol.Model) -> tuple[tuple[int, ...], ...]:
    """Return the numbers for the queries to a robot: all packets, and without encoders also without the angle."""
    return (QUERIED_ENCODERS,) if model.counts_per_metre else (QUERIED, QUERIED_WITHOUT_ANGLE)


def take_control(model: protocol.Model, mode: int) -> bytes:
    """Return the bytes that change to a mode. On a TurtleBot with a Create, digital output 0 switches the power of the
    sensors."""
    outputs = model.has_gyro_board and mode != protocol.PASSIVE
    return MODES[mode] + (command('digital_outputs', 1) if outputs else b'')


def leave(model: protocol.Model) -> bytes:
    """Return the bytes that stop the robot, even after an incomplete command, and leave it in passive mode, where it
    can be charged."""
    return STOP + (command('digital_outputs', 0) if model.has_gyro_board else b'') + START


def guardian_stop(model: protocol.Model) -> bytes:
    """Return the bytes that a guardian sends: leave(), and again after completing any command that garbage has begun.
    """
    return leave(model) + FLUSH + leave(model)
