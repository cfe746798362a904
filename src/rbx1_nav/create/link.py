"""The open line to the robot, with its guardian: opened again whenever it is lost."""
import os
import select
import time

from rbx1_nav.create import sequences
from rbx1_nav.create.guardian import Guardian
from rbx1_nav.create.port import PortError, open_port
from rbx1_nav.units import SECOND

RETRY = SECOND // 5     # ns between two attempts to open the port
PATIENCE = SECOND       # ns that a port may be unavailable before it is logged: an old guardian needs a moment
BEAT = SECOND // 10     # ns between two signs of life to the guardian


class LineLost(OSError):
    """The line broke. The text says how."""


class Link:
    """A serial port that may come and go. Times are in ns.

    pyserial opens it. Its read() and write() are not used: they need three times as many system calls.
    """

    def __init__(self, settings, warn):
        """settings: Settings; warn(text): logs a line."""
        self.model = settings.model
        self.path = settings.port
        self.warn = warn
        self.port = None            # serial.Serial
        self.poll = None            # select.poll of the port
        self.guardian = None
        self.problem = ''           # why the port is not open
        self.lost_at = None         # since when
        self.logged = None          # the problem that was logged
        self.attempt = None
        self.beat_time = 0

    def open(self, now):
        """Try to open the port, if it is time to. Returns whether it is open."""
        if self.attempt is not None and now - self.attempt < RETRY:
            return False
        self.attempt = now
        try:
            self.port = open_port(self.path, self.model.baud)
            self.poll = select.poll()
            self.poll.register(self.port.fileno(), select.POLLIN)
            self.guardian = Guardian(self.port.fileno(), sequences.leave(self.model))
        except OSError as error:
            self.close()
            self.problem = str(error) if isinstance(error, PortError) else '%s: %s' % (self.path, error)
            self.lost_at = now if self.lost_at is None else self.lost_at
            if now - self.lost_at >= PATIENCE and self.logged != self.problem:
                self.logged = self.problem
                self.warn('%s; trying again' % self.problem)
            return False
        self.problem, self.logged, self.lost_at = '', None, None
        self.beat_time = now - BEAT
        return True

    def close(self):
        """Close the port. The guardian sends a last stop, if there still is a line."""
        if self.guardian:
            self.guardian.release()
        if self.port:
            self.port.close()
        self.guardian = self.port = None

    def is_guarded(self, now):
        """Give the guardian a sign of life, if it is time to. Returns whether it is there."""
        if now - self.beat_time < BEAT:
            return True
        self.beat_time = now
        return self.guardian.beat()

    def write(self, data):
        """Send bytes. Raises LineLost, also if the port has no room for them: then none have left it for seconds."""
        try:
            written = os.write(self.port.fileno(), data)
        except OSError as error:
            raise LineLost('%s: %s' % (self.path, error.strerror))
        if written < len(data):
            raise LineLost('%s: the adapter accepts no more bytes' % self.path)

    def read(self, duration, reader):
        """The bytes that arrive. Raises LineLost.

        duration: s until the next tick; reader: if it is set, return when its next reading is complete. Waiting for all
        of its bytes saves waking up for each.
        """
        if reader is None:
            time.sleep(duration)
            return self._read(0)
        data = self._read(duration)
        if data:
            time.sleep(max(0, reader.missing - len(data)) * 10 / self.model.baud)
            data += self._read(0)
        return data

    def _read(self, timeout):
        events = self.poll.poll(1000 * timeout)
        if not events:
            return b''
        try:
            data = os.read(self.port.fileno(), 4096)
        except OSError as error:
            raise LineLost('%s: %s' % (self.path, error.strerror))
        if not data:
            raise LineLost('%s: the adapter is gone' % self.path)
        return data
