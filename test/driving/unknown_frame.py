#!/usr/bin/python3
"""A frame that does not exist is named with those that do."""
import unittest

from geometry_msgs.msg import Twist

import support


class TestUnknownFrame(unittest.TestCase):
    def test_odom_frame(self):
        support.init_node('unknown_frame')
        support.OdomWatch()
        commands = support.Watch('/cmd_vel', Twist)
        # long enough for the static transforms to arrive, too
        driver = support.by_odometry('_odom_frame:=odom_combine', '_wait_timeout:=5')
        self.addCleanup(driver.kill)
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertRegex(driver.lines[-1], r"\[ERROR\].*: Timed out after 5 s waiting for the robot's pose: There is "
                                           'no transform from odom_combine to base_footprint or base_link; '
                                           'frames that exist: base_footprint, base_l_wheel_link, base_link, .*, odom$')
        self.assertFalse([command for command in commands.messages if command != Twist()])


if __name__ == '__main__':
    support.main('unknown_frame', TestUnknownFrame)
