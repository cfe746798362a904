"""Sends bytes and speeds to the robot, and records the speeds. All times are in ns."""
from __future__ import annotations

from typing import Callable

from rbx1_nav.create import protocol
from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.commanded import Commanded
from rbx1_nav.create.driver.speeds import Rounding
from rbx1_nav.units import SECOND

BACKLOG = SECOND // 100     # backlog of bytes on the line beyond which only a stop is sent at once


class Sender:
    """The sending side of the line on the host."""

    def __init__(self) -> None:
        self.write: Callable[[bytes], None] | None = None   # sends bytes; None without a line
        self.error: OSError | None = None           # error that disconnected the line
        self.commanded = Commanded()
        self.byte = 0               # transmission time of a byte
        self._rounding = Rounding(), Rounding()
        self._line_free = 0         # time at which all bytes have been transmitted
        self._drive_time = 0        # time at which speeds were last sent

    def open(self, write: Callable[[bytes], None]) -> None:
        """Start using a line that was opened. write(data): may raise OSError."""
        self.write, self.error = write, None

    def close(self) -> None:
        """Stop using a line that disconnected. The robot keeps executing the last command."""
        self.write = None

    def is_busy(self, now: int) -> bool:
        """Return whether the backlog on the line is so long that speeds should wait."""
        return self._line_free - now > BACKLOG

    def send(self, now: int, data: bytes) -> None:
        """Send bytes, if there is a line. After an error the line is no longer used."""
        if self.write is None:
            return
        self._line_free = max(now, self._line_free) + len(data) * self.byte
        try:
            self.write(data)
        except OSError as error:
            self.write, self.error = None, error

    def stop(self, now: int, before: bytes = b'', after: bytes = sequences.STOP) -> None:
        """Send a stop. before: bytes to send first; after: the bytes that stop the robot."""
        self.commanded.send(now, (0, 0))
        for rounding in self._rounding:
            rounding.reset()
        self.send(now, before + after)

    def drive(self, now: int, speeds: tuple[float, float]) -> None:
        """Send wheel speeds (left, right; mm/s), rounded so that their means over time are right."""
        elapsed, self._drive_time = (now - self._drive_time) / SECOND, now
        left, right = (rounding.next(speed, elapsed) for rounding, speed in zip(self._rounding, speeds))
        self.commanded.send(now, (left, right))
        self.send(now, protocol.drive_direct(right, left))
