"""The open line to the robot, with its guardian process. It is reopened whenever it disconnects.

The serial port is opened for one process at a time, with a one-line message for each reason why it cannot be opened.
"""
from __future__ import annotations

import errno
import fcntl
import grp
import os
import select
import termios
import time
from typing import Callable, Iterable

import serial
from serial.tools import list_ports

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol, sequences
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.guardian import Guardian
from rbx1_nav.node.config import AUTO

PSEUDO_TERMINALS = range(136, 144)      # major device numbers (Linux kernel, admin-guide/devices.txt)
DEFAULT = '/dev/create', '/dev/ttyUSB0'         # name from the udev rules, first adapter
PORT_WARN_TIME = SECOND       # ns that a port may be unavailable before a warning: an old guardian may still be exiting
BEAT = SECOND // 10     # ns between two heartbeats to the guardian


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
    except (OSError, ValueError, termios.error) as error:
        # of some termios errors, pyserial passes on only the text; others it does not convert, and they are no OSError
        number = getattr(error, 'errno', None) or next(
            (each.args[0] for each in (error, error.__context__) if isinstance(each, termios.error)), None)
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
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.EIO):
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


class LineLost(OSError):
    """The line disconnected. The text gives the reason."""


class Link:
    """A serial port that may disconnect and reconnect. Times are in ns.

    pyserial opens the port. Its read() and write() are not used, because they need three times as many system calls.
    """

    def __init__(self, settings: Settings, warn: Callable[[str], None]) -> None:
        self.configured = settings.port
        self.path = find_port(settings.port, '', set())
        self.warn = warn
        self.baud = settings.baud or settings.model.baud
        self.port: serial.Serial = None     # None while it is not open
        self.guardian: Guardian | None = None
        self.guarded = True         # whether the guardian is alive
        self.problem = ''           # why the port is not open
        self.lost_at: int | None = None     # when the port became unavailable
        self.logged = ''            # the problem that was logged
        self.adapter = ''           # description of the last adapter
        self.others: set[str] = set()       # ports of other adapters at that time
        self.is_same = True         # whether the previous line had the same adapter
        self.beat_time = 0

    def open(self, now: int) -> bool:
        """Try to open the port. Returns whether it is open."""
        self.path = find_port(self.configured, self.adapter, self.others)
        try:
            self.port = open_port(self.path, self.baud)
            # until the robot is known, Start is the only command that is harmless at any baud rate
            self.guardian = Guardian(self.port.fd, sequences.START)
        except OSError as error:
            self.close()
            self.problem = str(error) if isinstance(error, PortError) else f'{self.path}: {error}'
            self.lost_at = now if self.lost_at is None else self.lost_at
            if now - self.lost_at >= PORT_WARN_TIME and self.logged != self.problem:
                self.logged = self.problem
                self.warn(f'{self.problem}; trying again')
            return False
        self.problem, self.logged, self.lost_at = '', '', None
        self.guarded = True
        self.beat_time = now - BEAT
        before, self.adapter = self.adapter, describe_adapter(self.path)
        self.others = list_adapters().keys() - {os.path.realpath(self.path)}
        self.is_same = before in ('', self.adapter)
        if not self.is_same:
            self.warn(f'{self.path} is now {self.adapter} (previously {before}): check that the same robot is '
                      'connected')
        return True

    def close(self) -> None:
        """Close the port. The guardian sends a final stop if the line is still connected."""
        if self.guardian:
            self.guardian.release()
        if self.port:
            self.port.close()
        self.guardian, self.port = None, None

    def set_rate(self, baud: int) -> None:
        """Set the rate (bits per second) and the other settings of a raw line. Raises LineLost."""
        self.baud = baud
        try:
            self.port.baudrate = baud
        except (OSError, ValueError, termios.error) as error:
            raise LineLost(f'{self.path}: {error}') from None

    def set_wake_lines(self, on: bool) -> bool:
        """Set or clear RTS and DTR. Returns whether the port has these lines. Raises LineLost."""
        try:
            self.port.rts = self.port.dtr = on
            return True
        except OSError as error:
            if error.errno not in (errno.ENOTTY, errno.EINVAL):
                raise LineLost(f'{self.path}: RTS and DTR: {error.strerror}') from None
            self.warn(f'wake_robot:=true: {self.path} has no RTS and DTR: expected an adapter that has these lines; '
                      'searching without waking the robot')
            return False

    def confirm(self, model: protocol.Model) -> None:
        """Allow the guardian to stop the robot, which is now known."""
        assert self.guardian
        self.guardian.beat(sequences.guardian_stop(model))

    def is_guarded(self, now: int) -> bool:
        """Send a heartbeat if one is due. Returns whether the guardian is alive."""
        if self.guarded and now - self.beat_time >= BEAT:
            self.beat_time = now
            self.guarded = self.guardian is not None and self.guardian.beat()
        return self.guarded

    def write(self, data: bytes) -> None:
        """Send bytes. Raises LineLost, also if the port's buffer is full: no bytes have left it for seconds."""
        try:
            written = os.write(self.port.fd, data)
        except OSError as error:
            raise LineLost(f'{self.path}: {error.strerror}') from None
        if written < len(data):
            raise LineLost(f'{self.path}: write timed out')

    def write_apart(self, data: bytes) -> None:
        """Send bytes with a pause after each, so that a receiver at another rate does not mix them. Raises LineLost."""
        for byte in data:
            self.write(bytes((byte,)))
            time.sleep(sequences.PAUSE / SECOND)

    def read(self, duration: float, missing: int | None) -> bytes:
        """Return the bytes that arrive. Returns at once if the guardian has died. Raises LineLost.

        duration: s until the next tick; missing: number of bytes to return for, None to return at the next tick.
        Waiting for all of them avoids waking up for each one.
        """
        if missing is None:
            self._wait((), duration)
            return self._read(0)
        data = self._read(duration)
        if data:
            time.sleep(max(0, missing - len(data)) * 10 / self.baud)
            data += self._read(0)
        return data

    def _wait(self, descriptors: Iterable[int], duration: float) -> bool:
        """Wait (s) for one of the descriptors, or the death of the guardian. Returns whether one can be read."""
        assert self.guardian
        ready = select.select((*descriptors, self.guardian.alive), (), (), duration)[0]
        self.guarded = self.guardian.alive not in ready
        return any(each in ready for each in descriptors)

    def _read(self, timeout: float) -> bytes:
        if not self._wait((self.port.fd,), timeout):
            return b''
        try:
            data = os.read(self.port.fd, 4096)
        except OSError as error:
            raise LineLost(f'{self.path}: {error.strerror}') from None
        if not data:        # a disconnected line stays readable without data
            raise LineLost(f'{self.path}: device disconnected')
        return data
