"""Subscribers that hardly read do not delay the commands to another one."""
from itertools import product
import time

import rospy
from geometry_msgs.msg import Twist

from slow_subscriber import SlowSubscriber
import support

FAULT = ('3 subscribers to /cmd_vel with small buffers that never read, or read one byte per second, connected before '
         'the start or during the run')
PROMISE = ("the 99th percentile of another subscriber's command period is within 5 ms of a simultaneous control run; "
           "memory and threads of the script do not grow; the script names the subscribers that were connected at its "
           "start")
FULL, SHORT = 8, 1
ROOT, ALONE = False, True

CASES = list(product((True, False), (False, True)))     # (connected before the start, reads a byte a second)
P99_LIMIT = 0.005       # s
LONGEST_LIMIT = 0.5     # s
MEMORY_LIMIT = 1024     # KB


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    for count in range(row.times):
        before, reads = CASES[count % 4]
        with row.fault('subscribers that %s, connected %s' % (
                'read one byte per second' if reads else 'never read',
                'before the start' if before else 'during the run')):
            slow_subscribers(row, before, reads)


def slow_subscribers(row, before, reads):
    """One fault: a run with them, and another one beside it on a topic of its own."""
    subscribers = []

    def connect():
        subscribers.extend(SlowSubscriber('/slow_%d' % number, '/cmd_vel', reads) for number in range(3))
    probe, control_probe = Probe('/cmd_vel'), Probe('/control_cmd_vel')
    try:
        if before:
            connect()
        run = 'timed_out_and_back.py', '_goal_distance:=0.5'
        control = row.node(*run, '/cmd_vel:=/control_cmd_vel', '__name:=control')
        driver = row.node(*run)
        support.wait_for(lambda: len(probe.commands) > 50 and len(control_probe.commands) > 50, 'commands')
        if not before:
            connect()
        support.wait_for(lambda: all(each.sockets for each in subscribers), 'the connections')
        time.sleep(0.5)     # for what a connection allocates at first
        first = last = usage(driver), usage(control)
        end = time.monotonic() + support.LIMIT
        while driver.process.poll() is None and time.monotonic() < end:
            if probe.commands[-1][1]:   # at its end, a node has threads that unregister it
                last = usage(driver) or last[0], usage(control) or last[1]
            time.sleep(0.1)
        status = driver.process.poll()
        (period, longest), (control_period, control_longest) = probe.periods(), control_probe.periods()
        row.figure('p99 of the period (ms)', 1000 * period)
        row.figure('p99 of the control run (ms)', 1000 * control_period)
        assert period <= control_period + P99_LIMIT, 'the p99 of the period is %.4f s, in the control run %.4f s' % (
            period, control_period)
        assert longest <= control_longest + LONGEST_LIMIT, 'the longest period is %.3f s, in the control run %.3f s' % (
            longest, control_longest)
        grown, control_grown = (end[0] - start[0] for start, end in zip(first, last))
        row.figure('memory growth (KB)', grown)
        assert grown <= max(control_grown, 0) + MEMORY_LIMIT, 'the memory has grown by %d KB' % grown
        assert last[0][1] <= first[0][1], 'the number of threads has grown from %d to %d' % (first[0][1], last[0][1])
        assert status == 0, driver.output
        assert ('/slow_' in driver.output) == before, driver.output     # those of its start are named
    finally:
        for each in subscribers:
            each.close()
        probe.subscriber.unregister()
        control_probe.subscriber.unregister()
        row.end(driver, control)


def usage(driver):
    """(memory in KB, number of threads) of a process; None if it has ended."""
    try:
        with open('/proc/%d/status' % driver.process.pid, encoding='utf-8') as file:
            values = dict(line.split(':', 1) for line in file)
        return int(values['VmRSS'].split()[0]), int(values['Threads'])
    except (OSError, KeyError):
        return None


class Probe:
    """Keeps the times at which commands arrive, on the monotonic clock, and whether they move the robot."""

    def __init__(self, topic):
        self.commands = []
        self.subscriber = rospy.Subscriber(topic, Twist, self.on_twist, tcp_nodelay=True)

    def on_twist(self, twist):
        """A command arrives."""
        self.commands.append((time.monotonic(), twist.linear.x != 0 or twist.angular.z != 0))

    def periods(self):
        """(99th percentile, longest) of the period during motions, s."""
        periods = sorted(later - time for (time, moves), (later, _) in zip(self.commands, self.commands[1:]) if moves)
        return periods[len(periods) * 99 // 100], periods[-1]
