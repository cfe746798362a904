"""The open line to the robot, with its guardian: opened again whenever it is lost."""
import errno
import os
import select
import termios
import time

from rbx1_nav.create.driver import sequences
from rbx1_nav.create.driver.guardian import Guardian
from rbx1_nav.create.driver.port import PortError, describe_adapter, open_port
from rbx1_nav.create.driver.search import NoWakeLines
from rbx1_nav.create.line_settings import rate_in, read_settings
from rbx1_nav.units import SECOND

RETRY = SECOND // 5     # ns between two attempts to open the port
PORT_WARN_TIME = SECOND       # ns that a port may be unavailable before it is logged: an old guardian needs a moment
BEAT = SECOND // 10     # ns between two signs of life to the guardian


class LineLost(OSError):
    """The line broke. The text says how."""


class Link:
    """A serial port that may come and go. Times are in ns.

    pyserial opens it. Its read() and write() are not used: they need three times as many system calls.
    """

    def __init__(self, settings, warn):
        """settings: Settings; warn(text): logs a line."""
        self.path = settings.port
        self.warn = warn
        self.baud = settings.baud or settings.model.baud
        self.port = None            # serial.Serial
        self.guardian = None
        self.guarded = True         # whether the guardian lives
        self.problem = ''           # why the port is not open
        self.lost_at = None         # since when
        self.logged = None          # the problem that was logged
        self.adapter = None         # the last one, as text
        self.is_same = True         # whether it is that of the line before
        self.attempt = None
        self.beat_time = 0
        self.settings = None        # of the port, as read_settings() returns them
        self.changes = 0            # times that another process has changed them
        self.disturbed = False      # whether that has happened since a caller has cleared this

    def open(self, now):
        """Try to open the port, if it is time to. Returns whether it is open."""
        if self.attempt is not None and now - self.attempt < RETRY:
            return False
        self.attempt = now
        try:
            self.port = open_port(self.path, self.baud)
            self.settings = read_settings(self.port.fd)
            # until the robot is known, only a start is harmless at any rate
            self.guardian = Guardian(self.port.fd, sequences.START)
        except OSError as error:
            self.close()
            self.problem = str(error) if isinstance(error, PortError) else f'{self.path}: {error}'
            self.lost_at = now if self.lost_at is None else self.lost_at
            if now - self.lost_at >= PORT_WARN_TIME and self.logged != self.problem:
                self.logged = self.problem
                self.warn(f'{self.problem}; trying again')
            return False
        self.problem, self.logged, self.lost_at = '', None, None
        self.guarded = True
        self.beat_time = now - BEAT
        self._compare_adapters()
        return True

    def _compare_adapters(self):
        before, self.adapter = self.adapter, describe_adapter(self.path)
        self.is_same = before in (None, self.adapter)
        if not self.is_same:
            self.warn('%s is now %s, before it was %s: check that the same robot is connected'
                      % (self.path, self.adapter, before))

    def close(self):
        """Close the port. The guardian sends a last stop, if there still is a line."""
        if self.guardian:
            self.guardian.release()
        if self.port:
            self.port.close()
        self.guardian = self.port = None

    def set_rate(self, baud):
        """Set the rate (bits per second), and all that belongs to a raw line. Raises LineLost."""
        self.baud = baud
        try:
            self.port.baudrate = baud
        except (OSError, ValueError, termios.error) as error:
            raise LineLost(f'{self.path}: {error}')
        self.settings = read_settings(self.port.fd)

    def set_wake_lines(self, on):
        """Set RTS and DTR, or clear them. Raises NoWakeLines, and LineLost."""
        try:
            self.port.rts = self.port.dtr = on
        except OSError as error:
            if error.errno not in (errno.ENOTTY, errno.EINVAL):
                raise LineLost(f'{self.path}: RTS and DTR: {error.strerror}')
            self.warn('wake_robot:=true: %s has no RTS and DTR: expected an adapter that has these lines; searching '
                      'without waking the robot' % self.path)
            raise NoWakeLines(error.errno, error.strerror)

    def confirm(self, found):
        """The robot is known (Found): the guardian may stop it."""
        self.guardian.confirm(sequences.guardian_stop(found.model))

    def is_guarded(self, now):
        """Look after the guardian and the settings, if it is time to. Returns whether the guardian is alive."""
        if self.guarded and now - self.beat_time >= BEAT:
            self.beat_time = now
            self._keep_settings()
            self.guarded = self.guardian.beat()
        return self.guarded

    def _keep_settings(self):
        """Set back what another process has changed. With an echo, say, the robot would execute its own readings."""
        settings = read_settings(self.port.fd)
        if settings in (None, self.settings):
            return
        self.changes += 1
        self.disturbed = True
        rate = rate_in(settings)
        self.warn('%s: another process has changed the %s; set back' % (
            self.path, 'settings' if rate == self.baud else 'rate to %d baud: expected %d' % (rate, self.baud)))
        self.set_rate(self.baud)

    def write(self, data):
        """Send bytes, at the right rate. Raises LineLost, also if the port has no room for them: then none have left it
        for seconds."""
        self._keep_settings()
        try:
            written = os.write(self.port.fd, data)
        except OSError as error:
            raise LineLost(f'{self.path}: {error.strerror}')
        if written < len(data):
            raise LineLost(f'{self.path}: write timed out')

    def write_apart(self, data):
        """Send bytes with a pause after each, so that a receiver at another rate does not mix them. Raises LineLost."""
        for byte in data:
            self.write(bytes((byte,)))
            time.sleep(sequences.PAUSE / SECOND)

    def read(self, duration, reader):
        """The bytes that arrive. Returns at once if the guardian has died. Raises LineLost.

        duration: s until the next tick; reader: if it is set, return when its next reading is complete. Waiting for all
        of its bytes saves waking up for each.
        """
        if reader is None:
            self._wait((), duration)
            return self._read(0)
        data = self._read(duration)
        if data:
            time.sleep(max(0, reader.missing - len(data)) * 10 / self.baud)
            data += self._read(0)
        return data

    def _wait(self, descriptors, duration):
        """Whether one of the descriptors can be read within a time (s), in which the guardian lives."""
        ready = select.select((*descriptors, self.guardian.alive), (), (), duration)[0]
        self.guarded = self.guardian.alive not in ready
        return any(each in ready for each in descriptors)

    def _read(self, timeout):
        if not self._wait((self.port.fd,), timeout):
            return b''
        try:
            data = os.read(self.port.fd, 4096)
        except OSError as error:
            raise LineLost(f'{self.path}: {error.strerror}')
        if not data:
            raise LineLost(f'{self.path}: device disconnected')
        return data
