"""SIGKILL to the base node of an emulated Create in motion."""
import contextlib
import os
import signal
import sys
import time
import unittest

import rospy

import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', '..', 'create'))
from driven import STOP, DrivenRobot, guardian_of

FAULT = ("SIGKILL to a Create's base node, or to its process group, at a random moment of a motion; in a third of the "
         "cases, also to its guardian 50 to 100 ms earlier, and in another third 100 to 200 ms later")
PROMISE = 'a stop reaches the robot within 0.2 s'
FULL, SHORT = 30, 3
ROOT = False
ALONE = True    # it measures a duration

LIMIT = 0.2     # s


def kill(row, robot, seconds, group, gap):
    """One fault, in motion; then another node takes over. gap: s from the guardian's death to the node's; negative if
    the node dies first; 0 if the guardian is not killed."""
    end = time.monotonic() + seconds
    robot.drive(0.2, 0.3, lambda: time.monotonic() > end and robot.moving, 'the robot to move')
    count = len(robot.received())
    pid = support.pid_of('/turtlebot_node')
    guardian = guardian_of(pid)
    killed = rospy.get_time()
    if gap > 0:
        os.kill(guardian, signal.SIGKILL)
        time.sleep(gap)
    if group:
        os.killpg(robot.node.process.pid, signal.SIGKILL)
    else:
        os.kill(pid, signal.SIGKILL)
    if gap < 0:
        time.sleep(-gap)
        with contextlib.suppress(ProcessLookupError):
            os.kill(guardian, signal.SIGKILL)
    if gap == 0:
        robot.wait_for_stop(count)
    robot.wait_for_standstill()
    delay = robot.wait_for_command(count, lambda stamp, data: data == STOP and stamp > killed)[0] - killed
    row.figure('stop after (s)', delay)
    assert delay < LIMIT, f'{delay:.3f} s'
    robot.node.wait()
    robot.node = robot.start_node()
    robot.node.wait_for_line('in safe mode')


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for robot_type in ('create', 'create2'):
        case = unittest.TestCase()
        robot = DrivenRobot(case, robot_type)
        for index in range((row.times + 1) // 2):
            seconds, group = row.random.uniform(0.2, 2), row.random.random() < 0.5
            # shorter gaps may leave no process that stops the robot: see docs/decisions/create_guardian.md
            gap = (0, row.random.uniform(0.05, 0.1), -row.random.uniform(0.1, 0.2))[index % 3]
            with row.fault('%s: SIGKILL to the %s after %.3f s%s' % (
                    robot_type, 'group' if group else 'node', seconds,
                    ', %.1f ms after its guardian' % (1000 * gap) if gap else '')):
                kill(row, robot, seconds, group, gap)
        case.doCleanups()
