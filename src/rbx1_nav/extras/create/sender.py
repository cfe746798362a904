"""Sends bytes and wheel speeds to the robot, if the phase of the contact with it allows them, and integrates the travel
that the speeds command. All times are in ns.

The guardian is a process of its own: it sends only its stop, after the node has died or while it hangs.
"""
from __future__ import annotations

from enum import Enum
from typing import Callable

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.odometry import STILL, Expected

BACKLOG = SECOND // 100     # backlog of bytes on the line beyond which only a stop is sent at once


class Kind(Enum):
    """What is sent, and who sends it."""

    SEARCH = 'bytes that no receiver can mistake for another command'       # Search
    STOP = 'a stop, alone or with the change to passive mode at the end'    # Driver, Contact
    START = 'a stop and the start of the interface'                         # Contact
    QUERY = 'a query'                                                       # Queries
    MODE = 'the request for the mode in which the robot is driven'          # Supervisor
    PANEL = 'lights and songs'                                              # Orders
    DOCK = 'a stop and the start of docking'                                # Orders
    SPEEDS = 'wheel speeds other than 0'                                    # Driver, from the CommandGate


class Phase(Enum):
    """What is known of the robot."""

    NO_LINE = 'no line'
    SEARCHING = 'robot or rate unknown'
    SILENT = 'known, does not answer'
    STARTED = 'known, was started, and has not answered since'
    WAITING = 'answers, is not in the mode in which it is driven'
    DRIVEN = 'answers, is in the mode in which it is driven'
    DOCKING = 'answers, drives itself onto its dock, in passive mode'
    LEAVING = 'the node exits'
    LEFT = 'the node exits, and the robot has confirmed that it stopped'


MAY_SEND: dict[Phase, set[Kind]] = {
    Phase.NO_LINE: set(),
    Phase.SEARCHING: {Kind.SEARCH},
    Phase.SILENT: {Kind.STOP, Kind.QUERY, Kind.START},
    Phase.STARTED: {Kind.STOP, Kind.QUERY},
    Phase.WAITING: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK},
    Phase.DRIVEN: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK, Kind.PANEL, Kind.SPEEDS},
    Phase.DOCKING: {Kind.STOP, Kind.QUERY, Kind.MODE, Kind.DOCK},
    Phase.LEAVING: {Kind.STOP, Kind.QUERY},
    Phase.LEFT: set()}
ANSWERING = {Phase.WAITING, Phase.DRIVEN, Phase.DOCKING}


def is_too_fast(linear: float, angular: float, width: float) -> bool:
    """Return whether a velocity in m/s and rad/s exceeds the speed limit of a wheel."""
    return 1000 * (abs(linear) + abs(angular) * width / 2) > protocol.MAX_SPEED


def wheel_speeds(linear: float, angular: float, width: float) -> tuple[float, float]:
    """Return (left, right) in mm/s for m/s and rad/s. Above the limit, both are reduced by one factor, which preserves
    the curvature."""
    difference = angular * width / 2
    left, right = 1000 * (linear - difference), 1000 * (linear + difference)
    excess = max(abs(left), abs(right)) / protocol.MAX_SPEED
    return (left / excess, right / excess) if excess > 1 else (left, right)


class Sender:
    """The sending side of the line on the host. The robot always keeps executing the last command."""

    def __init__(self) -> None:
        self.phase = Phase.NO_LINE  # decides what may be sent
        self.write: Callable[[bytes], None] | None = None   # sends bytes; None without a line
        self.error: OSError | None = None           # error that disconnected the line
        self.byte = 0               # transmission time of a byte
        self.speeds = 0, 0          # left, right: mm/s, sent last
        self._travel = STILL        # total travel at the speeds that were sent
        self._time = 0              # end of the integration so far
        self.line_free = 0          # time at which all bytes have been transmitted

    def use_line(self, write: Callable[[bytes], None] | None) -> None:
        """Start using a line that was opened. write(data): may raise OSError; None: the line has disconnected."""
        self.write, self.error = write, None

    def is_busy(self, now: int) -> bool:
        """Return whether the backlog on the line is so long that speeds should wait."""
        return self.line_free - now > BACKLOG

    def travel(self, now: int) -> Expected:
        """Return the total commanded travel up to `now`."""
        self._travel = self._travel.plus(Expected(*self.speeds), max(0, now - self._time) / SECOND / 1000)
        self._time = now
        return self._travel

    def may_send(self, kind: Kind) -> bool:
        return kind in MAY_SEND[self.phase]

    def send(self, now: int, kind: Kind, data: bytes, write: Callable[[bytes], None] | None = None) -> None:
        """Send bytes, if the phase allows their kind. After an error the line is no longer used. write: how to send
        them, by default at once."""
        if self.write is None or not self.may_send(kind):
            return
        self.line_free = max(now, self.line_free) + len(data) * self.byte
        try:
            (write or self.write)(data)
        except OSError as error:
            self.write, self.error = None, error

    def stop(self, now: int, stop: bytes = sequences.STOP, kind: Kind = Kind.STOP) -> None:
        """Send a stop: bytes that stop the robot."""
        self._change(now, (0, 0), kind, stop)

    def drive(self, now: int, speeds: tuple[float, float]) -> None:
        """Send wheel speeds (left, right; mm/s), rounded to whole numbers, if the phase allows them."""
        left, right = round(speeds[0]), round(speeds[1])
        kind = Kind.SPEEDS if left or right else Kind.STOP
        self._change(now, (left, right), kind, protocol.drive_direct(right, left))

    def _change(self, now: int, speeds: tuple[int, int], kind: Kind, data: bytes) -> None:
        if self.may_send(kind):
            self.travel(now)
            self.speeds = speeds
            self.send(now, kind, data)
