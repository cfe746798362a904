"""What the robot does by itself: its programs (cleaning, docking and the demos of the Create), and the scripts of the
Create, which are stored, played, and wait for conditions.

A driver can only see that the robot drives although it was not asked to. So each program drives the same circle.
"""
from __future__ import annotations

from functools import partial
from struct import Struct
from typing import Callable, Mapping

from rbx1_nav.create.emulator.body import Body, Tally
from rbx1_nav.create.protocol import PASSIVE
from rbx1_nav.units import SECOND

CIRCLE = (200, 300)     # mm/s, mm: speed and radius
DEMOS = 10              # number of demos (Create p. 8)
ABORT = 255             # -1, the demo number that stops the running demo
MAX_SCRIPT = 100        # bytes (Create p. 15)
WORD = Struct('>h')
BUMPS = 'bumps_and_wheel_drops'

Condition = Callable[[Mapping[str, int]], bool]     # of the packets' values by name


class Programs:
    """The running program, if any. The do_...() methods execute commands, whose data bytes they receive."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self.started = 0        # number of programs started so far
        self.running = False

    def stop(self) -> None:
        """Stop the running program and the robot."""
        if self.running:
            self.running = False
            self.body.drive(0, 0)

    def do_spot(self, _: bytes) -> None:
        """Start to clean. Like each of the robot's buttons, this pauses a running program (Create 2 p. 11-12)."""
        if self.running:
            self.stop()
        else:
            self._begin()

    do_cover = do_max = do_dock = do_spot

    def do_demo(self, data: bytes) -> None:
        """Start a demo instead of the running program, or stop that program."""
        if data[0] == ABORT:
            self.stop()
        elif data[0] < DEMOS:
            self._begin()

    def _begin(self) -> None:
        self.started += 1
        self.running = True


def _bits(mask: int, *names: str) -> Condition:
    """Return the Condition that a bit of the mask is set in one of the packets."""
    return lambda values: any(values[name] & mask for name in names)


# in the order of their numbers, which start at 1 (Create p. 16)
EVENTS = (
    _bits(28, BUMPS), _bits(16, BUMPS), _bits(8, BUMPS), _bits(4, BUMPS),   # wheel drops: any, front, left, right
    _bits(3, BUMPS), _bits(2, BUMPS), _bits(1, BUMPS),                      # bumps: any, left, right
    _bits(1, 'virtual_wall'), _bits(1, 'wall'),
    _bits(1, 'cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right'),
    _bits(1, 'cliff_left'), _bits(1, 'cliff_front_left'), _bits(1, 'cliff_front_right'), _bits(1, 'cliff_right'),
    _bits(2, 'charging_sources'),                                           # home base
    _bits(4, 'buttons'), _bits(1, 'buttons'),                               # advance, play
    _bits(1, 'digital_inputs'), _bits(2, 'digital_inputs'), _bits(4, 'digital_inputs'), _bits(8, 'digital_inputs'),
    lambda values: values['mode'] == PASSIVE)


def event(byte: int) -> Condition | None:
    """Return the Condition for a data byte of Wait Event; None for an undefined number.

    A negative number is the inverse of an event.
    """
    number = byte - 256 if byte > 127 else byte
    if not 1 <= abs(number) <= len(EVENTS):
        return None
    happens = EVENTS[abs(number) - 1]
    return happens if number > 0 else lambda values: not happens(values)


class Scripts:
    """The script of a robot. The do_...() methods execute commands, whose data bytes they receive."""

    def __init__(self, body: Body, values: Callable[[], Mapping[str, int]]) -> None:
        """values(): returns the values of all packets, by name."""
        self.body = body
        self.values = values
        self.stored = b''
        self._now = 0
        self._due = False
        self._wait: Callable[[int], bool] | None = None     # returns whether the wait is over at a time (ns)

    @property
    def waiting(self) -> bool:
        """Whether a command delays the commands that follow it."""
        return self._wait is not None

    def update(self, now: int) -> bytes:
        """Return the commands to be executed next. Call it every 15 ms."""
        self._now = now
        if self._wait and self._wait(now):
            self._wait = None
        if not self._due:
            return b''
        self._due = False
        return self.stored

    def do_script(self, data: bytes) -> None:
        """Store a script."""
        if data[0] <= MAX_SCRIPT:
            self.stored = data[1:]

    def do_play_script(self, _: bytes) -> None:
        """Play the script at the next update, so that a script that plays itself leaves time for other commands."""
        self._due = True

    def do_wait_time(self, data: bytes) -> None:
        """Wait for tenths of a second."""
        end = self._now + data[0] * SECOND // 10
        self._wait = lambda now: now >= end

    def do_wait_distance(self, data: bytes) -> None:
        """Wait for a distance in mm."""
        self._wait_for(self.body.distance, *WORD.unpack(data))

    def do_wait_angle(self, data: bytes) -> None:
        """Wait for an angle in degrees."""
        self._wait_for(self.body.angle, *WORD.unpack(data))

    def do_wait_event(self, data: bytes) -> None:
        """Wait for an event."""
        condition = event(data[0])
        if condition:
            self._wait = partial(self._has_happened, condition)

    def _has_happened(self, condition: Condition, _: int) -> bool:
        return condition(self.values())

    def _wait_for(self, tally: Tally, goal: int) -> None:
        tally.take()        # this also restarts the count in the packet
        self._wait = lambda _: tally.pending >= goal if goal > 0 else tally.pending <= goal
