"""SIGSTOP to the base node of an emulated Create in motion, and SIGCONT: a stall, or a computer that was suspended."""
import os
import signal
import time

import rospy

import support
from driven import STOP, faults_of_both

FAULT = ("SIGSTOP to a Create's base node for 0.6 or 0.9 s at a random moment of a motion; its driver sends commands "
         'all the time, or stops sending in the middle of the stall')
PROMISE = ('the robot stops when the node continues, and does not drive again before its driver has sent a zero '
           'command or nothing for 0.6 s')
FULL, SHORT = 24, 4
ROOT = False
ALONE = True    # it measures a duration

LIMIT = 0.2         # s from SIGCONT to the stop
OBSERVED = 1.5      # s in which the robot must not move


def check(row, robot, seconds, stall, goes_on):
    """One fault, in motion. seconds: until the stall; goes_on: whether the driver sends commands all the time."""
    with robot.driving(0.2, 0.3) as left:
        time.sleep(seconds)
        assert robot.moving
        pid, count = support.pid_of('/turtlebot_node'), len(robot.received())
        os.kill(pid, signal.SIGSTOP)
        time.sleep(stall / 2)
        if not goes_on:
            left.set()
        time.sleep(stall / 2)
        continued = rospy.get_time()
        os.kill(pid, signal.SIGCONT)
        delay = robot.wait_for_command(count, lambda stamp, data: data == STOP and stamp > continued)[0] - continued
        row.figure('stop after (s)', delay)
        assert delay < LIMIT, f'{delay:.3f} s'
        robot.wait_for_standstill()
        end = time.monotonic() + OBSERVED
        while time.monotonic() < end:
            assert not robot.moving, 'the robot drives on'
    robot.commander.send(0.0, 0.0)
    robot.drive_again()


def run(row):
    """See FAULT."""
    for robot_type, robot, index in faults_of_both(row):
        seconds, stall, goes_on = row.random.uniform(0.2, 1), (0.6, 0.9)[index % 2], index // 2 % 2 == 0
        with row.fault('%s: stalled for %.1f s after %.3f s, its driver %s' % (
                robot_type, stall, seconds, 'goes on' if goes_on else 'stops')):
            check(row, robot, seconds, stall, goes_on)
