"""The runs that the page starts: each is a driving script in a separate process."""
from __future__ import annotations

import os
import signal
import subprocess
from threading import Lock, Thread
from types import MappingProxyType
from typing import Callable, Mapping, Sequence

from rbx1_nav.exercise.methods import METHODS

STOP_TIMEOUT = 3.0  # s after which a script that does not exit is killed; a script should exit within 1.4 s


class Runs:
    """At most one run at a time."""

    def __init__(self, folder: str, on_change: Callable[[str, str], None], after: Callable[[], None],
                 remappings: Mapping[str, str] = MappingProxyType({}), namespace: str = '') -> None:
        """folder: directory of the scripts; on_change(name, outcome): called with the outcome '' when a run begins, and
        with its outcome when it has finished; after(): called before the second of these calls; remappings: of names,
        for the scripts; namespace: of the robot, '' for the namespace of this node."""
        self.folder = folder
        self.on_change = on_change
        self.after = after
        self.environment = {**os.environ, 'ROS_NAMESPACE': namespace} if namespace else None
        self.remappings = [f'{name}:={new}' for name, new in remappings.items()]
        self.lock = Lock()
        self.busy = False
        self.stop_requested = False
        self.process: subprocess.Popen[bytes] | None = None

    def start(self, method: str, before: Callable[[Callable[[], bool]], None]) -> bool:
        """Call before(cancelled), and then start a run. method: a key of METHODS; cancelled(): returns whether the run
        was stopped. Returns False if a run is in progress.

        If before() raises an exception, the run is not started, and the outcome contains the error.
        """
        with self.lock:
            if self.busy:
                return False
            self.busy, self.stop_requested = True, False
        Thread(target=self._run, args=(method, before), daemon=True).start()
        return True

    def _run(self, method: str, before: Callable[[Callable[[], bool]], None]) -> None:
        # this thread must live as long as the script: pdeathsig is sent when the thread that started the script exits
        chosen = METHODS[method]
        self.on_change(chosen.title, '')
        try:
            before(lambda: self.stop_requested)
            outcome = self._execute([os.path.join(self.folder, chosen.script), *chosen.arguments, *self.remappings])
        except Exception as error:
            outcome = f'not started: {error}'
        try:
            self.after()
        except Exception:
            pass    # the master has exited, so the parameters are gone as well
        with self.lock:
            self.busy = False
        self.on_change(chosen.title, outcome)

    def _execute(self, command: Sequence[str]) -> str:
        with self.lock:
            if self.stop_requested:
                return 'stopped'
            # pdeathsig: if this process is killed, its Stop button no longer works, so the script must stop the robot
            self.process = process = subprocess.Popen(
                ['setpriv', '--pdeathsig', 'INT', *command], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                start_new_session=True, env=self.environment)
        status = process.wait()
        with self.lock:
            self.process = None
        if self.stop_requested or status > 128:     # a script that was interrupted adds the number of the signal
            return 'stopped'
        return 'finished' if status == 0 else f'failed with exit status {status}; see the log'

    def stop(self) -> None:
        """Stop the run as Ctrl-C does: the script stops the robot before it exits."""
        with self.lock:
            if not self.busy or self.stop_requested:
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
