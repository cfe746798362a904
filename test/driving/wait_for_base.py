#!/usr/bin/python3
"""The driver waits for all live listeners, names those that do not answer, and gives up when there is no base."""
import signal
import unittest

import rospy
from geometry_msgs.msg import Twist

import support


class TestWaitForBase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('wait_for_base')

    def start(self, *arguments):
        process = support.out_and_back(*arguments)
        self.addCleanup(process.kill)
        return process

    def listen(self):
        heard = support.Watch('/cmd_vel', Twist)
        self.addCleanup(heard.subscriber.unregister)
        return heard

    def base(self, name):
        rospy.set_param(name, {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26}}})
        process = support.Process('rosrun', 'rbx1_nav', 'fake_base.py', '__name:=' + name)
        self.addCleanup(process.kill)
        process.wait_for_line('at the origin')
        return process

    def test_gives_up_without_a_base(self):
        self.addCleanup(rospy.delete_param, '/out_and_back')    # or the next driver finds it too
        driver = self.start('_wait_timeout:=1')
        self.assertNotEqual(driver.wait(), 0)
        self.assertRegex(driver.output, r'Waited 1 s in vain for a base to listen on /cmd_vel')
        self.assertNotIn('Traceback', driver.output)

    def test_waits_and_then_drives(self):
        driver = self.start()
        driver.wait_for_line('Waiting for a base to listen on /cmd_vel')
        heard = self.listen()
        driver.wait_for_line('forward: 1.00 m')
        driver.signal(signal.SIGTERM)
        driver.wait()
        # the very first command was heard
        self.assertEqual(heard.messages[0].linear.x, 0.2)

    def test_names_and_skips_a_frozen_listener(self):
        frozen = self.base('frozen')
        frozen.signal(signal.SIGSTOP)
        # it ends as a node should, so that the master forgets it
        self.addCleanup(frozen.wait)
        self.addCleanup(frozen.signal, signal.SIGTERM)
        self.addCleanup(frozen.signal, signal.SIGCONT)
        heard = self.listen()
        driver = self.start()
        driver.wait_for_line(r'/frozen is registered as a subscriber of /cmd_vel but does not answer: skipped')
        driver.wait_for_line('forward: 1.00 m')
        support.wait_for(lambda: heard.messages, 'a command')
        driver.signal(signal.SIGTERM)
        driver.wait()


if __name__ == '__main__':
    support.main('wait_for_base', TestWaitForBase)
