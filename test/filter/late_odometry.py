#!/usr/bin/python3
"""The filter waits for odometry that is always later than ~sensor_timeout: the estimate is late but right."""
from collections import deque
import math

import rospy

from altered import AlteredRobot
import support

LAG = rospy.Duration(1.5)


class LateRobot(AlteredRobot):
    """A robot whose odometry is passed on after LAG of simulated time."""

    def __init__(self):
        self.waiting = deque()
        super().__init__()

    def _pass_on(self, message, where):
        publisher, _ = where
        if publisher.resolved_name != '/odom_altered':
            publisher.publish(message)
            return
        self.waiting.append(message)
        while message.header.stamp - self.waiting[0].header.stamp >= LAG:
            publisher.publish(self.waiting.popleft())


class TestLateOdometry(support.Case):
    def test_it_is_waited_for(self):
        robot = LateRobot()
        support.wait_for(lambda: len(robot.estimates.messages) > 60, 'two seconds of the filter')
        for linear, angular in ((0.2, 0.0), (0.2, 0.0), (0.1, 1.0)):
            robot.commander.send(linear, angular)
            support.wait_for(lambda: robot.odom.last.twist.twist.linear.x > 0.05, 'the robot to drive')
            robot.odom.wait_for_twist(0.0)
        end = robot.odom.next().header.stamp
        support.wait_for(lambda: robot.estimates.last.header.stamp > end, 'the estimate of the end pose')
        x, y, yaw = support.pose(robot.truth.last)
        estimate = support.pose(robot.estimates.last)
        self.assertGreater(x, 0.3)
        # 0.5 m on carpet: five standard deviations
        self.assertLess(math.hypot(estimate[0] - x, estimate[1] - y), 0.15)
        self.assertLess(abs(support.wrapped(estimate[2] - yaw)), math.radians(3))
        self.assertEqual(robot.lines('timed out'), [])


if __name__ == '__main__':
    support.main(TestLateOdometry)
