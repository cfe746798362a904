"""A terminal as a reader would open it: an interactive bash on a separate pseudo-terminal."""
import codecs
import fcntl
import os
import pty
import re
import struct
import subprocess
import termios
import threading

PROMPT = '$ '
# For ~/.bashrc. With each prompt the shell reports the exit status of the last command, in the escape sequence that
# terminals with shell integration use (OSC 133;D). It comes last, so that typing cannot get ahead of the prompt.
BASHRC = f"unset PROMPT_COMMAND; PS1='{PROMPT}\\e]133;D;$?\\a'\n"
STATUS = re.compile('\033]133;D;(\\d+)\007')
ESCAPE = re.compile('\033\\[[0-?]*[ -/]*[@-~]|\033][^\007\033]*(?:\007|\033\\\\)')
ROWS, COLUMNS = 40, 120


class Terminal:
    """Types commands and stores all output. ~/.bashrc must contain BASHRC."""

    def __init__(self, env):
        """env: the environment of the shell, with HOME."""
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack('HHHH', ROWS, COLUMNS, 0, 0))
        self.shell = subprocess.Popen(['setsid', '--ctty', 'bash', '--noprofile', '--noediting', '-i'], env=env,
                                      cwd=env['HOME'], stdin=slave, stdout=slave, stderr=slave)
        os.close(slave)
        self._text, self._typed = '', 0
        # a thread: programs block if their terminal output is not read
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        decode = codecs.getincrementaldecoder('utf-8')('replace').decode
        while True:
            try:
                data = os.read(self.master, 65536)
            except OSError:     # EIO: the last process on the terminal has exited
                return
            self._text += decode(data)

    @property
    def lines(self):
        """All output without escape sequences. A carriage return, as in a progress bar, also terminates a line."""
        return re.split('[\r\n]+', ESCAPE.sub('', self._text))

    @property
    def screen(self):
        """The visible text: the last lines, each as its last carriage return left it."""
        lines = ESCAPE.sub('', self._text).replace('\r\n', '\n').split('\n')
        return '\n'.join(line.rstrip('\r').rpartition('\r')[2] for line in lines[-ROWS:])

    @property
    def status(self):
        """Exit status of the last command, None while it runs. In a new terminal: 0 when the shell is ready."""
        report = STATUS.search(self._text, self._typed)
        return int(report[1]) if report else None

    def type(self, command):
        """Type a command and Return."""
        self._typed = len(self._text)
        os.write(self.master, command.encode() + b'\n')

    def interrupt(self):
        """Press Ctrl-C."""
        os.write(self.master, b'\x03')

    def close(self):
        """Kill the shell."""
        self.shell.kill()
        self.shell.wait()
        # a process that the shell left running keeps the terminal open, and the reader keeps waiting
        self._reader.join(5)
        if not self._reader.is_alive():
            os.close(self.master)
