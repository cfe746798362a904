"""SIGINT, SIGTERM and SIGHUP to the driving scripts: the last command is a stop, and the process exits in time."""
from contextlib import contextmanager
import math
import os
import signal
import time

import rospy
from geometry_msgs.msg import Twist

import support

FAULT = ('SIGINT, SIGTERM or SIGHUP to a driving script at a random moment; a third of the time with a frozen master, '
         'and a third of the time with a stopped /clock')
PROMISE = ('if a command was sent, the last one is a stop; the robot is stationary within 0.1 s of simulated time; '
           'the process exits within 1.5 s of wall time')
FULL, SHORT = 120, 6
ROOT = ALONE = False

SCRIPTS = ('timed_out_and_back.py', 'odom_out_and_back.py')
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
FACTOR = 8          # the whole run takes 3 s of wall time
DEADLINE = 1.5      # s of wall time
STANDSTILL = 0.1    # s of simulated time
PERIOD = 0.02       # s of simulated time, of odometry and commands
EARLY = 'import rbx1_nav.node.early_interrupt'   # in a traceback: Python is not yet as far as our first line
PYTHON_START = 0.04     # s, or as long as Python takes here: its own traceback of a KeyboardInterrupt


@contextmanager
def suspended(pid):
    """Suspend a process, if there is one."""
    try:
        if pid:
            os.kill(pid, signal.SIGSTOP)
        yield
    finally:
        if pid:
            os.kill(pid, signal.SIGCONT)


def seconds(process):
    """How long a process goes on, s of wall time."""
    start = time.monotonic()
    process.wait()
    return time.monotonic() - start


def run(row):
    """See FAULT."""
    row.roscore()
    row.base('real_time_factor:=%d' % FACTOR)
    support.init_node('faults')
    odom = support.OdomWatch()
    commands = support.Watch('/cmd_vel', Twist)
    python_start = max([PYTHON_START] + [2 * seconds(row.start('/usr/bin/python3', '-c', 'pass')) for _ in range(5)])
    pids = (None, rospy.get_master().getPid()[2], support.pid_of('/arbotix'))
    for count in range(row.times):
        script, number, pid = SCRIPTS[count % 2], SIGNALS[count // 2 % 3], pids[(count + count // 6) % 3]
        moment = row.random.uniform(0, 3)
        freeze = row.random.uniform(0, moment) if row.random.random() < 0.5 else moment
        text = f'{number.name} to {script} after {moment:.3f} s'
        if pid:
            text += f", {'the master' if pid == pids[1] else 'the base'} suspended after {freeze:.3f} s"
        with row.fault(text):
            try_signal(row, script, number, (moment, freeze, pid), (odom, commands), python_start)


def try_signal(row, script, number, moments, watches, python_start):
    """One fault. moments: when to send it, when to suspend which process; watches: of odometry and commands."""
    moment, freeze, pid = moments
    odom, commands = watches
    del odom.messages[:-1], commands.messages[:]
    driver = row.node(script)
    time.sleep(freeze)
    with suspended(pid):
        time.sleep(moment - freeze)
        control = row.start('sleep', str(DEADLINE - 0.1))
        before, sent = len(odom.messages), len(commands.messages)
        driver.signal(number)
        duration = seconds(driver)
        allowed = max(DEADLINE, DEADLINE - 0.1 + seconds(control))
    row.figure('process exited after (s)', duration)
    assert duration <= allowed, f'the process had gone after {duration:.3f} s\n{driver.output}'
    lost = 'has stopped responding' in driver.output    # a base that was suspended long before the signal
    assert driver.process.returncode in (128 + number, -number, *([1] if lost else [])), driver.output
    assert 'Traceback' not in driver.output or moment < python_start or EARLY in driver.output, driver.output
    support.wait_for(lambda: not commands.subscriber.get_num_connections(), 'the end of the connection')
    moves = [(message.linear.x, message.angular.z) != (0, 0) for message in commands.messages]
    assert moves[-1:] != [True], f'the last of {len(moves)} commands is not a stop'
    after = moves[sent:]
    assert True not in after or False not in after or after.index(False) > len(after) - 1 - after[::-1].index(True), \
        f'commands to move after a stop: {after}'
    if not moves:
        return
    # the clock goes on, so that a robot that moved would show it
    start = odom.next().header.stamp
    support.wait_for(lambda: (odom.last.header.stamp - start).to_sec() > 2 * STANDSTILL, 'simulated time')
    poses = [support.pose(message) for message in odom.messages]
    last = next(index for index, pose in enumerate(poses) if pose == poses[-1])
    standing = (odom.messages[max(last, before - 1)].header.stamp - odom.messages[before - 1].header.stamp).to_sec()
    row.figure('stationary after (s of simulated time)', standing)
    # odometry that was under way when the signal was sent may be a period old
    assert standing <= STANDSTILL + 2 * PERIOD, 'stationary after %.2f s, %.3f m' % (
        standing, math.dist(poses[before - 1][:2], poses[-1][:2]))
