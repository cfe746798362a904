"""Robots that report their mode plus one, among those that do not."""
import itertools
import os
import sys
import time
import unittest

import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', '..', 'create'))
from driven import DrivenRobot
from rbx1_nav.create.protocol import MODE_NAMES, PASSIVE

FAULT = ('robots that report their mode plus one, and robots that do not, driven in each mode; two thirds of those in '
         'safe mode start with a wheel dropped or on the dock')
PROMISE = 'a robot in safe or full mode obeys, and a robot in passive mode is never reported to be in another mode'
FULL, SHORT = 36, 4
ROOT = ALONE = False

CASES = list(itertools.product(('create', 'create2'), (True, False), (1, 2, 3), ('', 'drop_wheel', 'dock')))


def try_to_drive(robot, seconds):
    """Repeat a command for a while. Returns whether the robot has moved."""
    end, moved = time.monotonic() + seconds, False
    while time.monotonic() < end:
        robot.commander.send(0.2, 0.0)
        time.sleep(0.02)
        moved = moved or robot.moving
    robot.commander.send(0.0, 0.0)
    robot.wait_for_standstill()
    return moved


def check(case, robot_type, plus_one, mode, obstacle):
    """One fault."""
    # the robot's own stop at an obstacle is part of safe mode
    obstacle = obstacle if mode == 2 else ''
    robot = DrivenRobot(case, robot_type, dict(mode_plus_one=plus_one), obstacle, operation_mode=mode)
    if obstacle:
        robot.wait_for_status('Not driven')
        assert not try_to_drive(robot, 1), 'the robot moves'
        robot.wait_for_mode('passive')
        robot.switch(obstacle, False)
    robot.wait_for_mode(MODE_NAMES[mode])
    assert try_to_drive(robot, 1) == (mode != PASSIVE), robot.node.output
    assert ('reports its mode plus one' in robot.node.output) == plus_one, robot.node.output
    assert robot.value('Serial line', 'Corrupted readings') == '0'


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    cases = row.random.sample(CASES, len(CASES))
    for index in range(row.times):
        robot_type, plus_one, mode, obstacle = cases[index % len(cases)]
        case = unittest.TestCase()
        with row.fault('%s, plus one: %s, operation_mode %d, %s' % (
                robot_type, plus_one, mode, obstacle or 'no obstacle')):
            try:
                check(case, robot_type, plus_one, mode, obstacle)
            finally:
                case.doCleanups()
