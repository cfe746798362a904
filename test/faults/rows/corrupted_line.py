"""1 % of the bytes from an emulated Create 2 are corrupted for a whole run."""
import os
import sys
import unittest

import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', '..', 'create'))
from driven import DrivenRobot    # noqa: E402, pylint: disable=wrong-import-position

FAULT = '1 % of the bytes from a Create 2 flipped, lost or doubled during the exercise'
PROMISE = 'corrupted frames are counted and dropped, and the odometry ends within 5 cm of the truth'
FULL, SHORT = 5, 0
ROOT = ALONE = False

LIMIT = 0.05        # m


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for _ in range(row.times):
        case = unittest.TestCase()
        seed = row.random.randrange(10 ** 6)
        with row.fault('seed %d' % seed):
            try:
                robot = DrivenRobot(case, 'create2', {'corruption': 0.01, 'seed': seed})
                driver = row.node('timed_out_and_back.py')
                assert driver.wait() == 0, driver.output
                x, y, _ = robot.error()
                row.figure('error, m', (x * x + y * y) ** 0.5)
                row.figure('corrupted frames', robot.value('Serial line', 'Corrupted readings'))
                row.figure('implausible readings', robot.value('Serial line', 'Implausible readings'))
                assert (x * x + y * y) ** 0.5 < LIMIT, (x, y)
                assert int(robot.value('Serial line', 'Corrupted readings')) > 100
            finally:
                case.doCleanups()
