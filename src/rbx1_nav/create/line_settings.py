"""Reads the current settings of a serial port."""
from __future__ import annotations

import fcntl
import struct

# termios.tcgetattr() supports only the common rates; this request (ioctl_tty(2)) returns any rate as a number
TCGETS2, TERMIOS2 = 0x802c542a, struct.Struct('=4I20s2I')


def read_settings(descriptor: int) -> bytes | None:
    """Return all settings of an open terminal as comparable bytes; None if it has disconnected."""
    try:
        return fcntl.ioctl(descriptor, TCGETS2, bytes(TERMIOS2.size))
    except OSError:
        return None


def read_rate(descriptor: int) -> int | None:
    """Return the rate of an open terminal in bits per second; None if it has disconnected."""
    settings = read_settings(descriptor)
    return None if settings is None else rate_in(settings)


def rate_in(settings: bytes) -> int:
    """Return the rate (bits per second) in the result of read_settings()."""
    rate: int = TERMIOS2.unpack(settings)[-1]
    return rate
