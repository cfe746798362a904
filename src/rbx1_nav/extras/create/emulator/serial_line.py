"""The serial line of an emulated robot, and the pseudo-terminal that connects a client to it.

Bytes arrive at the rate of the line, and as garbage at the wrong baud rate. All times are in ns.
"""
from __future__ import annotations

from collections import deque
import fcntl
import os
import random
import select
import struct
import time
import tty
from typing import Deque, Tuple

from rbx1_nav.base.units import SECOND
from rbx1_nav.node.config import ConfigError, show_name

BITS = 10           # bits per byte on the line: start bit, 8 data bits, stop bit
BUFFER_SIZE = 1024  # bytes that wait to be sent; further bytes are lost, which corrupts a stream that is too long
# termios.tcgetattr() supports only the common rates; this request (ioctl_tty(2)) returns any rate as a number
TCGETS2, TERMIOS2 = 0x802c542a, struct.Struct('=4I20s2I')
MIN_SLEEP = 0.001   # s: without a client, all bytes are lost, so there is no need to wake up for each one

TimedBytes = Deque[Tuple[int, int]]     # (time, byte)


def misread(data: bytes, sent_at: int, read_at: int) -> bytes:
    """Return the bytes that a receiver at the baud rate `read_at` reads when `data` is sent at `sent_at`.

    The receiver waits for a start bit, and then samples the line in the middle of each bit at its own rate.
    """
    if sent_at == read_at:
        return bytes(data)
    levels = [level for byte in data for level in [0] + [byte >> bit & 1 for bit in range(8)] + [1]]
    ratio = sent_at / read_at       # how many bits are sent while one is read
    received, start = bytearray(), 0
    while start < len(levels):
        if levels[start]:
            start += 1
            continue
        middles = [int(start + (bit + 1.5) * ratio) for bit in range(8)]
        received.append(sum(1 << bit for bit, middle in enumerate(middles)
                            if middle >= len(levels) or levels[middle]))
        start += max(1, int(9.5 * ratio))
    return bytes(received)


class SerialLine:
    """Both directions of a serial line between a host and the robot."""

    def __init__(self, baud: int, seed: int = 0) -> None:
        """baud: baud rate of the robot, bits per second; seed: seed of the random corruption."""
        self.baud = baud
        self.host_baud = baud
        self.corruption = 0.0   # fraction of the bytes to the host that are flipped, lost or doubled
        self.silent = False     # whether the line is dead in both directions
        self._random = random.Random(f'line {seed}')
        self._to_robot: TimedBytes = deque()    # with the arrival time of each byte
        self._to_host: TimedBytes = deque()
        self._last_to_robot = self._last_to_host = 0
        self._waiting: TimedBytes = deque()     # with the time at which each byte leaves the host
        self._rate = baud           # host baud rate for which the waiting bytes were scheduled

    def from_host(self, data: bytes, now: int) -> None:
        if self.silent:
            return
        data = self._recall(now) + data
        period = BITS * SECOND // self.host_baud
        start = max(now, self._last_to_robot)
        self._waiting += [(start + index * period, byte) for index, byte in enumerate(data)]
        self._last_to_robot = start + len(data) * period
        received = misread(data, self.host_baud, self.baud)
        self._to_robot += [(start + index * len(data) * period // len(received), byte)
                           for index, byte in enumerate(received, 1)]

    def _recall(self, now: int) -> bytes:
        """Return the bytes that still wait at the host if its rate has changed; they are sent at the new rate."""
        while self._waiting and self._waiting[0][0] <= now:
            self._waiting.popleft()
        if self._rate == self.host_baud:
            return b''
        self._rate = self.host_baud
        data = bytes(byte for _, byte in self._waiting)
        if data:
            self._last_to_robot = self._waiting[0][0]
            self._waiting.clear()
            while self._to_robot and self._to_robot[-1][0] > self._last_to_robot:
                self._to_robot.pop()
        return data

    def from_robot(self, data: bytes, now: int) -> None:
        period = BITS * SECOND // self.baud
        time = max(now, self._last_to_host)
        for byte in data[:max(0, BUFFER_SIZE - (time - now) // period)]:
            time += period
            self._to_host.append((time, byte))
        self._last_to_host = time

    @property
    def next_to_robot(self) -> int | None:
        """The time at which the next byte arrives at the robot, or None."""
        return self._to_robot[0][0] if self._to_robot else None

    @property
    def next_to_host(self) -> int | None:
        """The time at which the next byte arrives at the host, or None."""
        return self._to_host[0][0] if self._to_host else None

    def receive_byte(self) -> int:
        """Return the next byte that arrives at the robot."""
        return self._to_robot.popleft()[1]

    def received(self, now: int) -> bytes:
        """Return the bytes that have arrived at the host since the last call."""
        data = bytearray()
        while self._to_host and self._to_host[0][0] <= now:
            data.append(self._to_host.popleft()[1])
        return b'' if self.silent or not data else self._corrupt(misread(bytes(data), self.baud, self.host_baud))

    def _corrupt(self, data: bytes) -> bytes:
        if not self.corruption:
            return data
        result = bytearray()
        for byte in data:
            if self._random.random() < self.corruption:
                flipped = byte ^ 1 << self._random.randrange(8)
                result += self._random.choice((b'', bytes((byte, byte)), bytes((flipped,))))
            else:
                result.append(byte)
        return bytes(result)


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
        if self._master is None:
            return None
        rate: int = TERMIOS2.unpack(fcntl.ioctl(self._master, TCGETS2, bytes(TERMIOS2.size)))[-1]
        return rate

    def read(self) -> bytes:
        """Return the bytes that the client has sent since the last call."""
        try:
            return os.read(self._master, 4096) if self._master is not None else b''
        except OSError:     # nothing there, or no client
            return b''

    def write(self, data: bytes) -> None:
        """Send bytes to the client. They are lost if there is no client, or if it does not read them."""
        if data and self._master is not None and self.has_client():
            try:
                os.write(self._master, data)
            except OSError:     # the client does not read, or has just disconnected
                pass

    def wait(self, duration: float) -> None:
        """Wait until the client sends something, for at most `duration` (s)."""
        if not self.has_client(duration):
            time.sleep(max(duration, MIN_SLEEP))

    def has_client(self, duration: float = 0.0) -> bool:
        """Return whether a client has opened the device. Waits until it sends something, for at most `duration` (s)."""
        master = self._master       # another thread may unplug the cable
        if master is None:
            return False
        poll = select.poll()
        poll.register(master, select.POLLIN)
        events = poll.poll(1000 * duration)
        return not events or bool(events[0][1] & select.POLLIN)

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
