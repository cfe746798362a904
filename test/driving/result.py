#!/usr/bin/python3
"""Each driving script logs its result: the timed script what it commanded, the odometry-based script the end pose."""
import math

import rospy

import support


class TestResult(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()

    def tearDown(self):
        rospy.delete_param('/out_and_back')     # the next test must not find it

    def last_line(self, driver):
        self.assertEqual(driver.wait(), 0, driver.output)
        return driver.lines[-1]

    def test_by_time(self):
        self.assertRegex(self.last_line(support.out_and_back('_goal_distance:=0.5')),
                         r'^\[INFO\] .*: Done: commanded 1\.00 m forward and 6\.28 rad to the left\. '
                         r'The longest delay of a command was 0 ms\. '
                         r'To see where the robot is now, run: rosrun rbx1_nav pose.py$')

    def test_by_odometry(self):
        # not at the origin, and with half a turn, so that the end pose differs from the start pose
        start = support.pose(self.odom.last)
        driver = support.by_odometry('_goal_distance:=0.5', '_goal_angle:=2.0')
        line = self.last_line(driver)
        self.assertIn('Measuring the pose of base_footprint in the frame odom', driver.output)
        end = support.pose(self.odom.next())
        distance = math.hypot(end[0] - start[0], end[1] - start[1])
        turned = math.degrees(abs(support.wrapped(end[2] - start[2])))
        self.assertGreater(distance, 0.1)
        self.assertGreater(turned, 100)
        self.assertIn('Measured in odom, the robot is %.3f m from its start and %.1f degrees off its initial heading'
                      % (distance, turned), driver.output)
        self.assertIn(': Done. To see where the robot is now, run: rosrun rbx1_nav pose.py', line)


if __name__ == '__main__':
    support.main(TestResult)
