#!/usr/bin/python3
"""When the base dies in mid-motion the driver says so and ends with an error."""
import signal
import unittest

from geometry_msgs.msg import Twist

import support


class TestLostListener(unittest.TestCase):
    def test_lost(self):
        support.init_node('lost_listener')
        listener = support.Process('rostopic', 'echo', '/cmd_vel')
        self.addCleanup(listener.kill)
        driver = support.out_and_back('_linear_speed:=0.01')
        self.addCleanup(driver.kill)
        driver.wait_for_line('forward: 1.00 m')
        listener.wait_for_line('x: 0.01')
        listener.signal(signal.SIGKILL)
        self.assertNotEqual(driver.wait(), 0)
        self.assertIn('Nobody listens on /cmd_vel any more', driver.output)
        self.assertIn('Stopping the robot...', driver.output)
        self.assertNotIn('Traceback', driver.output)


if __name__ == '__main__':
    support.main('lost_listener', TestLostListener)
