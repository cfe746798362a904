"""SIGKILL to the base node of an emulated Create in motion."""
import os
import signal
import time

import rospy

import support
from driven import STOP, faults_of_both, guardian_of

FAULT = ("SIGKILL to a Create's base node, or to its process group, at a random moment of a motion; in four of five "
         'cases, also to its guardian, 3 to 50 ms or 100 to 200 ms earlier or later; half of the faults beside four '
         'busy loops')
PROMISE = ('a stop reaches the robot within 0.2 s, unless the second process is killed within 10 ms, or 100 ms beside '
           'busy loops')
FULL, SHORT = 60, 5
ROOT = False
ALONE = True    # it measures a duration

LIMIT = 0.2     # s
WAIT = 3        # s: beside busy loops, the emulated robot may be late
SHORT_GAP, LONG_GAP = (0.003, 0.05), (0.1, 0.2)     # s
# s between the two kills in which there may be no stop: on a quiet machine, and beside busy loops
UNSAFE = (0.01, 0.1)
LOOPS = 4


def kill(robot, group, gap):
    """Kill the node, or its process group. gap: s from the guardian's death to the node's; negative if the node dies
    first; 0 if the guardian is not killed. Returns (time of the first kill in s of ROS time, actual gap)."""
    pid = support.pid_of('/turtlebot_node')
    guardian = guardian_of(pid)

    def kill_node():
        (os.killpg if group else os.kill)(robot.node.process.pid if group else pid, signal.SIGKILL)

    def kill_guardian():
        if gap:
            os.kill(guardian, signal.SIGKILL)
    first, second = (kill_guardian, kill_node) if gap > 0 else (kill_node, kill_guardian)
    killed, start = rospy.get_time(), time.monotonic()
    first()
    time.sleep(abs(gap))
    actual = time.monotonic() - start
    try:
        second()
    except ProcessLookupError:      # the guardian has stopped the robot, and exited
        pass
    return killed, actual


def find_stop(robot, count, killed):
    """Return the delay (s) of the stop, or None if none arrives."""
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        stops = [stamp for stamp, data in robot.received()[count:] if data == STOP and stamp > killed]
        if stops and not robot.moving:
            return stops[0] - killed
        time.sleep(0.005)
    return None


def check(row, robot, seconds, group, gap, loops):
    """One fault, in motion; then another node takes over."""
    end = time.monotonic() + seconds
    robot.drive(0.2, 0.3, lambda: time.monotonic() > end and robot.moving, 'the robot to move')
    count = len(robot.received())
    with row.busy(loops):
        time.sleep(0.3 if loops else 0)
        robot.drive(0.2, 0.3, lambda: robot.moving, 'the robot to move')
        killed, actual = kill(robot, group, gap)
        delay = find_stop(robot, count, killed)
    where = 'beside busy loops' if loops else 'quiet'
    if delay is not None:
        row.figure(f'{where}: stop after (s)', delay)
    elif gap:
        order = 'guardian first' if gap > 0 else 'node first'
        row.figure(f'{where}, {order}: gap at which the robot drove on (s)', actual)
    robot.node.wait()
    robot.node = robot.start_node()
    robot.node.wait_for_line('in safe mode')
    if not gap or actual > UNSAFE[bool(loops)]:
        assert delay is not None and delay < LIMIT, f'stop after {delay} s; gap {1000 * actual:.1f} ms'


def run(row):
    """See FAULT."""
    for robot_type, robot, index in faults_of_both(row):
        seconds, group = row.random.uniform(0.2, 2), row.random.random() < 0.5
        gap = (0, 1, -1, 1, -1)[index % 5] * row.random.uniform(*(LONG_GAP if index % 5 < 3 else SHORT_GAP))
        loops = LOOPS * (index // 5 % 2)
        with row.fault('%s: SIGKILL to the %s after %.3f s, %.1f ms after its guardian, %d busy loops' % (
                robot_type, 'group' if group else 'node', seconds, 1000 * gap, loops)):
            check(row, robot, seconds, group, gap, loops)
