"""A pseudo-terminal that emulates a serial port: the robot's side of the cable."""
from __future__ import annotations

import os
import select
import time
import tty

from rbx1_nav.config import ConfigError, show_name
from rbx1_nav.create.line_settings import read_rate

MIN_SLEEP = 0.001   # s: without a client, all bytes are lost, so there is no need to wake up for each one


class PseudoTerminal:
    """A serial port that a client can open by name, with a cable that can be unplugged."""

    def __init__(self, link: str | None = None) -> None:
        """link: the path of a symbolic link to the device, or None. Raises ConfigError if the link cannot be created.
        """
        self.link = link
        self.device: str | None = None
        self._master: int | None = None
        self.plug()

    def plug(self) -> None:
        """Plug the cable in: a new device appears. Raises ConfigError if the link cannot be created."""
        if self._master is not None:
            return
        self._master, slave = os.openpty()
        self.device = os.ttyname(slave)
        tty.setraw(slave)       # no echo for any client
        os.close(slave)
        os.set_blocking(self._master, False)
        if self.link:
            try:
                self._make_link(self.link, self.device)
            except ConfigError:
                self.unplug()
                raise

    def unplug(self) -> None:
        """Unplug the cable: the client gets an error, and the device disappears."""
        if self._master is None:
            return
        if self.link and os.path.islink(self.link) and os.readlink(self.link) == self.device:
            os.unlink(self.link)
        os.close(self._master)
        self._master = None
        self.device = None

    @property
    def baud(self) -> int | None:
        """The baud rate that the client has set, bits per second; None while the cable is unplugged."""
        return None if self._master is None else read_rate(self._master)

    def read(self) -> bytes:
        """Return the bytes that the client has sent since the last call."""
        try:
            return os.read(self._master, 4096) if self._master is not None else b''
        except OSError:     # nothing there, or no client
            return b''

    def write(self, data: bytes) -> None:
        """Send bytes to the client. They are lost if there is no client, or if it does not read them."""
        if data and self._master is not None and self._client(0) is not None:
            try:
                os.write(self._master, data)
            except OSError:     # the client does not read, or has just disconnected
                pass

    @property
    def has_client(self) -> bool:
        """Whether a client has opened the device."""
        return self._client(0) is not None

    def wait(self, duration: float) -> None:
        """Wait until the client sends something, for at most `duration` (s)."""
        if self._client(duration) is None:
            time.sleep(max(duration, MIN_SLEEP))

    def _client(self, duration: float) -> bool | None:
        """Wait for at most `duration` (s). Returns whether the client has sent something; None without a client."""
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
    return ConfigError(f'link: {show_name(link)}: {text}: expected a path where a symbolic link can be created')
