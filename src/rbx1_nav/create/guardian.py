"""A process of its own that stops the robot when the node cannot: after kill -9, or while it hangs.

The robot has no watchdog: it goes on with its last command. The guardian holds the line open, and waits at a pipe from
the node. When the pipe closes, the node is gone, however it ended. When no byte comes for a while, the node hangs. It
runs in a session of its own, so that a signal to the node's process group does not reach it.

This file is the program too. It imports nothing of the package, so that it starts fast and whatever is installed.
"""
import os
import select
import signal
import subprocess
import sys
import termios
import time

HANG = 1.0              # s without a sign of life, after which the node hangs
START_TIMEOUT = 3.0     # s for the process to start, on a busy machine
WRITE_TIMEOUT = 1.0     # s in which a line must accept the stop


class Guardian:
    """The node's end."""

    def __init__(self, line, stop):
        """line: file descriptor of the port; stop: the bytes that stop the robot, whatever was sent before. Raises
        OSError if the process does not start."""
        self.process = subprocess.Popen(
            [sys.executable, '-E', '-S', os.path.abspath(__file__), str(line), stop.hex()],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, pass_fds=(line,), start_new_session=True, cwd='/')
        with self.process.stdout as pipe:
            if not (select.select([pipe], [], [], START_TIMEOUT)[0] and pipe.read(1)):
                self.process.kill()
                raise OSError('the guardian process does not start')

    def beat(self):
        """Give a sign of life. Returns whether the guardian is there."""
        try:
            return os.write(self.process.stdin.fileno(), b'.') == 1 and self.process.poll() is None
        except OSError:
            return False

    def release(self):
        """Let the guardian stop the robot and end. It is not waited for."""
        self.process.stdin.close()


def send(line, data):
    """Write bytes to a line, ahead of what still waits there. A line that is gone is no error."""
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


def main(line, stop):
    """Wait for the end of the node. line, stop: as of Guardian."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGTSTP):
        signal.signal(number, signal.SIG_IGN)
    os.write(1, b'.')
    os.close(1)
    timeout = None      # none before the first sign of life, and while the node hangs
    while True:
        if select.select([0], [], [], timeout)[0]:
            timeout = HANG
            if not os.read(0, 4096):
                break
        else:
            timeout = None
            send(line, stop)
    send(line, stop)


if __name__ == '__main__':
    main(int(sys.argv[1]), bytes.fromhex(sys.argv[2]))
