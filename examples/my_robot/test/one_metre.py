#!/usr/bin/env python3
"""The driver moves the robot by 1 m."""
import subprocess
import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry


def drive():
    """Run the driver, and return the robot's true pose and velocity afterwards."""
    # disable_signals: rospy would not interrupt subprocess.run when roslaunch stops this node
    rospy.init_node('one_metre', disable_signals=True)
    # the base is ready when it publishes
    rospy.wait_for_message('/odom', Odometry)
    # returns when the driver has exited; raises CalledProcessError if its status is not 0
    subprocess.run(['rosrun', 'my_robot', 'drive.py'], check=True)
    return rospy.wait_for_message('/ground_truth', Odometry)


class TestOneMetre(unittest.TestCase):
    def test_end(self):
        try:
            end = drive()
        except KeyboardInterrupt:
            # roslaunch stops all nodes when the base has exited: without this line, rostest counts 0 tests and succeeds
            self.fail('the base has exited, or the time limit has passed: see the output of the base')
        self.assertEqual(end.twist.twist.linear.x, 0)
        self.assertAlmostEqual(end.pose.pose.position.x, 1, delta=1e-6)
        self.assertAlmostEqual(end.pose.pose.position.y, 0, delta=1e-6)


if __name__ == '__main__':
    rostest.rosrun('my_robot', 'one_metre', TestOneMetre)
