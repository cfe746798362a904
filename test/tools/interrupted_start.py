#!/usr/bin/python3
"""Ctrl-C while modules are being imported stops a script immediately and without a traceback."""
import fcntl
import os
import signal
import subprocess

import support

F_SETPIPE_SZ = 1031     # defined in fcntl since Python 3.10


class TestInterruptedStart(support.Case):
    def interrupt(self, name):
        """Interrupt an executable while it imports modules; return its exit status and its output after that."""
        # Python writes a line for each imported module. If the lines are not read, it blocks as soon as the pipe is
        # full, after about 50 of more than 300 modules.
        read_end, write_end = os.pipe()
        fcntl.fcntl(write_end, F_SETPIPE_SZ, 4096)
        process = subprocess.Popen(['rosrun', 'rbx1_nav', name], stdout=write_end, stderr=write_end,
                                   env=dict(os.environ, PYTHONPROFILEIMPORTTIME='1'))
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        os.close(write_end)
        with open(read_end, 'rb', buffering=0) as lines:
            while not lines.readline().rstrip().endswith(b'rbx1_nav.node.early_interrupt'):
                self.assertIsNone(process.poll())
            process.send_signal(signal.SIGINT)
            return process.wait(support.LIMIT), lines.read().decode()

    def test_interrupt(self):
        status, rest = self.interrupt('timed_out_and_back.py')
        self.assertEqual(status, -signal.SIGINT, rest)
        self.assertNotIn('Traceback', rest)


if __name__ == '__main__':
    support.main(TestInterruptedStart)
