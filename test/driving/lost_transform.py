#!/usr/bin/python3
"""Nobody tells where the robot is: the driver stops it and says so, goes on when it is told again, and gives up in time."""
import os
import signal
import unittest

from geometry_msgs.msg import Twist

import support


class TestLostTransform(unittest.TestCase):
    def setUp(self):
        support.init_node('lost_transform')
        self.odom = support.OdomWatch()
        self.base = support.pid_of('/arbotix')
        self.addCleanup(os.kill, self.base, signal.SIGCONT)
        self.commands = support.Watch('/cmd_vel', Twist)
        self.addCleanup(self.commands.subscriber.unregister)

    def freeze_base(self, *arguments):
        """Let the robot drive by odometry, and its base fall silent; returns the driver when it has noticed."""
        driver = support.by_odometry('_linear_speed:=0.1', *arguments)
        self.addCleanup(driver.kill)
        self.odom.wait_for_twist(0.1)
        os.kill(self.base, signal.SIGSTOP)
        driver.wait_for_line(r'\[WARN\].*transform from odom to base_footprint is .* old.*waits')
        support.wait_for(lambda: self.commands.last.linear.x == 0, 'a stop')
        return driver

    def test_it_gives_up(self):
        driver = self.freeze_base('_transform_timeout:=1')
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[ERROR]' in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertIn('Waited 1 s in vain', errors[0])
        self.assertNotIn('Traceback', driver.output)
        moving = [command.linear.x != 0 for command in self.commands.messages]
        self.assertFalse(any(moving[moving.index(False):]), 'commands to move after the stop')

    def test_it_goes_on(self):
        driver = self.freeze_base('_transform_timeout:=60', '_goal_distance:=0.3')
        os.kill(self.base, signal.SIGCONT)
        self.assertEqual(driver.wait(), 0, driver.output)
        self.assertIn('turn left', driver.output)

    def test_there_never_was_one(self):
        driver = support.by_odometry('_odom_frame:=nowhere', '_wait_timeout:=1')
        self.addCleanup(driver.kill)
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertIn('no transform from nowhere to base_footprint or base_link', driver.output)
        self.assertFalse([command for command in self.commands.messages if command.linear.x])


if __name__ == '__main__':
    support.main('lost_transform', TestLostTransform)
