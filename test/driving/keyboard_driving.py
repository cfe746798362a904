#!/usr/bin/python3
"""examples/keyboard.py drives the robot by the keys typed in its terminal, and restores the terminal on Ctrl-C.

Without a terminal, it exits with a one-line error. When the terminal is closed, it stops the robot.
"""
import os
import pty
import signal
import subprocess
import termios

import rospkg

import support

KEYBOARD = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'examples', 'keyboard.py')
UP, DOWN, RIGHT, LEFT = (b'\x1b[' + key for key in (b'A', b'B', b'C', b'D'))


class TestKeyboardDriving(support.Case):
    def setUp(self):
        self.odom = support.OdomWatch()
        ours, self.terminal = pty.openpty()
        self.ours = open(ours, 'wb', buffering=0)
        self.addCleanup(self.ours.close)
        self.addCleanup(os.close, self.terminal)
        self.before = termios.tcgetattr(self.terminal)
        # a session of its own, whose terminal is the new one: Ctrl-C typed in it is sent to the script
        self.process = subprocess.Popen(['setsid', '-c', '-w', '/usr/bin/python3', KEYBOARD], stdin=self.terminal,
                                        stdout=self.terminal, stderr=self.terminal)
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        support.wait_for(lambda: not termios.tcgetattr(self.terminal)[3] & termios.ICANON, 'each key at once')

    def test_each_key(self):
        for keys, linear, angular in [(UP, 0.2, 0.0), (LEFT, 0.0, 1.0), (RIGHT, 0.0, -1.0), (DOWN, -0.2, 0.0),
                                      (UP, 0.2, 0.0), (b'A', 0.0, 0.0), (4 * LEFT + UP, 0.2, 0.0)]:
            self.ours.write(keys)
            self.odom.wait_for_twist(linear, angular)

    def test_ctrl_c(self):
        self.ours.write(UP)
        self.odom.wait_for_twist(0.2)
        self.ours.write(b'\x03')
        self.assertEqual(self.process.wait(support.LIMIT), 128 + signal.SIGINT)
        self.odom.wait_for_twist(0.0)
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)

    def test_closed_terminal(self):
        self.ours.write(UP)
        self.odom.wait_for_twist(0.2)
        self.ours.close()
        self.assertEqual(self.process.wait(support.LIMIT), 128 + signal.SIGHUP)
        self.odom.wait_for_twist(0.0)

    def test_without_a_terminal(self):
        result = subprocess.run(['/usr/bin/python3', KEYBOARD, '__name:=piped'], stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, timeout=support.LIMIT)
        self.assertEqual(result.returncode, 1)
        lines = (result.stdout + result.stderr).splitlines()
        self.assertEqual(len(lines), 1, lines)
        self.assertIn('expected a terminal as standard input', lines[0])


if __name__ == '__main__':
    support.main(TestKeyboardDriving)
