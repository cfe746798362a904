"""Runs one row of the fault suite, in a process of its own: row.py NAME TIMES SEED. The last line is its result.

A row is a module in rows/ with

    FAULT       what is done, for the table
    PROMISE     what is promised
    FULL, SHORT how many faults in the full suite and in its short form (0: none)
    ROOT        whether it needs root
    ALONE       whether it measures durations, so that no other row may run beside it
    run(row)    tries row.times faults; row: a Row
"""
from contextlib import contextmanager
import importlib
import json
import math
import os
import random
import signal
import sys
import time
import traceback
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))
TESTS = os.path.dirname(FOLDER)
sys.path[:0] = [FOLDER, TESTS, os.path.join(TESTS, 'base'), os.path.join(TESTS, 'create')]

import roslib.packages
import rospy
from std_srvs.srv import Empty

from ports import own_loopback
import support


class Row:
    """What a row works with: its faults, its processes, and its figures."""

    def __init__(self, name, times, seed):
        self.name = name
        self.times = times
        self.random = random.Random('%s %d' % (name, seed))
        self.faults = 0
        self.failures = []
        self.figures = {}
        self.processes = []

    @contextmanager
    def fault(self, text):
        """One fault: what is wrong inside, an AssertionError or another error, is a failure of this row."""
        self.faults += 1
        try:
            yield
        except AssertionError as error:
            self.failures.append(f'{text}: {error or traceback.format_exc().splitlines()[-2].strip()}')
        except Exception:
            self.failures.append(f'{text}: {traceback.format_exc(limit=-5)}')

    def figure(self, name, value):
        """A measured value; the table shows the spread of all values of one name."""
        self.figures.setdefault(name, []).append(float(value))

    def start(self, *command, **environment):
        """Start a command as a support.Process, which ends with the row. environment: variables to set."""
        process = support.Process(*command, **environment)
        self.processes.append(process)
        return process

    def roscore(self):
        """Start a master, at the address that this row was given, and wait for it."""
        port = os.environ['ROS_MASTER_URI'].rpartition(':')[2]
        core = self.start('roscore', '-p', port)
        core.wait_for_line('started core service')
        return core

    def base(self, *arguments):
        """Start the simulated base with `name:=value` arguments of its launch file, and wait until it is ready."""
        base = self.start('roslaunch', '--wait', 'rbx1_nav', 'fake_turtlebot.launch', *arguments)
        base.wait_for_line('Ready: ')
        return base

    def node(self, name, *arguments):
        """Start an executable of the package; not by rosrun, a shell script, so that a signal reaches the node."""
        return self.start(roslib.packages.find_node('rbx1_nav', name)[0], *arguments)

    @contextmanager
    def busy(self, loops):
        """Run so many busy loops beside what is inside."""
        processes = [self.start('/bin/sh', '-c', 'while :; do :; done') for _ in range(loops)]
        try:
            yield
        finally:
            for process in processes:
                process.kill()

    @contextmanager
    def case(self, text):
        """One fault, as in fault(); yields a TestCase, for a robot that is stopped at its end."""
        case = unittest.TestCase()
        with self.fault(text):
            try:
                yield case
            finally:
                case.doCleanups()

    @staticmethod
    def reset():
        """Put the robot back at the origin, at rest."""
        rospy.ServiceProxy('/arbotix/reset', Empty)()

    @staticmethod
    def check_home(driver, odom):
        """Assert that a driving script ended with status 0, and the robot where it ends on the ideal surface."""
        assert driver.wait() == 0, driver.output
        x, y, yaw = support.pose(odom.next())
        if 'Measuring the pose' in driver.output:   # by odometry: as in odom_on_ideal.test
            assert math.hypot(x, y) < 0.005 and abs(math.degrees(support.wrapped(yaw))) < 0.5, (x, y, yaw)
        else:
            off = math.hypot(x - support.EXACT_X, y - support.EXACT_Y)
            turn = support.wrapped(yaw - support.EXACT_TURN)
            assert off < support.MICROMETRE and abs(turn) < 1e-6, f'{off:g} m and {turn:g} rad off'

    def end(self, *processes):
        """End processes as Ctrl-C does, and kill those that do not end."""
        for process in processes or reversed(self.processes):
            if process.process.poll() is None:
                process.signal(signal.SIGINT)
        limit = time.monotonic() + 10
        for process in processes or self.processes:
            while process.process.poll() is None and time.monotonic() < limit:
                time.sleep(0.02)
            process.kill()

    def result(self):
        """The outcome, as written to the suite."""
        return dict(name=self.name, faults=self.faults, skipped='', failures=self.failures, figures=self.figures)


def main():
    """Run the row, and print its result."""
    name, times, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    own_loopback()
    row = Row(name, times, seed)
    try:
        importlib.import_module(f'rows.{name}').run(row)
    except Exception:
        row.failures.append(traceback.format_exc())
    finally:
        row.end()
        sys.stdout.write(f'\n{json.dumps(row.result())}\n')
        sys.stdout.flush()
        os._exit(0)     # rospy's threads may wait for a master that has gone


if __name__ == '__main__':
    main()
