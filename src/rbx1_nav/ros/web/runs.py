"""The runs that the page starts: the driving scripts, each in a process of its own."""
from __future__ import annotations

import os
import signal
import subprocess
from threading import Lock, Thread
from typing import Callable, Sequence

# by method: its name for the reader, script, arguments. The master keeps the frame of a run, so it is always set
SCRIPTS: dict[str, tuple[str, str, Sequence[str]]] = {
    'timed': ('timed', 'timed_out_and_back.py', ()),
    'odometry': ('with odometry', 'odom_out_and_back.py', ('_odom_frame:=odom',)),
    'gyro': ('with odometry and gyro', 'odom_out_and_back.py', ('_odom_frame:=odom_combined',))}
STOP_TIMEOUT = 3.0  # s after which a script that was to end is killed; it has 1.4 s


class Runs:
    """At most one run at a time."""

    def __init__(self, folder: str, on_change: Callable[[str, str], None], after: Callable[[], None]) -> None:
        """folder: of the scripts; on_change(name, outcome): called with '' when a run begins, and when it has ended;
        after(): called before the latter."""
        self.folder = folder
        self.on_change = on_change
        self.after = after
        self.lock = Lock()
        self.busy = False
        self.stop_requested = False
        self.process: subprocess.Popen[bytes] | None = None

    def start(self, method: str, before: Callable[[], None]) -> bool:
        """Start a run, by a key of SCRIPTS, after a call of before(). Returns False if there is one already.

        An exception of before() becomes the outcome.
        """
        with self.lock:
            if self.busy:
                return False
            self.busy, self.stop_requested = True, False
        Thread(target=self._run, args=(method, before), daemon=True).start()
        return True

    def _run(self, method: str, before: Callable[[], None]) -> None:
        # one thread for all of a run: the kernel sends pdeathsig when the thread that started the process has ended
        name, script, arguments = SCRIPTS[method]
        self.on_change(name, '')
        try:
            before()
            outcome = self._execute([os.path.join(self.folder, script), *arguments])
        except Exception as error:
            outcome = f'not started: {error}'
        try:
            self.after()
        except Exception:
            pass    # the master has exited, and the parameters with it
        with self.lock:
            self.busy = False
        self.on_change(name, outcome)

    def _execute(self, command: Sequence[str]) -> str:
        with self.lock:
            if self.stop_requested:
                return 'stopped'
            # if this process is killed, so is the only Stop button: the script then stops the robot, too
            self.process = process = subprocess.Popen(
                ['setpriv', '--pdeathsig', 'INT', *command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                start_new_session=True)
        status = process.wait()
        with self.lock:
            self.process = None
        if self.stop_requested:
            return 'stopped'
        return 'finished' if status == 0 else f'failed with exit status {status}; see the log'

    def stop(self) -> None:
        """Stop the run, as Ctrl-C does: the script stops the robot first."""
        with self.lock:
            if not self.busy:
                return
            self.stop_requested = True
            process = self.process
            if process:
                process.send_signal(signal.SIGINT)
        if process:
            Thread(target=self._kill, args=(process,), daemon=True).start()

    @staticmethod
    def _kill(process: subprocess.Popen[bytes]) -> None:
        try:
            process.wait(STOP_TIMEOUT)
        except subprocess.TimeoutExpired:
            process.kill()
