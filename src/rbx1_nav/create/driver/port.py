"""The serial port: opened for one process at a time, with one clear line for each reason why it cannot be."""
from __future__ import annotations

import errno
import fcntl
import glob
import grp
import os
import termios

import serial

PSEUDO_TERMINALS = range(136, 144)      # major numbers of devices (admin-guide/devices.txt of Linux)


class PortError(OSError):
    """A port that cannot be opened. The text names the port, the reason, and what to do."""


def open_port(path: str, baud: int) -> serial.Serial:
    """An open serial.Serial, whose file descriptor does not block. Raises PortError.

    flock(2) keeps other drivers away. It also holds for a process that inherits the file descriptor. TIOCEXCL keeps
    away whatever does not look for a lock, such as stty, except for root. A pseudo-terminal would keep that setting
    after the death of all processes that have it open, so it does not get it.
    """
    try:
        port = serial.Serial(path, baud, timeout=0, exclusive=True)
        if os.major(os.fstat(port.fd).st_rdev) not in PSEUDO_TERMINALS:
            fcntl.ioctl(port.fd, termios.TIOCEXCL)
        return port
    except (OSError, ValueError) as error:
        cause = error.__context__       # of an error in termios, pyserial passes on the text only
        number = getattr(error, 'errno', None) or (cause.args[0] if isinstance(cause, termios.error) else None)
        raise PortError(f'{path}: {reason(path, number, error)}') from None


def reason(path: str, number: int | None, error: Exception) -> str:
    """Why a port could not be opened. number: errno, or None; error: of pyserial."""
    if number in (errno.EAGAIN, errno.EBUSY):
        return f"in use by {user_of(path) or 'another process'}: expected a port that nobody uses"
    if number in (errno.EACCES, errno.EPERM):
        group = group_of(path)
        return f'not permitted: expected a user of the group {group}; `sudo adduser $USER {group}`, and log in again'
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV):
        return 'no such device: expected the adapter of the robot to be plugged in'
    if number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR):
        return 'not a serial port: expected the device of an adapter, such as /dev/ttyUSB0'
    return str(error)


def describe_adapter(path: str) -> str:
    """What identifies the adapter of a port: maker, product and serial number of a USB device, else the device's name.
    A pseudo-terminal has another one after each time that its other end was closed, so all count as the same."""
    name = os.path.realpath(path)
    if name.startswith('/dev/pts/'):
        return 'a pseudo-terminal'
    device = os.path.join('/sys/class/tty', os.path.basename(name), 'device')
    folders = [os.path.realpath(os.path.join(device, *['..'] * level)) for level in range(4)]
    for folder in folders:
        texts = [_read_text(os.path.join(folder, key)) for key in ('manufacturer', 'product', 'serial')]
        if any(texts):
            return ' '.join(filter(None, texts))
    return name


def _read_text(path: str) -> str:
    try:
        with open(path, encoding='utf-8', errors='replace') as file:
            return file.read().strip()
    except OSError:
        return ''


def group_of(path: str) -> str:
    """The name of the group that may use a device."""
    try:
        return grp.getgrgid(os.stat(path).st_gid).gr_name
    except (OSError, KeyError):
        return 'dialout'


def user_of(path: str) -> str:
    """The process that has locked a device, as 'NAME (process NUMBER)'; '' if /proc does not show it."""
    for link in glob.glob('/proc/[0-9]*/fd/*'):
        try:
            # not by its name: in a container, another device may have the same one
            if not os.path.samefile(link, path):
                continue
            with open(link.replace('/fd/', '/fdinfo/'), encoding='ascii') as file:
                locked = 'FLOCK' in file.read()
            pid = link.split('/')[2]
            if locked and int(pid) != os.getpid():
                return f'{command_of(pid)} (process {pid})'
        except OSError:     # it has ended, or belongs to another user
            continue
    return ''


def command_of(pid: str) -> str:
    """The file name of a process's program; of a script, the script's."""
    with open(f'/proc/{pid}/cmdline', 'rb') as file:
        words = [os.path.basename(os.fsdecode(word)) for word in file.read().split(b'\0') if word]
    return next((word for word in words if word.endswith('.py')), words[0] if words else '?')
