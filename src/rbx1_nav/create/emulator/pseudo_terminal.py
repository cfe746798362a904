"""A pseudo-terminal in the place of a serial port: the robot's end of the cable."""
from __future__ import annotations

import os
import select
import time
import tty

from rbx1_nav.config import ConfigError, show_name
from rbx1_nav.create.line_settings import read_rate

MIN_SLEEP = 0.001   # s: while nobody listens, each byte that is lost is not worth waking up for


class PseudoTerminal:
    """A serial port that a client can open by name, at the end of a cable that can be pulled."""

    def __init__(self, link: str | None = None) -> None:
        """link: the path of a symbolic link to the device, or None. Raises ConfigError if it cannot be made."""
        self.link = link
        self.device: str | None = None
        self._master: int | None = None
        self.plug()

    def plug(self) -> None:
        """Put the cable in: a new device appears. Raises ConfigError if the link cannot be made."""
        if self._master is not None:
            return
        self._master, slave = os.openpty()
        self.device = os.ttyname(slave)
        tty.setraw(slave)       # no echo, whoever opens it
        os.close(slave)
        os.set_blocking(self._master, False)
        if self.link:
            try:
                self._make_link(self.link, self.device)
            except ConfigError:
                self.unplug()
                raise

    def unplug(self) -> None:
        """Pull the cable: the client gets an error, and the device is gone."""
        if self._master is None:
            return
        if self.link and os.path.islink(self.link) and os.readlink(self.link) == self.device:
            os.unlink(self.link)
        os.close(self._master)
        self._master = None
        self.device = None

    @property
    def baud(self) -> int | None:
        """The baud rate that the client has set, bits per second; None while the cable is out."""
        return None if self._master is None else read_rate(self._master)

    def read(self) -> bytes:
        """The bytes that the client has sent since the last call."""
        try:
            return os.read(self._master, 4096) if self._master is not None else b''
        except OSError:     # nothing there, or no client
            return b''

    def write(self, data: bytes) -> None:
        """Send bytes to the client. They are lost without one, and if it does not read."""
        if data and self._master is not None and self._client(0) is not None:
            try:
                os.write(self._master, data)
            except OSError:     # it does not read, or has just gone
                pass

    @property
    def has_client(self) -> bool:
        """Whether somebody has opened the device."""
        return self._client(0) is not None

    def wait(self, duration: float) -> None:
        """Wait until the client sends something, at most `duration` (s)."""
        if self._client(duration) is None:
            time.sleep(max(duration, MIN_SLEEP))

    def _client(self, duration: float) -> bool | None:
        """Whether the client has sent something within a time (s); None if there is none."""
        if self._master is None:
            return None
        poll = select.poll()
        poll.register(self._master, select.POLLIN)
        events = poll.poll(1000 * duration)
        if events and not events[0][1] & select.POLLIN:
            return None
        return bool(events)

    def _make_link(self, link: str, device: str) -> None:
        if os.path.lexists(link) and not os.path.islink(link):
            raise _error(link, 'exists, and is not a link')
        temporary = f'{link}.{os.getpid()}'
        try:
            os.symlink(device, temporary)
            os.replace(temporary, link)
        except OSError as error:
            raise _error(link, error.strerror) from None


def _error(link: str, text: str) -> ConfigError:
    return ConfigError(f'link: {show_name(link)}: {text}: expected a path where a symbolic link may be made')
