"""Opens the serial port for one process at a time, with a one-line message for each reason why it cannot be opened."""
from __future__ import annotations

import errno
import fcntl
import glob
import grp
import os
import termios

import serial

from rbx1_nav.config import AUTO

PSEUDO_TERMINAL = 'a pseudo-terminal'
PSEUDO_TERMINALS = range(136, 144)      # major device numbers (Linux kernel, admin-guide/devices.txt)
ADAPTERS = '/dev/ttyUSB*', '/dev/ttyACM*'      # USB adapters
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
        return f"in use by {user_of(path) or 'another process'}: expected a port that is not in use"
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


def describe_adapter(path: str) -> str:
    """Return text that identifies the adapter of a port: manufacturer, product and serial number of a USB device, or
    else the device name. All pseudo-terminals have one text, because each gets a new name when it is reopened."""
    name = os.path.realpath(path)
    if name.startswith('/dev/pts/'):
        return PSEUDO_TERMINAL
    device = os.path.join('/sys/class/tty', os.path.basename(name), 'device')
    folders = [os.path.realpath(os.path.join(device, *['..'] * level)) for level in range(4)]
    for folder in folders:
        texts = [_read_text(os.path.join(folder, key)) for key in ('manufacturer', 'product', 'serial')]
        if any(texts):
            return ' '.join(filter(None, texts))
    return name


def list_adapters() -> set[str]:
    """Return the paths of the ports of all USB adapters."""
    return {path for pattern in ADAPTERS for path in glob.glob(pattern)}


def find_port(port: str, adapter: str, others: set[str]) -> str:
    """Return the path of a port, which may be AUTO. A USB adapter that was unplugged may return under another number.

    adapter: description of the last adapter, '' if there is none; others: ports of other adapters, which were there
    at the same time. Two adapters with one description are not distinguished.
    """
    path = next(filter(os.path.exists, DEFAULT), DEFAULT[-1]) if port == AUTO else port
    if adapter.startswith('/') or adapter in ('', PSEUDO_TERMINAL, describe_adapter(path)):
        return path
    same = [each for each in list_adapters() - others if describe_adapter(each) == adapter]
    return same[0] if len(same) == 1 else path


def _read_text(path: str) -> str:
    try:
        with open(path, encoding='utf-8', errors='replace') as file:
            return file.read().strip()
    except OSError:
        return ''


def group_of(path: str) -> str:
    """Return the name of the group that may use a device."""
    try:
        return grp.getgrgid(os.stat(path).st_gid).gr_name
    except (OSError, KeyError):
        return 'dialout'


def user_of(path: str) -> str:
    """Return the process that has locked a device, as 'NAME (process NUMBER)'; '' if /proc does not show it."""
    for link in glob.glob('/proc/[0-9]*/fd/*'):
        try:
            # do not compare names: in a container, another device may have this name
            if not os.path.samefile(link, path):
                continue
            with open(link.replace('/fd/', '/fdinfo/'), encoding='ascii') as file:
                locked = 'FLOCK' in file.read()
            pid = link.split('/')[2]
            if locked and int(pid) != os.getpid():
                return f'{command_of(pid)} (process {pid})'
        except OSError:     # the process has exited, or belongs to another user
            continue
    return ''


def command_of(pid: str) -> str:
    """Return the file name of a process's program, or of its script."""
    with open(f'/proc/{pid}/cmdline', 'rb') as file:
        words = [os.path.basename(os.fsdecode(word)) for word in file.read().split(b'\0') if word]
    return next((word for word in words if word.endswith('.py')), words[0] if words else '?')
