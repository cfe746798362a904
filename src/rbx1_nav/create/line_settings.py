"""The settings of a serial port, as they are now."""
import fcntl
import struct

# termios.tcgetattr() knows the common rates only; this request (ioctl_tty(2)) knows all, as numbers
TCGETS2, TERMIOS2 = 0x802c542a, struct.Struct('=4I20s2I')


def read_settings(descriptor):
    """All settings of an open terminal, as bytes that can be compared; None if it has disconnected."""
    try:
        return fcntl.ioctl(descriptor, TCGETS2, bytes(TERMIOS2.size))
    except OSError:
        return None


def read_rate(descriptor):
    """The rate of an open terminal, bits per second; None if it has disconnected."""
    settings = read_settings(descriptor)
    return settings and rate_in(settings)


def rate_in(settings):
    """The rate in the result of read_settings()."""
    return TERMIOS2.unpack(settings)[-1]
