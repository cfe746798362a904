#!/usr/bin/python3
"""examples/keyboard.py drives the robot by the keys typed in its terminal, and restores the terminal on Ctrl-C."""
import os
import pty
import subprocess
import termios
import unittest

import rospkg

import support

KEYBOARD = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'examples', 'keyboard.py')


class TestKeyboardDriving(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('keyboard_driving')
        cls.odom = support.OdomWatch()

    def setUp(self):
        self.ours, its = pty.openpty()
        self.addCleanup(os.close, self.ours)
        self.addCleanup(os.close, its)
        self.terminal = its
        self.before = termios.tcgetattr(its)
        # a session of its own, whose terminal is the new one: Ctrl-C typed in it is sent to the script
        self.process = subprocess.Popen(['setsid', '-c', '-w', '/usr/bin/python3', KEYBOARD], stdin=its, stdout=its,
                                        stderr=its)
        self.addCleanup(self.process.wait)
        self.addCleanup(self.process.kill)
        support.wait_for(lambda: not termios.tcgetattr(its)[3] & termios.ICANON, 'a terminal that passes on each key')

    def type(self, keys):
        os.write(self.ours, keys)

    def test_each_key(self):
        for keys, linear, angular in [(b'i', 0.2, 0.0), (b'j', 0.0, 1.0), (b'\x1b[C', 0.0, -1.0), (b',', -0.2, 0.0),
                                      (b'\x1b[A', 0.2, 0.0), (b' ', 0.0, 0.0), (b'lllli', 0.2, 0.0)]:
            self.type(keys)
            self.odom.wait_for_twist(linear, angular)

    def test_ctrl_c(self):
        self.type(b'i')
        self.odom.wait_for_twist(0.2)
        self.type(b'\x03')
        self.assertEqual(self.process.wait(support.LIMIT), 0)
        self.odom.wait_for_twist(0.0)
        self.assertEqual(termios.tcgetattr(self.terminal), self.before)


if __name__ == '__main__':
    support.main('keyboard_driving', TestKeyboardDriving)
