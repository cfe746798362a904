"""Each way of rospy tutorials to drive a robot, in a Drive block: it is stopped by each kind of shutdown request."""
import itertools
import os
import signal
import time

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav.node.master import call
import support

# as rospy tutorials drive a robot, see the file
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(support.__file__)), 'driving', 'idioms.py')
IDIOMS = ('rate', 'sleep', 'timer', 'time_sleep', 'threads', 'is_shutdown', 'wait_for_message', 'callback',
          'second_publisher', 'swallowed_exception', 'full_speed', 'published_once')
FAULT = ('SIGINT, SIGTERM, SIGHUP or `rosnode kill` to a script that drives as rospy tutorials do (%s), in real time, '
         'in simulated time, with a frozen master, and with a stopped /clock' % ', '.join(IDIOMS))
PROMISE = ('the last command is a stop, within 0.1 s; the function of rospy.on_shutdown is called; the process exits '
           'within 1.5 s; its status is 128 plus the number of the signal, or 143 after `rosnode kill`')
FULL, SHORT = 192, 48
ROOT = False
ALONE = True

REQUESTS = {'SIGINT': 2, 'SIGTERM': 15, 'SIGHUP': 1, 'rosnode kill': 15}
STOP_TIME, EXIT_TIME = 0.1, 1.5     # s of wall time


class Script:
    """A script in a namespace of its own, and its commands."""

    def __init__(self, row, name):
        self.name = name
        self.node = f'/{name}/{name}'
        self.commands = []      # (s of the monotonic clock, whether it is to move)
        self.subscriber = rospy.Subscriber(f'/{name}/cmd_vel', Twist, self.add, queue_size=None, tcp_nodelay=True)
        self.process = row.start('/usr/bin/python3', SCRIPT, name, ROS_NAMESPACE=name)

    def add(self, message):
        self.commands.append((time.monotonic(), message.linear.x != 0))

    def request(self, request, uri):
        """Request the shutdown. Returns the time, s."""
        start = time.monotonic()
        if request == 'rosnode kill':
            call(uri, 'shutdown', 'the test')
        else:
            self.process.signal(getattr(signal, request))
        return start


def run(row):
    """See FAULT."""
    row.roscore()
    support.init_node('faults')
    master = rospy.get_master().getPid()[2]
    rounds = list(itertools.product(('real time', 'frozen master', 'simulated time', 'stopped clock'), REQUESTS))
    if row.times < FULL:        # each request once
        rounds = rounds[::5]
    base = simulated = None
    for condition, request in rounds:
        if simulated != (condition in ('simulated time', 'stopped clock')):
            simulated = not simulated
            if base:
                row.end(base)
            rospy.set_param('/use_sim_time', simulated)
            # not faster: the clock does not wait for these scripts, and a stall of 1 s of its time is an error
            base = row.base(*(['real_time_factor:=1', 'simulated_time:=true'] if simulated else []))
        frozen = {'frozen master': master, 'stopped clock': simulated and support.pid_of('/arbotix')}.get(condition)
        try_all(row, condition, request, frozen)


def try_all(row, condition, request, frozen):
    """Stop all scripts, one after another. frozen: a process to suspend, or None."""
    scripts = [Script(row, name) for name in IDIOMS]
    try:
        for each in scripts:
            support.wait_for(lambda: any(moving for _, moving in each.commands), f'a command of {each.name}')
        uris = {each: call(os.environ['ROS_MASTER_URI'], 'lookupNode', each.node) for each in scripts}
        if frozen:
            os.kill(frozen, signal.SIGSTOP)
        for each in scripts:
            with row.fault(f'{request} to {each.name}, {condition}'):
                try_one(row, each, request, uris[each])
    finally:
        if frozen:
            os.kill(frozen, signal.SIGCONT)
        for each in scripts:
            each.process.kill()
            each.subscriber.unregister()


def try_one(row, script, request, uri):
    """One fault."""
    assert script.process.process.poll() is None, f'it has already exited\n{script.process.output}'
    control = row.start('sleep', str(EXIT_TIME - 0.1))
    start = script.request(request, uri)
    status = script.process.wait()
    duration = time.monotonic() - start
    control.wait()
    allowed = max(EXIT_TIME, time.monotonic() - start)
    support.wait_for(lambda: not script.subscriber.get_num_connections(), 'the end of the connection', 10)
    last = max(index for index, (_, moving) in enumerate(script.commands) if moving)
    assert last + 1 < len(script.commands), 'the last command is to move'
    stopped = script.commands[last + 1][0] - start
    row.figure('stopped after (s)', stopped)
    row.figure('process exited after (s)', duration)
    assert stopped <= STOP_TIME, f'stopped after {stopped:.3f} s'
    assert 'shutdown() called' in script.process.output, script.process.output
    assert 'Traceback' not in script.process.output, script.process.output
    assert status == 128 + REQUESTS[request], f'status {status}\n{script.process.output}'
    assert duration <= allowed, f'exited after {duration:.3f} s'
