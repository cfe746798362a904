#!/usr/bin/python3
"""If the port is in use, the node logs one line and waits. With invalid parameters it exits."""
import os
import signal

from driven import DrivenRobot
import support


class TestCreatePort(support.Case):
    def test_two_nodes(self):
        robot = DrivenRobot(self, 'create2')
        pid = support.pid_of('/turtlebot_node')
        second = robot.start_node('__name:=second')
        second.wait_for_line(rf'{robot.link}: in use by another process: expected a port that is not in use')
        # the first node is not disturbed
        robot.wait_for_motion()
        # when the port is free, the second one uses it
        os.kill(pid, signal.SIGINT)
        robot.node.wait()
        second.wait_for_line('in safe mode')

    def test_a_second_node_with_a_bad_parameter(self):
        robot = DrivenRobot(self, 'create2')
        second = robot.start_node(_update_rate='fast')
        self.assertEqual(second.wait(), 1, second.output)
        self.assertIn("/turtlebot_node/update_rate: 'fast': expected a rate from 5 to 60 in Hz", second.output)
        # the first node continues although the names are equal; one motion could be its last command before it exits
        robot.wait_for_motion()
        robot.wait_for_standstill()
        robot.wait_for_motion()


if __name__ == '__main__':
    support.main(TestCreatePort)
