#!/usr/bin/python3
"""examples/turn_at_bump.py backs up and turns away from a bump, drives on, and stops on Ctrl-C."""
import os
import signal

import rospkg

from driven import DrivenRobot
import support

SCRIPT = os.path.join(rospkg.RosPack().get_path('rbx1_nav'), 'examples', 'turn_at_bump.py')
LEFT, RIGHT = 2, 1      # bits of the bumpers


class TestTurnAtBump(support.Case):
    def test_turn_at_bump(self):
        robot = DrivenRobot(self, 'create2')
        script = support.Process('/usr/bin/python3', SCRIPT)

        def wait_for(condition, what):
            support.wait_for(lambda: condition(robot.truth.last.twist.twist), f'{what}; the script: {script.output}')
        for bit, sign in (LEFT, -1), (RIGHT, 1), (LEFT | RIGHT, -1):
            wait_for(lambda twist: twist.linear.x > 0.09, 'the robot to drive forward')
            robot.publish('switches', bit)
            wait_for(lambda twist: twist.linear.x < -0.09, 'the robot to back up')
            robot.publish('switches', 0)
            wait_for(lambda twist, side=sign: twist.angular.z * side > 0.9, 'the robot to turn away')
        wait_for(lambda twist: twist.linear.x > 0.09, 'the robot to drive on')
        script.signal(signal.SIGINT)
        self.assertEqual(script.wait(), 128 + signal.SIGINT, script.output)
        robot.wait_for_standstill()
        self.assertNotIn('refused', robot.node.output)


if __name__ == '__main__':
    support.main(TestTurnAtBump)
