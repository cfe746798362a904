"""SIGKILL to the base node of an emulated Create in motion."""
import os
import signal
import sys
import time
import unittest

import rospy

import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', '..', 'create'))
from driven import STOP, DrivenRobot    # noqa: E402, pylint: disable=wrong-import-position

FAULT = "SIGKILL to a Create's base node, or to its process group, at a random moment of a motion"
PROMISE = 'a stop is on the line within 0.2 s'
FULL, SHORT = 20, 2
ROOT = False
ALONE = True    # it measures a duration

LIMIT = 0.2     # s


def kill(row, robot, seconds, group):
    """One fault, in motion; then another node takes over."""
    end = time.monotonic() + seconds
    robot.drive(0.2, 0.3, lambda: time.monotonic() > end and robot.moving, 'the robot to move')
    count = len(robot.received())
    pid = support.pid_of('/turtlebot_node')
    killed = rospy.get_time()
    if group:
        os.killpg(robot.node.process.pid, signal.SIGKILL)
    else:
        os.kill(pid, signal.SIGKILL)
    robot.wait_for_stop(count)
    delay = next(stamp for stamp, data in robot.received()[count:] if data == STOP and stamp > killed) - killed
    row.figure('stop after, s', delay)
    assert delay < LIMIT, '%.3f s' % delay
    robot.node.wait()
    robot.node = robot.start_node(_robot_type=robot.model.name)
    robot.node.wait_for_line('in safe mode')


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for robot_type in ('create', 'create2'):
        case = unittest.TestCase()
        robot = DrivenRobot(case, robot_type)
        for _ in range((row.times + 1) // 2):
            seconds, group = row.random.uniform(0.2, 2), row.random.random() < 0.5
            with row.fault('%s: SIGKILL to the %s after %.3f s' % (robot_type, 'group' if group else 'node', seconds)):
                kill(row, robot, seconds, group)
        case.doCleanups()
