#!/usr/bin/python3
"""The error about a frame that does not exist lists the existing frames; an angle that looks like degrees is named."""
from geometry_msgs.msg import Twist

import support


class TestUnknownFrame(support.Case):
    def test_odom_frame(self):
        support.OdomWatch()
        commands = support.Watch('/cmd_vel', Twist)
        # long enough for the static transforms to arrive
        driver = support.by_odometry('_odom_frame:=odom_combine', '_wait_timeout:=5')
        self.assertEqual(driver.wait(), 1, driver.output)
        error, = [line for line in driver.lines if '[ERROR]' in line]
        self.assertRegex(error, r"\[ERROR\].*: Timed out after 5 s waiting for the robot's pose: There is "
                                'no transform from odom_combine to base_footprint or base_link; '
                                'frames that exist: base_footprint, base_l_wheel_link, base_link, .*, odom$')
        self.assertFalse([command for command in commands.messages if command != Twist()])

    def test_combined_frame_without_filter_and_angle_in_degrees(self):
        driver = support.by_odometry('_odom_frame:=odom_combined', '_goal_angle:=180', '_wait_timeout:=5')
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertRegex(driver.output, r'\[ERROR\].*To start the filter that publishes odom_combined: '
                                        r'roslaunch rbx1_bringup odom_ekf\.launch\n')
        self.assertIn('/out_and_back/goal_angle: 180: 28.6 turns, because the unit is radians. '
                      'For 180 degrees: _goal_angle:=3.14159', driver.output)


if __name__ == '__main__':
    support.main(TestUnknownFrame)
