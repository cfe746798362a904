"""A seat of seats.py: a roslaunch process with its own master, a simulated robot, and a page."""
from __future__ import annotations

import os
import re
import signal
import subprocess
from threading import Event, Thread
from typing import Callable, Sequence

from rbx1_nav.extras.web.access import CODE_VARIABLE, TEACHER_VARIABLE, TOKEN_VARIABLE, make_token, page_address

START_TIMEOUT = 60.0    # s for a seat to start
LINES = 20      # of the output that are kept
COLOR = re.compile('\x1b\\[[0-9;]*m')


class Seat:
    """The process of a seat. It can be started again: browsers that were at its page are then admitted again."""

    def __init__(self, number: int, master_port: int, address: str, web_port: int, teacher_port: int,
                 arguments: Sequence[str], report: Callable[[str], None]) -> None:
        """address: where the page is served; teacher_port: where the teacher's page is served; arguments: further
        arguments of seat.launch; report(text): called when a node of the seat exits."""
        self.number = number
        self.master_port = master_port
        self.web_port = web_port
        self.teacher_port = teacher_port
        self.token = make_token()
        self.address = address
        self.page = ''      # its address, with a code that is valid once
        self.command = ['roslaunch', '-p', str(master_port), 'rbx1_bringup', 'seat.launch', f'address:={address}',
                        f'port:={web_port}', f'title:=Seat {number}', *arguments]
        self.report = report
        self.process: subprocess.Popen[str] | None = None
        self.lines: list[str] = []      # the last ones of its output

    def start(self) -> bool:
        """Start the process. Returns whether base and page are ready."""
        self.lines, ready, code = [], Event(), make_token()
        self.page = page_address(self.address, self.web_port, code)
        # it gets SIGINT when this process exits, however it exits; and Ctrl-C in the terminal reaches only this process
        self.process = subprocess.Popen(['setpriv', '--pdeathsig', 'INT', *self.command], stdin=subprocess.DEVNULL,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        start_new_session=True,
                                        env={**os.environ, TOKEN_VARIABLE: self.token, CODE_VARIABLE: code,
                                             TEACHER_VARIABLE: str(self.teacher_port)})
        Thread(target=self._read, args=(self.process, ready), daemon=True).start()
        return ready.wait(START_TIMEOUT) and self.is_running

    @property
    def is_running(self) -> bool:
        """Whether the process runs."""
        return self.process is not None and self.process.poll() is None

    def _read(self, process: subprocess.Popen[str], ready: Event) -> None:
        """Read the output. ready: set when base and page are ready, or the process has exited."""
        missing = {'Ready: ', 'Open http'}
        for line in process.stdout or ():
            self.lines = [*self.lines[1 - LINES:], COLOR.sub('', line).strip('=\n')]
            if ready.is_set() and re.search('process has (died|finished)', line):
                self.report(f'seat {self.number}: {self.lines[-1]}')
            missing = {each for each in missing if each not in line}
            if not missing:
                ready.set()
        process.wait()
        ready.set()

    def stop(self) -> None:
        """Stop the process as Ctrl-C does; does not wait."""
        if self.process and self.is_running:
            self.process.send_signal(signal.SIGINT)

    def error(self) -> str:
        """Return the first errors in the output, or the last line."""
        errors = [line for line in self.lines if re.search('ERROR|FATAL|Exception|REQUIRED', line)]
        return ' '.join(errors[:2]) or (self.lines or ['no output'])[-1]
