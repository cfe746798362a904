#!/usr/bin/python3
"""A node is killed or hangs in motion: its guardian stops the robot. Without a guardian the node starts another."""
import os
import re
import signal
import unittest

from driven import DrivenRobot
import support


def guardian_of(node):
    """The process id of the guardian of a node that runs under rosrun."""
    pid = support.pid_of('/turtlebot_node')
    with open('/proc/%d/task/%d/children' % (pid, pid), encoding='ascii') as file:
        children = file.read().split()
    for thread in os.listdir('/proc/%d/task' % pid):
        with open('/proc/%d/task/%s/children' % (pid, thread), encoding='ascii') as file:
            children += file.read().split()
    for child in children:
        with open('/proc/%s/cmdline' % child, encoding='ascii', errors='replace') as file:
            if 'guardian' in file.read():
                return int(child)
    raise AssertionError('no guardian among %s: %s' % (children, node.output))


class TestCreateKilled(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('create_killed')

    def test_kill(self):
        robot = DrivenRobot(self, 'create')
        kills = [lambda node: os.kill(support.pid_of('/turtlebot_node'), signal.SIGKILL),
                 lambda node: os.killpg(node.process.pid, signal.SIGKILL)]
        for kill in kills:
            robot.wait_for_motion()
            count = len(robot.received())
            kill(robot.node)
            robot.wait_for_stop(count)
            robot.node.wait()
            # another node takes over
            robot.node = robot.start_node(_robot_type='create')
            robot.node.wait_for_line('in safe mode')

    def test_hang(self):
        robot = DrivenRobot(self, 'create2')
        robot.wait_for_motion()
        count = len(robot.received())
        pid = support.pid_of('/turtlebot_node')
        os.kill(pid, signal.SIGSTOP)
        robot.wait_for_stop(count)
        os.kill(pid, signal.SIGCONT)
        robot.wait_for_standstill()
        robot.wait_for_motion()

        # the node needs its guardian
        guardian = guardian_of(robot.node)
        os.kill(guardian, signal.SIGKILL)
        robot.node.wait_for_line('The guardian process is gone: starting another')
        support.wait_for(lambda: guardian_of(robot.node) != guardian, 'another guardian')
        robot.wait_for_motion()
        count = len(robot.received())
        os.kill(pid, signal.SIGKILL)
        robot.wait_for_stop(count)
        self.assertFalse(re.search('Traceback', robot.node.output))


if __name__ == '__main__':
    support.main('create_killed', TestCreateKilled)
