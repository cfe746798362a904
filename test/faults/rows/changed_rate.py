"""Another process changes the rate of a Create's port while the robot drives."""
import os
import signal
import subprocess
import sys
import time

import support

sys.path.append(os.path.join(os.path.dirname(__file__), '..', '..', 'create'))
from driven import CHI_SQUARE, IDEAL, DrivenRobot

FAULT = ("`stty` changes the baud rate of a Create's port at a random moment of a motion; half of the nodes receive "
         "SIGTERM immediately afterwards")
PROMISE = ('the rate is restored and the change is reported; the node stops the robot and exits with 0; the odometry '
           'includes the motion in between')
FULL, SHORT = 20, 2
ROOT = ALONE = False

RATES = (1200, 9600, 19200, 38400, 57600, 115200)


def change(row, case, robot_type, seconds, rate, at_once):
    """One fault."""
    robot = DrivenRobot(case, robot_type, **IDEAL)
    end = time.monotonic() + seconds
    robot.drive(0.2, 0.3, lambda: time.monotonic() > end and robot.moving, 'the robot to move')
    count = len(robot.received())
    subprocess.run(['stty', '-F', robot.link, str(rate)], check=True)
    changed = time.monotonic()
    if not at_once:
        robot.node.wait_for_line('another process has changed the rate to %d baud' % rate)
        row.figure('restored after (s)', time.monotonic() - changed)
        robot.commander.send(0.0, 0.0)
        robot.wait_for_status('Stationary')
        error = robot.normalized_error()
        row.figure('normalized squared error', error)
        assert error < CHI_SQUARE, f'squared error {error:.1f} of {robot.error()}'
        robot.wait_for_motion()
        count = len(robot.received())
    robot.node.signal(signal.SIGTERM)
    assert robot.node.wait() == 0, robot.node.output
    robot.wait_for_stop(count)


def run(row):
    """See FAULT. A robot of its own for each, so that the errors are independent."""
    row.roscore()
    support.init_node('faults')
    for index in range(row.times):
        robot_type = ('create', 'create2')[index // 2 % 2]
        own = {'create': 57600, 'create2': 115200}[robot_type]
        rate = row.random.choice([each for each in RATES if each != own])
        seconds, at_once = row.random.uniform(0.2, 2), bool(index % 2)
        with row.case('%s: %d baud after %.3f s%s' % (robot_type, rate, seconds, ', and SIGTERM' * at_once)) as case:
            change(row, case, robot_type, seconds, rate, at_once)
