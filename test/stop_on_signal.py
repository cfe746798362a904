#!/usr/bin/python3
"""Ctrl-C, kill and a closed terminal in mid-motion: the robot stops, nothing follows, both lines are said."""
import signal
import subprocess
import unittest

import psutil
from geometry_msgs.msg import Twist

import support


class TestStopOnSignal(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('stop_on_signal')
        cls.odom = support.OdomWatch()

    def check(self, end):
        commands = support.Watch('/cmd_vel', Twist)
        # slow, so that the motion lasts until it is ended
        driver = support.out_and_back('_linear_speed:=0.01')
        self.addCleanup(driver.kill)
        self.odom.wait_for_twist(0.01)
        end(driver)
        self.assertEqual(driver.wait(), 0, driver.output)

        self.assertIn('Stopping the robot...', driver.output)
        self.assertIn('Out-and-Back node terminated.', driver.output)
        self.assertNotIn('Traceback', driver.output)
        moves = [m.linear.x != 0 for m in commands.messages]
        self.assertEqual(moves[-2:], [True, False], 'one stop after the last command, and nothing after that')
        self.odom.wait_for_twist(0.0)
        commands.subscriber.unregister()

    def test_sigint(self):
        self.check(lambda driver: driver.signal(signal.SIGINT))

    def test_sigterm(self):
        self.check(lambda driver: driver.signal(signal.SIGTERM))

    def test_sighup(self):
        self.check(lambda driver: driver.signal(signal.SIGHUP))

    def test_rosnode_kill(self):
        self.check(lambda driver: subprocess.run(['rosnode', 'kill', '/out_and_back'], check=True))

    def test_sigint_while_the_master_is_frozen(self):
        masters = [p for p in psutil.process_iter() if 'rosmaster' in ' '.join(p.cmdline())
                   and any(c.laddr.port == self.master_port() for c in p.connections() if c.status == 'LISTEN')]
        self.assertEqual(len(masters), 1)
        self.addCleanup(masters[0].resume)

        def end(driver):
            masters[0].suspend()
            driver.signal(signal.SIGINT)
        self.check(end)

    @staticmethod
    def master_port():
        import rosgraph
        return int(rosgraph.get_master_uri().rstrip('/').rsplit(':', 1)[1])


if __name__ == '__main__':
    support.main('stop_on_signal', TestStopOnSignal)
