"""Opens the serial port for one process at a time, with a one-line message for each reason why it cannot be opened."""
from __future__ import annotations

import errno
import fcntl
import grp
import os
import termios
from typing import Iterable

import serial
from serial.tools import list_ports

from rbx1_nav.config import AUTO

PSEUDO_TERMINALS = range(136, 144)      # major device numbers (Linux kernel, admin-guide/devices.txt)
DEFAULT = '/dev/create', '/dev/ttyUSB0'         # name from the udev rules, first adapter


class PortError(OSError):
    """The port cannot be opened. The text names the port, the reason, and the remedy."""


def open_port(path: str, baud: int) -> serial.Serial:
    """Open a port as a serial.Serial with a non-blocking file descriptor. Raises PortError.

    flock(2) keeps other drivers away. A process that inherits the file descriptor shares the lock. TIOCEXCL keeps away
    programs that do not check for a lock, such as stty, unless they run as the superuser. TIOCEXCL is not set on a
    pseudo-terminal, which would keep the setting after all processes that have it open have died.
    """
    try:
        port = serial.Serial(path, baud, timeout=0, exclusive=True)
        if os.major(os.fstat(port.fd).st_rdev) not in PSEUDO_TERMINALS:
            fcntl.ioctl(port.fd, termios.TIOCEXCL)
        return port
    except (OSError, ValueError) as error:
        cause = error.__context__       # for a termios error, pyserial passes on only the text
        number = getattr(error, 'errno', None) or (cause.args[0] if isinstance(cause, termios.error) else None)
        raise PortError(f'{path}: {reason(path, number, error)}') from None


def reason(path: str, number: int | None, error: Exception) -> str:
    """Return why a port could not be opened. number: errno, or None; error: exception from pyserial."""
    if number in (errno.EAGAIN, errno.EBUSY):
        return f'in use by another process: expected a port that is not in use; to find it: `sudo fuser -v {path}`'
    if number in (errno.EACCES, errno.EPERM):
        group = group_of(path)
        if group == 'root':
            return ('not permitted: expected a port of the group dialout; install the udev rules: see '
                    'docs/real_robot.md, "The serial port"')
        return (f'not permitted: expected a member of the group {group}; run `sudo adduser $USER {group}`, then log in '
                'again')
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV):
        return "no such device: expected the robot's adapter to be plugged in"
    if number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR):
        return 'not a serial port: expected the device of an adapter, such as /dev/ttyUSB0'
    return str(error)


def list_adapters() -> dict[str, str]:
    """Return {port: description} of all USB adapters: manufacturer, product and serial number."""
    try:
        texts = {each.device: (each.manufacturer, each.product, each.serial_number) for each in list_ports.comports()}
    except TypeError:   # pyserial finds no number of a device that is being unplugged
        return {}
    return {port: ' '.join(filter(None, each)) for port, each in texts.items() if any(each)}


def describe_adapter(path: str) -> str:
    """Return text that identifies the adapter of a port: its description, or else the device name. All pseudo-terminals
    have one text, because each gets a new name when it is reopened."""
    name = os.path.realpath(path)
    return 'a pseudo-terminal' if name.startswith('/dev/pts/') else list_adapters().get(name, name)


def find_port(port: str, adapter: str, others: Iterable[str]) -> str:
    """Return the path of a port, which may be AUTO. A USB adapter that was unplugged may return under another number.

    adapter: description of the last adapter, '' if there is none; others: ports of other adapters, which were there
    at the same time. Two adapters with one description are not distinguished.
    """
    path = next(filter(os.path.exists, DEFAULT), DEFAULT[-1]) if port == AUTO else port
    same = [each for each, text in list_adapters().items() if text == adapter and each not in others]
    return same[0] if len(same) == 1 and describe_adapter(path) != adapter else path


def group_of(path: str) -> str:
    """Return the name of the group that may use a device."""
    try:
        return grp.getgrgid(os.stat(path).st_gid).gr_name
    except (OSError, KeyError):
        return 'dialout'
