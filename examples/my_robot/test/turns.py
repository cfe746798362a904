#!/usr/bin/env python3
"""The driver, which never exits, turns at 1 m and at the start."""
import subprocess
import unittest

import rospy
import rostest
from nav_msgs.msg import Odometry

TURNS = 4


def find_turns():
    """Run the driver until it has turned so many times; return the x of these places, m."""
    rospy.init_node('turns')
    rospy.wait_for_message('/odom', Odometry)
    turns, last = [], []

    def on_pose(message):
        x, speed = message.pose.pose.position.x, message.twist.twist.linear.x
        if last and last[1] * speed < 0:    # the step before was the last one in the other direction
            turns.append(last[0])
        last[:] = x, speed
    # no queue size: no message is left out
    rospy.Subscriber('/ground_truth', Odometry, on_pose)
    driver = subprocess.Popen(['rosrun', 'my_robot', 'patrol.py'])
    try:
        while len(turns) < TURNS and driver.poll() is None:
            rospy.sleep(0.1)
    finally:
        driver.kill()       # a driver may ignore any other signal
        driver.wait()
    return turns[:TURNS]


class TestTurns(unittest.TestCase):
    def test_turns(self):
        try:
            turns = find_turns()
        except KeyboardInterrupt:
            self.fail('the base has exited, or the time limit has passed: see the output of the base')
        self.assertEqual(len(turns), TURNS)
        for found, expected in zip(turns, [1, 0] * TURNS):
            self.assertAlmostEqual(found, expected, delta=1e-6)


if __name__ == '__main__':
    rostest.rosrun('my_robot', 'turns', TestTurns)
