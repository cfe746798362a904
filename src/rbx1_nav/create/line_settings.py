"""The settings of a serial port, as they are now."""
from __future__ import annotations

import fcntl
import struct

# termios.tcgetattr() knows the common rates only; this request (ioctl_tty(2)) knows all, as numbers
TCGETS2, TERMIOS2 = 0x802c542a, struct.Struct('=4I20s2I')


def read_settings(descriptor: int) -> bytes | None:
    """All settings of an open terminal, as bytes that can be compared; None if it has disconnected."""
    try:
        return fcntl.ioctl(descriptor, TCGETS2, bytes(TERMIOS2.size))
    except OSError:
        return None


def read_rate(descriptor: int) -> int | None:
    """The rate of an open terminal, bits per second; None if it has disconnected."""
    settings = read_settings(descriptor)
    return None if settings is None else rate_in(settings)


def rate_in(settings: bytes) -> int:
    """The rate in the result of read_settings()."""
    rate: int = TERMIOS2.unpack(settings)[-1]
    return rate
