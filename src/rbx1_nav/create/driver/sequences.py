"""The sequences of bytes that the driver and its guardian send."""
from __future__ import annotations

from typing import Sequence

from rbx1_nav.create import protocol
from rbx1_nav.create.protocol import command
from rbx1_nav.units import SECOND

# bumps, wheel drops and cliffs; charging state to capacity; then single packets
_NUMBERS = (1, 3, 34, 35)
STREAMED = _NUMBERS + (43, 44)      # of the Create 2
# of the Create: sending distance and angle sets them to 0. Both are in group 2, so that there are not seven numbers: a
# robot that is off would take that byte for a reset
QUERIED = _NUMBERS + (2, 33)
QUERIED_WITHOUT_ANGLE = _NUMBERS + (19, 33)
START_STREAM = command('stream', len(STREAMED), *STREAMED)
PAUSE_STREAM, RESUME_STREAM = (command('pause_resume_stream', on) for on in (0, 1))
START = command('start')
MODES = {protocol.PASSIVE: START, protocol.SAFE: command('safe'), protocol.FULL: command('full')}

# the search for a robot: see search.py
BATTERY = 3                         # a group of 10 bytes
ASK_BATTERY = START + command('sensors', BATTERY)
ASK_ENCODER, ASK_WALL = command('sensors', 43), command('sensors', 8)
PAUSE = SECOND // 500               # ns between two bytes that a receiver must not take for one


def query(numbers: Sequence[int]) -> bytes:
    """Asks for packets and groups, all in one reply."""
    return command('query_list', len(numbers), *numbers)


# What was sent last may be the beginning of any command of ours. Zeros complete it: no data of a command is a motion of
# more than a moment, and 0 is no command.
_PADDING = bytes(max(len(query(QUERIED)), len(START_STREAM)) - 1)
STOP = _PADDING + protocol.drive_direct(0, 0)
# The longest command has 513 bytes: a song of 255 notes. What garbage has begun, this many zeros complete.
FLUSH = bytes(512)


def queried(model: protocol.Model) -> tuple[tuple[int, ...], ...]:
    """What a robot that is polled is asked for: all of it, and for a Create also without the angle."""
    return (QUERIED, QUERIED_WITHOUT_ANGLE) if model is protocol.CREATE else (STREAMED,)


def start(model: protocol.Model, polled: bool) -> bytes:
    """Starts the interface of a robot that was switched off, and asks for a reading. It leads to passive mode."""
    return STOP + START + (query(queried(model)[0]) if polled else START_STREAM)


def take_control(model: protocol.Model, mode: int) -> bytes:
    """Changes to a mode. On the TurtleBot, digital output 0 of a Create switches the power of the sensors."""
    outputs = model is protocol.CREATE and mode != protocol.PASSIVE
    return MODES[mode] + (command('digital_outputs', 1) if outputs else b'')


def leave(model: protocol.Model) -> bytes:
    """Stops the robot after any beginning of a command, and leaves it in passive mode, where it can be charged."""
    return STOP + (command('digital_outputs', 0) if model is protocol.CREATE else b'') + START


def guardian_stop(model: protocol.Model) -> bytes:
    """What a guardian sends: the same, again after what garbage may have begun, and an end of the stream."""
    stop = leave(model) + (b'' if model is protocol.CREATE else PAUSE_STREAM)
    return stop + FLUSH + stop
