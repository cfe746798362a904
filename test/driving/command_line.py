#!/usr/bin/python3
"""A command line with a mistake does not move the robot; remappings and node names are accepted."""
import rospy
from geometry_msgs.msg import Twist

import support

MISTAKES = {'goal_distance:=0.1': 'this remaps a topic: did you mean _goal_distance:=0.1?',
            '_goal_distanc:=0.1': 'unknown parameter: did you mean _goal_distance:=0.1?',
            '_goal_distance=0.1': 'unknown argument: did you mean _goal_distance:=0.1?'}


class TestCommandLine(support.Case):
    def test_mistakes(self):
        commands = support.Watch('/cmd_vel', Twist)
        for start in support.out_and_back, support.by_odometry:
            for argument, problem in MISTAKES.items():
                driver = start(argument)
                self.assertEqual(driver.wait(), 2, driver.output)
                self.assertTrue(driver.lines[-1].endswith(f'.py: error: {argument}: {problem}'), driver.output)
        self.assertEqual(commands.messages, [])
        self.assertFalse(rospy.has_param('/out_and_back'))

    def test_a_remapping_and_a_name(self):
        commands = support.Watch('/other/cmd_vel', Twist)
        support.out_and_back('/cmd_vel:=/other/cmd_vel', '__name:=other_name', '_goal_distance:=0.1')
        support.wait_for(lambda: commands.last, 'a command')
        self.assertEqual(rospy.get_param('/other_name/goal_distance'), 0.1)


if __name__ == '__main__':
    support.main(TestCommandLine)
