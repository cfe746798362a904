"""Shared code of the rostests: stores the messages of a topic, and runs the nodes under test as processes."""
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from xmlrpc.client import ServerProxy

import rosgraph
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from roslib.packages import find_node

from rbx1_nav.base.surfaces import known_surfaces
from rbx1_nav.node import resources
from rbx1_nav.node.master import call
from rbx1_nav.node.rospy_connections import repair_connections

COLOR = re.compile('\x1b\\[[0-9;]*m')
LIMIT = 280      # s of wall time after which a wait fails and is named; less than a test may take

# the exact end pose of the exercise: 157 ticks of 1/50 s at 1 rad/s turn by 3.14 rad, slightly less than pi
EXACT_X, EXACT_Y, EXACT_TURN = 1 + math.cos(3.14), math.sin(3.14), 6.28
MICROMETRE = 1e-6

# the error of a calibration on a machine that is too busy, where the odometry is late; the run is repeated
LATE = 'The last transform'
ATTEMPTS = 5


def script_name():
    """Return the name of the script that runs."""
    return os.path.splitext(os.path.basename(sys.argv[0]))[0]


def init_node(name):
    """Start a node that ignores simulated time: tests wait for conditions by the wall clock."""
    repair_connections()
    rospy.init_node(name, disable_rostime=True, anonymous=True)


def wait_for(condition, what, limit=LIMIT):
    """Return the first true value of condition(). Raises AssertionError after `limit` seconds of wall time."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f'timed out after {limit:g} s waiting for {what}; connections:\n{connections()}')


def connections():
    """Return who is connected with whom, as each node sees it."""
    found = []
    try:
        master = rosgraph.get_master_uri()
        publishers, subscribers, _ = call(master, 'getSystemState')
        for node in sorted({node for _, nodes in publishers + subscribers for node in nodes}):
            found += [f'{node} {direction} {topic} {peer}'
                      for _, peer, direction, _, topic, *_ in call(call(master, 'lookupNode', node), 'getBusInfo')]
    except OSError as error:        # a test may have ended or suspended a node
        found.append(str(error))
    return '\n'.join(found)


def twist(linear=0.0, angular=0.0):
    """Return a Twist, m/s and rad/s."""
    message = Twist()
    message.linear.x, message.angular.z = linear, angular
    return message


def pid_of(node):
    """Return the process id of a running node."""
    uri = rospy.get_master().lookupNode(node)[2]
    with ServerProxy(uri) as server:
        return server.getPid('/test')[2]


def yaw(odom):
    """Return the heading of an Odometry message, rad."""
    rotation = odom.pose.pose.orientation
    return 2 * math.atan2(rotation.z, rotation.w)


def wrapped(angle):
    """Return the equivalent angle between -pi and pi, rad."""
    return math.atan2(math.sin(angle), math.cos(angle))


class Watch:
    """Stores all messages of a topic."""

    def __init__(self, topic, kind):
        """topic: a name; kind: the message class."""
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=None, tcp_nodelay=True)

    def wait_for_publisher(self, node):
        """Wait for the connection to a node, which would lose what it publishes before."""
        wait_for(lambda: any(each.callerid_pub == node for each in self.subscriber.impl.connections),
                 f'a connection to {self.subscriber.name} of {node}')

    @property
    def last(self):
        """Return the latest message, or None."""
        return self.messages[-1] if self.messages else None

    def next(self):
        """Wait for the next message and return the latest."""
        count = len(self.messages)
        wait_for(lambda: len(self.messages) > count, f'a message on {self.subscriber.name}')
        return self.messages[-1]


class OdomWatch(Watch):
    """Stores all odometry messages of the base."""

    def __init__(self):
        super().__init__('/odom', Odometry)
        wait_for(lambda: self.last, '/odom')

    def position(self):
        """Return (x, y) of the latest message, m."""
        point = self.last.pose.pose.position
        return point.x, point.y

    def wait_for_twist(self, linear, angular=0.0, since=-1):
        """Wait until the base reports exactly this velocity, m/s and rad/s; return the message.

        since: number of messages that do not count, for a motion that ends by itself: on a busy machine, the test may
        be suspended for longer than it lasts. Default: only the latest message counts.
        """
        def check():
            return next((message for message in self.messages[since:] if (linear, angular) == (
                message.twist.twist.linear.x, message.twist.twist.angular.z)), None)
        return wait_for(check, f'odometry with the velocity {linear}, {angular}')


class Commander:
    """Publishes commands once the base is connected."""

    def __init__(self):
        self.publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=100, tcp_nodelay=True)
        wait_for(lambda: self.publisher.get_num_connections() > 0, 'the base to subscribe to /cmd_vel')

    def send(self, linear=0.0, angular=0.0):
        """Publish a Twist, m/s and rad/s."""
        self.publisher.publish(twist(linear, angular))


def without_rosrun(command):
    """Return the command with the path of the node instead of `rosrun PACKAGE NODE`. rosrun takes longer to find a node
    than the node takes to start. test/documents.py uses rosrun itself."""
    if 'rosrun' not in command:
        return command
    index = command.index('rosrun')
    try:
        path, *_ = find_node(*command[index + 1:index + 3])
    except rospkg.ResourceNotFound:     # Debian's topic_tools has no package.xml, but rosrun can find its nodes
        return command
    return [*command[:index], path, *command[index + 3:]]


class Process:
    """A node under test in a separate process. Stores the lines of its output."""

    started = []        # all of them, in this order

    def __init__(self, *command, **environment):
        """environment: variables to set."""
        self.process = subprocess.Popen(without_rosrun(command), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.STDOUT, text=True, start_new_session=True, env=dict(
                                            os.environ, PYTHONUNBUFFERED='1', PYTHONFAULTHANDLER='1', **environment))
        self.started.append(self)
        self.lines = []
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            # without the colors of roscpp, which would make the result file unreadable
            self.lines.append(COLOR.sub('', line.rstrip('\n')))

    @property
    def output(self):
        """Return all output so far."""
        return '\n'.join(self.lines)

    def wait_for_line(self, pattern):
        """Wait until the output matches a regular expression."""
        try:
            return wait_for(lambda: re.search(pattern, self.output), repr(pattern))
        except AssertionError as error:
            raise AssertionError(f'{error}, in:\n{self.output}')

    def type(self, line):
        """Type a line."""
        print(line, file=self.process.stdin, flush=True)

    def signal(self, number):
        """Send a signal."""
        self.process.send_signal(number)

    def wait(self):
        """Wait until the process exits; returns the exit status."""
        try:
            wait_for(lambda: self.process.poll() is not None, 'the exit')
        except AssertionError as error:
            self.signal(signal.SIGABRT)     # Python then prints where each thread is
            self.reader.join(5)
            raise AssertionError(f'{error} of:\n{self.output}') from None
        self.reader.join(5)
        return self.process.returncode

    def kill(self):
        """Kill the process and all its children."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()


class Case(unittest.TestCase):
    """A test case that is a node with the name of its script. A Process that a test starts is killed at its end."""

    @classmethod
    def setUpClass(cls):
        init_node(script_name())

    def run(self, result=None):
        """Run a test."""
        before = len(Process.started)
        try:
            return super().run(result)
        finally:
            for process in Process.started[before:]:
                process.kill()
            del Process.started[before:]

    def file(self, text, suffix):
        """Return the path of a file with a text, which is deleted after the test."""
        file = tempfile.NamedTemporaryFile('w', suffix=suffix)
        self.addCleanup(file.close)
        print(text, file=file, flush=True)
        return file.name

    def watch_commands(self):
        """Return a Watch of /cmd_vel, which ends with the test."""
        commands = Watch('/cmd_vel', Twist)
        self.addCleanup(commands.subscriber.unregister)
        return commands

    def start(self, *command):
        """Start a Process. It is interrupted after the test, so that a roslaunch stops its nodes."""
        process = Process(*command)
        self.addCleanup(process.wait)
        self.addCleanup(process.signal, signal.SIGINT)
        return process


def roscpp(name):
    """Return the path of a C++ driver."""
    return os.path.join(os.environ['CMAKE_PREFIX_PATH'].split(':')[0], 'lib', 'rbx1_nav', name)


def surfaces():
    """Return the names of the surfaces, as in a message."""
    return ', '.join(known_surfaces(resources.surfaces()))


def out_and_back(*arguments):
    """Start the timed script; return its Process."""
    return Process('rosrun', 'rbx1_nav', 'timed_out_and_back.py', *arguments)


def by_odometry(*arguments):
    """Start the odometry-based script; return its Process."""
    return Process('rosrun', 'rbx1_nav', 'odom_out_and_back.py', *arguments)


def pose(odom):
    """Return (x, y, yaw) of an Odometry message, m and rad."""
    point = odom.pose.pose.position
    return point.x, point.y, yaw(odom)


def main(case):
    """Run a Case under rostest."""
    rostest.rosrun('rbx1_nav', script_name(), case)
