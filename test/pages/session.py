"""Follows a Markdown page as a reader would, with a separate home directory, terminals and ROS master."""
import os
import re
import time

from ports import free_port

from . import blocks, expected, processes
from .master import Master
from .terminal import BASHRC, PROMPT, Terminal

LIMIT = 600             # s after which a step counts as hung; generous: a fit takes 300 s at a load of 25 on two cores
AFTER_CTRL_C = (0, 130)         # exit status: 130 is 128 + SIGINT

# Output that fails the page unless the page shows it. roslaunch prints the last one when a node exits on its own.
ERROR = re.compile(r'\[ *(ERROR|FATAL)\]|Traceback \(most|RLException|\] process has (died|finished)')

# last line of a traceback that ROS's own tools may print on exit on Debian 11: Python 3.9 has no Thread.isAlive()
HARMLESS = re.compile(r"AttributeError: '\w+' object has no attribute 'isAlive'")

# roscore ignores the port in ROS_MASTER_URI. RViz draws one frame per second in a small window: without a GPU, the size
# and the rate of its files would take a third of a core. test/view/ checks what RViz shows. Of 2000 simulated runs, the
# page shows only a picture.
FUNCTIONS = r"""
roscore() { command roscore -p "${ROS_MASTER_URI##*:}" "$@"; }
rosrun() {
  if [ "$1 $3" = 'rviz -d' ]; then
    sed 's/Frame Rate: .*/Frame Rate: 1/; s/Width: 1200/Width: 600/; s/Height: 760/Height: 400/' "$4" >~/slow.rviz
    set -- rviz rviz -d ~/slow.rviz
  fi
  command rosrun "${@/#2000/100}"
}
"""


class PageFailed(AssertionError):
    """The actual output differs from the page. The text includes the contents of the terminals."""


def is_harmless(lines):
    """Whether these lines begin with a traceback that is HARMLESS. Other nodes may log in between."""
    end = next((line for line in lines[1:] if not line.startswith((' ', '['))), '')
    return lines[0].startswith('Traceback') and HARMLESS.match(end) is not None


class Session:
    """A context in which the steps of a page are followed. On exit, remaining processes are killed."""

    def __init__(self, page, home, display='', limit=LIMIT):
        """page: name of the page. home: a directory for this page only. display: DISPLAY. limit: s allowed per step."""
        self.page, self.home, self.limit = page, home, limit
        self.line = 0               # of the page
        self.setup = []             # commands typed first in each new terminal
        self.terminals = {}         # by name
        self.last = None            # name of the last terminal used
        self.first = {}             # by name: index of the first line to search for output
        self.shown = set()          # (name, index) of the lines that the page shows
        uri = 'http://127.0.0.1:%d' % free_port()
        self.master = Master(uri)
        # nothing is inherited: the page must set up what its commands need
        self.env = {
            'HOME': home, 'PATH': '/usr/sbin:/usr/bin:/sbin:/bin', 'TERM': 'xterm-256color', 'LANG': 'C.UTF-8',
            'ROS_MASTER_URI': uri, 'ROS_IP': '127.0.0.1', 'DISPLAY': display,
            'PYTHONPYCACHEPREFIX': os.environ.get('PYTHONPYCACHEPREFIX', home),     # not in the source tree
            'OPENBLAS_NUM_THREADS': os.environ.get('OPENBLAS_NUM_THREADS', ''),
            'LIBGL_ALWAYS_SOFTWARE': '1', 'QT_X11_NO_MITSHM': '1', 'QT_QPA_PLATFORM': 'xcb', 'XDG_RUNTIME_DIR': home}

    def __enter__(self):
        with open(os.path.join(self.home, '.bashrc'), 'w') as file:
            file.write(BASHRC + FUNCTIONS)
        return self

    def __exit__(self, *_):
        processes.kill(self.home)
        self.close_terminals()

    def follow(self, steps):
        """Follow all steps, then stop the commands that still run. Raises PageFailed."""
        begin = time.monotonic()
        for step, following in zip(steps, steps[1:] + [None]):
            self.line = step.line
            print('%6.1f s  %s:%d %s %s' % (time.monotonic() - begin, self.page, step.line, type(step).__name__,
                                            ' '.join(map(str, step[1:]))), flush=True)
            if isinstance(step, blocks.Output):
                self.check_output(step)
                continue
            self.check_errors()
            if isinstance(step, blocks.Setup):
                self.set_up(step)
            elif isinstance(step, blocks.Run):
                self.open(blocks.RUN)
                self.run(blocks.RUN, step.commands, step.status)
            elif isinstance(step, blocks.Interrupt):
                self.interrupt(step.terminal)
            else:
                # if the page shows output, that is a better sign that the program is up
                self.start(step, wait=not isinstance(following, blocks.Output))
        self.end()

    # the steps

    def set_up(self, step):
        """Type commands in every terminal: in the open ones now, and in new ones when they open."""
        self.setup += step.commands
        for name, terminal in self.terminals.items():
            if terminal.status is not None:
                self.run(name, step.commands)

    def start(self, step, wait):
        """Type a command that stays in the foreground."""
        terminal = self.open(step.terminal)
        before = self.master.nodes()
        terminal.type(step.command)
        if wait:
            self.wait_for(lambda: terminal.status is not None or self.master.is_up(
                before, terminal.lines[self.first[step.terminal]:]), step.terminal, f'{step.command} is not up')
            if terminal.status is not None:
                self.fail('%s ended with status %d' % (step.command, terminal.status), step.terminal)

    def check_output(self, step):
        """Wait until a terminal shows all lines."""
        name = step.terminal or self.last
        terminal, first = self.terminals[name], self.first[name]

        def complete():
            # read before the lines: once a command has exited, its output is complete
            ended = terminal.status is not None
            found, missing = expected.find(step.lines, terminal.lines[first:], step.tolerance)
            if missing is None:
                self.shown.update((name, first + index) for index in found)
                self.first[name] = first + found[-1] + 1 if found else first
            elif ended:
                self.fail('ended with status %d, and no line %r' % (terminal.status, missing), name)
            return missing is None
        self.wait_for(complete, name, 'the output does not appear')

    def interrupt(self, name):
        """Press Ctrl-C."""
        terminal = self.terminals[name]
        if terminal.status is not None:
            self.fail('ended before Ctrl-C, with status %d' % terminal.status, name)
        self.last, self.first[name] = name, len(terminal.lines) - 1
        deadline = time.monotonic() + self.limit
        # bash may miss the key between two commands on one line: a reader would press it again
        while terminal.status is None and time.monotonic() < deadline:
            terminal.interrupt()
            self.wait(lambda: terminal.status is not None, 10)
        self.wait_for(lambda: terminal.status is not None, name, 'Ctrl-C does not stop it')
        if terminal.status not in AFTER_CTRL_C:
            self.fail('status %d after Ctrl-C' % terminal.status, name)

    def end(self):
        """Press Ctrl-C in all terminals with a running command, newest first. No process may remain."""
        for name in reversed(list(self.terminals)):
            if self.terminals[name].status is None:
                self.interrupt(name)
        self.check_errors()
        self.close_terminals()
        deadline = time.monotonic() + self.limit
        while processes.find(self.home):
            if time.monotonic() > deadline:
                raise PageFailed(f'{self.page}: processes left after the last step: {processes.find(self.home)}')
            time.sleep(0.2)

    # the terminals

    def open(self, name):
        """Select the terminal with this name, or open a new one. Its command has exited."""
        if name not in self.terminals:
            terminal = self.terminals[name] = Terminal(self.env)
            self.wait_for(lambda: terminal.status is not None, name, 'the shell does not start')
            self.run(name, self.setup)
        # the last line is the prompt, where the command will appear
        self.last, self.first[name] = name, len(self.terminals[name].lines) - 1
        return self.terminals[name]

    def close_terminals(self):
        """Close all terminals."""
        while self.terminals:
            self.terminals.popitem()[1].close()

    def run(self, name, commands, status=0):
        """Type commands and wait until each exits."""
        terminal = self.terminals[name]
        for command in commands:
            terminal.type(command)
            self.wait_for(lambda: terminal.status is not None, name, f'{command} does not exit')
            if terminal.status != status:
                self.fail('%s ended with status %d, expected %d' % (command, terminal.status, status), name)

    def wait_for(self, condition, name, trouble):
        """Wait for a condition, or fail."""
        if not self.wait(condition, self.limit):
            self.fail(f'{trouble} after {self.limit:g} s', name)

    @staticmethod
    def wait(condition, limit):
        """Wait for a condition for at most `limit` s; returns whether it came true."""
        deadline = time.monotonic() + limit
        while not condition():
            if time.monotonic() > deadline:
                return False
            time.sleep(0.2)
        return True

    def check_errors(self):
        """Fail if a command printed an error that the page does not show."""
        for name, terminal in self.terminals.items():
            for index, line in enumerate(terminal.lines):
                if (ERROR.search(line) and not line.startswith(PROMPT) and (name, index) not in self.shown
                        and not is_harmless(terminal.lines[index:])):
                    self.fail(f'the page does not show {line!r}', name)

    def fail(self, trouble, name):
        """Fail with the contents of the terminals, this one last."""
        names = [each for each in self.terminals if each != name] + [name]
        raise PageFailed('%s:%d: %s\n%s' % (self.page, self.line, trouble, '\n'.join(
            '--- terminal %s\n%s' % (each, self.terminals[each].screen) for each in names)))
