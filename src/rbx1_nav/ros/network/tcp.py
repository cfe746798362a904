"""Reads the state of a TCP connection from the kernel: whether the peer still acknowledges data."""
from __future__ import annotations

import fcntl
import socket
import struct
import sys
import termios
from typing import NamedTuple

ESTABLISHED = 1     # include/net/tcp_states.h
CLOSED_WINDOW = 512     # bytes: a peer with less receive space than this does not read; a Twist takes 52

# struct tcp_info of linux/tcp.h: tcpi_state at 0, tcpi_bytes_acked at 120, tcpi_snd_wnd at 228 (since Linux 5.4)
_INFO = struct.Struct('=B119xQ100xI')


class Connection(NamedTuple):
    """The state of a TCP connection."""

    established: bool       # whether neither side has closed it
    unacknowledged: int     # bytes that were sent, or wait to be sent, and are not acknowledged
    acknowledged: int       # acknowledged bytes so far
    window: int             # receive space of the peer, bytes


def read_connection(sock: socket.socket) -> Connection:
    """Return the Connection of a socket. Raises OSError if it is closed."""
    info = sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, _INFO.size)
    # an older kernel does not report the window: assume that it is open
    state, acknowledged, window = _INFO.unpack(info) if len(info) == _INFO.size else (info[0], 0, CLOSED_WINDOW)
    return Connection(state == ESTABLISHED, _read_unsent(sock), acknowledged, window)


def _read_unsent(sock: socket.socket) -> int:
    """Return the kernel's answer to SIOCOUTQ of tcp(7), which is TIOCOUTQ."""
    number = bytearray(4)
    fcntl.ioctl(sock, termios.TIOCOUTQ, number)
    return int.from_bytes(number, sys.byteorder)


class AcknowledgementTimer:
    """Measures how long a peer has not acknowledged any data although some was unacknowledged."""

    def __init__(self) -> None:
        self.since: float | None = None     # s: start of the current silence; None if there is none
        self.acknowledged = 0

    def silence(self, now: float, connection: Connection) -> float:
        """Return the duration of the silence, s. now: s."""
        if not connection.unacknowledged or connection.acknowledged != self.acknowledged:
            self.since = None
        elif self.since is None:
            self.since = now
        self.acknowledged = connection.acknowledged
        return 0.0 if self.since is None else now - self.since
