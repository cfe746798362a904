"""Finds the process at the other end of a connection, the process that listens on a port, and the own process.

Source: proc(5).
"""
from __future__ import annotations

import os
from pathlib import Path
import socket
import sys
import threading
from typing import Callable

from rbx1_nav.extras.lockstep.processes import Process

TABLES = Path('/proc/net/tcp'), Path('/proc/net/tcp6')     # the second one exists only with IPv6
INODE = 9               # number of the field
LISTEN = '0A'           # state of a socket


def own_process() -> Process | None:
    """Return the Process of the caller without the calling thread; None if the kernel does not show its threads."""
    try:
        process = Process(os.getpid(), threading.get_native_id())
        # the others wait for messages
        return process if any(thread.waits_in() != b'0' for thread in process.threads.values()) else None
    except OSError:
        return None


def peer_process(sock: socket.socket) -> Process | None:
    """Return the Process of the peer of a TCP connection; None if it is not visible from here: on another machine, in
    another container, or of another user."""
    try:
        peer, own = sock.getpeername(), sock.getsockname()
        addresses = [_address(sock.family, each) for each in (peer, own)]
    except (OSError, AttributeError):   # closed
        return None
    # the peer may have a socket for both families, as rosnodejs, Java and Go do: an IPv4 address is then the end of one
    return _process_with(lambda fields: all(map(str.endswith, fields[1:3], addresses)))


def listening_process(port: int) -> Process | None:
    """Return the Process that listens on a TCP port of this machine; None if it is not visible from here."""
    return _process_with(lambda fields: fields[3] == LISTEN and fields[1].endswith(f':{port:04X}'))


def _process_with(matches: Callable[[list[str]], bool]) -> Process | None:
    """Return the Process that owns a socket; matches(fields): whether a line of /proc/net/tcp describes the socket."""
    lines = (line.split() for table in TABLES if table.exists() for line in table.read_text('ascii').splitlines())
    link = f'socket:[{next((fields[INODE] for fields in lines if matches(fields)), None)}]'
    for pid in filter(str.isdigit, os.listdir('/proc')):
        folder = f'/proc/{pid}/fd/'
        try:
            if int(pid) != os.getpid() and any(_read_link(folder + file) == link for file in os.listdir(folder)):
                return Process(int(pid))
        except OSError:     # it has exited, or belongs to another user
            pass
    return None


def _address(family: int, address: tuple[str, int]) -> str:
    """Return an address as in /proc/net/tcp: words of 32 bits in the machine's byte order, and the port."""
    host = socket.inet_pton(family, address[0])
    words = ['%08X' % int.from_bytes(host[i:i + 4], sys.byteorder) for i in range(0, len(host), 4)]
    return '%s:%04X' % (''.join(words), address[1])


def _read_link(path: str) -> str | None:
    try:
        return os.readlink(path)
    except OSError:     # closed in between
        return None
