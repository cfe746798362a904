#!/usr/bin/python3
"""A subscriber receives every command of the exercise in order, and none after the last stop."""
import itertools

from geometry_msgs.msg import Twist
import rospy

import support


class TestMessageCounts(support.Case):
    def test_commands_of_the_exercise(self):
        odom = support.OdomWatch()
        commands = support.Watch('/cmd_vel', Twist)
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 0, driver.output)

        received = [(m.linear.x, m.angular.z) for m in commands.messages]
        groups = [(command, len(list(same))) for command, same in itertools.groupby(received)]
        forward, turn, stop = (0.2, 0.0), (0.0, 1.0), (0.0, 0.0)
        # there is a stop at the end of the last motion, of the exercise, and of the node
        self.assertEqual(groups, [(forward, 250), (stop, 1), (turn, 157), (stop, 1),
                                  (forward, 250), (stop, 1), (turn, 157), (stop, 3)])

        # no more messages in two seconds of simulated time
        end = odom.last.header.stamp.to_sec() + 2
        support.wait_for(lambda: odom.last.header.stamp.to_sec() > end, 'two seconds of simulated time')
        self.assertEqual(len(commands.messages), len(received))

    def test_a_motion_of_one_tick(self):
        commands = support.Watch('/cmd_vel', Twist)
        self.addCleanup(rospy.delete_param, '/out_and_back')
        # in floating point, 0.02 / 0.2 * 10 is below 1
        driver = support.out_and_back('_rate:=10', '_goal_distance:=0.02', '_goal_angle:=0.1')
        self.assertEqual(driver.wait(), 0, driver.output)
        self.assertEqual([m.linear.x for m in commands.messages if m.linear.x], [0.2, 0.2])


if __name__ == '__main__':
    support.main(TestMessageCounts)
