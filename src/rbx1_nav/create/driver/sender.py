"""Sends bytes and speeds to the robot, and keeps what was sent. All times are in ns."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.commanded import Commanded
from rbx1_nav.create.driver.speeds import Rounding
from rbx1_nav.units import SECOND

BACKLOG = SECOND // 100     # that the line may be busy with earlier bytes: then only a stop is sent at once


class Sender:
    """The host's end of the line."""

    def __init__(self) -> None:
        self.write: Callable[[bytes], None] | None = None   # sends bytes; None without a line
        self.error: OSError | None = None           # with which the line was lost
        self.commanded = Commanded()
        self.byte = 0               # how long a byte is on the line
        self._rounding = Rounding(), Rounding()
        self._line_free = 0         # when all bytes are on their way
        self._drive_time = 0        # when speeds were sent last

    def open(self, write: Callable[[bytes], None]) -> None:
        """A line was opened. write(data): may raise OSError."""
        self.write, self.error = write, None

    def close(self) -> None:
        """The line is lost. The robot keeps executing the last command."""
        self.write = None

    def is_busy(self, now: int) -> bool:
        """Whether the line is so far behind that speeds had better wait."""
        return self._line_free - now > BACKLOG

    def send(self, now: int, data: bytes) -> None:
        """Send bytes, if there is a line. It is given up at an error."""
        if self.write is None:
            return
        self._line_free = max(now, self._line_free) + len(data) * self.byte
        try:
            self.write(data)
        except OSError as error:
            self.write, self.error = None, error

    def stop(self, now: int, before: bytes = b'', after: bytes = sequences.STOP) -> None:
        """Send a stop, between other bytes."""
        self.commanded.send(now, (0, 0))
        for rounding in self._rounding:
            rounding.reset()
        self.send(now, before + after)

    def drive(self, now: int, speeds: tuple[float, float]) -> None:
        """Send the speeds of the wheels (left, right; mm/s), rounded so that their means are right."""
        elapsed, self._drive_time = (now - self._drive_time) / SECOND, now
        left, right = (rounding.next(speed, elapsed) for rounding, speed in zip(self._rounding, speeds))
        self.commanded.send(now, (left, right))
        self.send(now, protocol.drive_direct(right, left))
