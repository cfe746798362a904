"""A separate process that stops the robot when the node cannot: after kill -9, or while the node hangs.

The robot has no watchdog: it keeps executing its last command. The guardian holds the line open and waits on a pipe
from the node. When the pipe closes, the node has died, for whatever reason. When no heartbeat arrives for HANG, the
node hangs. The guardian runs in its own session, so that a signal to the node's process group does not reach it.

This file is also the program of that process. It imports nothing from the package, so that it starts fast and does not
depend on what is installed.
"""
from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
import termios
import time

HANG = 1.0              # s without a heartbeat after which the node counts as hanging
START_TIMEOUT = 3.0     # s for the process to start on a busy machine
WRITE_TIMEOUT = 1.0     # s within which a line must accept the stop


class Guardian:
    """The node's interface to the guardian process."""

    def __init__(self, line: int, stop: bytes) -> None:
        """line: file descriptor of the port; stop: the bytes to send until beat() sets others. Raises OSError if the
        process does not start."""
        self.process = subprocess.Popen(
            [sys.executable, '-E', '-S', os.path.abspath(__file__), str(line), stop.hex()],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, pass_fds=(line,), start_new_session=True, cwd='/')
        assert self.process.stdin and self.process.stdout
        self.beats = self.process.stdin     # pipe that carries the heartbeats
        self.alive = self.process.stdout    # pipe that closes when the process dies
        if not (select.select([self.alive], [], [], START_TIMEOUT)[0] and os.read(self.alive.fileno(), 1)):
            self.process.kill()
            raise OSError('the guardian process did not start')

    def beat(self, stop: bytes = b'') -> bool:
        """Send a heartbeat. stop: the bytes that stop the robot at the current rate of the port, if they have changed.
        Returns whether the guardian is alive."""
        data = stop.hex().encode() + b'\n'
        try:
            return os.write(self.beats.fileno(), data) == len(data) and self.process.poll() is None
        except OSError:
            return False

    def release(self) -> None:
        """Let the guardian stop the robot and exit, without waiting for it."""
        self.beats.close()
        self.alive.close()


def send(line: int, data: bytes) -> None:
    """Write bytes to a port, discarding what is still waiting there. A disconnected port is not an error."""
    try:
        termios.tcflush(line, termios.TCOFLUSH)
    except termios.error:
        pass
    end = time.monotonic() + WRITE_TIMEOUT
    try:
        while data and select.select([], [line], [], max(0, end - time.monotonic()))[1]:
            try:
                data = data[os.write(line, data):]
            except BlockingIOError:
                time.sleep(0.001)
    except OSError:
        pass


def main(line: int, stop: bytes) -> None:
    """Wait until the node exits or hangs, and stop the robot. line, stop: see Guardian."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    try:
        os.write(1, b'.')
    except OSError:     # the node has died already
        pass
    received = b''
    timeout: float | None = None    # None before the first heartbeat, and while the node hangs
    while True:
        if select.select([0], [], [], timeout)[0]:
            timeout = HANG
            data = os.read(0, 4096)
            if not data:
                break
            *lines, received = (received + data).split(b'\n')
            for text in filter(None, lines):
                stop = bytes.fromhex(text.decode())
        else:
            timeout = None
            send(line, stop)
    send(line, stop)


if __name__ == '__main__':
    main(int(sys.argv[1]), bytes.fromhex(sys.argv[2]))
