"""What the rostests share: a watch on what the nodes say, and the nodes under test as processes."""
import math
import os
import re
import signal
import subprocess
import threading
import time
from xmlrpc.client import ServerProxy

import rospy
import rostest
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

LIMIT = 60      # s of wall time after which a test gives up; no test asserts less

# the exact end of the exercise: 157 ticks of 1/50 s turn 3.14 rad, a little less than pi (the sum is in the README)
EXACT_X, EXACT_Y, EXACT_TURN = 1 + math.cos(3.14), math.sin(3.14), 6.28
MICROMETRE = 1e-6


def init_node(name):
    """Join ROS without caring about simulated time: tests wait in wall time, for conditions."""
    rospy.init_node(name, disable_rostime=True, anonymous=True)


def wait_for(condition, what, limit=LIMIT):
    """The first true value of condition(); AssertionError after so many seconds of wall time."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.005)
    raise AssertionError('waited %g s in vain for %s' % (limit, what))


def twist(linear=0.0, angular=0.0):
    """A Twist, m/s and rad/s."""
    message = Twist()
    message.linear.x, message.angular.z = linear, angular
    return message


def pid_of(node):
    """Process id of a running node."""
    uri = rospy.get_master().lookupNode(node)[2]
    with ServerProxy(uri) as server:
        return server.getPid('/test')[2]


def yaw(odom):
    """Heading of an Odometry message, rad."""
    rotation = odom.pose.pose.orientation
    return 2 * math.atan2(rotation.z, rotation.w)


def wrapped(angle):
    """The same angle between -pi and pi, rad."""
    return math.atan2(math.sin(angle), math.cos(angle))


class Watch:
    """Keeps all messages of a topic."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=None, tcp_nodelay=True)

    @property
    def last(self):
        """The latest message, or None."""
        return self.messages[-1] if self.messages else None

    def next(self):
        """Wait for a message that comes after this call."""
        count = len(self.messages)
        wait_for(lambda: len(self.messages) > count, 'a message on ' + self.subscriber.name)
        return self.messages[-1]


class OdomWatch(Watch):
    """Keeps all odometry."""

    def __init__(self):
        super().__init__('/odom', Odometry)
        wait_for(lambda: self.last, '/odom')

    def position(self):
        """(x, y) of the latest message, m."""
        point = self.last.pose.pose.position
        return point.x, point.y

    def wait_for_twist(self, linear, angular=0.0):
        """Wait until the base says that it moves so; the message that says it."""
        def check():
            message = self.messages[-1]
            velocity = message.twist.twist
            return (velocity.linear.x, velocity.angular.z) == (linear, angular) and message
        return wait_for(check, 'odometry with the velocity %s, %s' % (linear, angular))


class Commander:
    """Publishes commands, after the base is there to hear them."""

    def __init__(self):
        self.publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=100, tcp_nodelay=True)
        wait_for(lambda: self.publisher.get_num_connections() > 0, 'the base to listen')

    def send(self, linear=0.0, angular=0.0):
        """Publish a Twist, m/s and rad/s."""
        self.publisher.publish(twist(linear, angular))


class OwnClock:
    """/clock, for a test that is itself the owner of simulated time."""

    def __init__(self, start):
        """start: seconds."""
        self.publisher = rospy.Publisher('/clock', Clock, queue_size=100, tcp_nodelay=True)
        wait_for(lambda: self.publisher.get_num_connections() > 0, 'somebody to listen to /clock')
        self.now = start

    def publish(self, now):
        """Set the time, seconds."""
        self.now = now
        self.publisher.publish(rospy.Time.from_sec(now))


class Process:
    """A node under test as a process of its own. Its output is kept, line by line."""

    def __init__(self, *command):
        # unbuffered, so that a line is seen when it is said
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        start_new_session=True, env=dict(os.environ, PYTHONUNBUFFERED='1'))
        self.lines = []
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append(line.rstrip('\n'))

    @property
    def output(self):
        """All that it said so far."""
        return '\n'.join(self.lines)

    def wait_for_line(self, pattern):
        """Wait until it says something that matches."""
        try:
            return wait_for(lambda: re.search(pattern, self.output), repr(pattern))
        except AssertionError as error:
            raise AssertionError('%s, in:\n%s' % (error, self.output))

    def signal(self, number):
        """Send it a signal."""
        self.process.send_signal(number)

    def wait(self):
        """Its exit status, when it has ended."""
        wait_for(lambda: self.process.poll() is not None, 'the end of:\n%s' % self.output)
        self.reader.join(5)
        return self.process.returncode

    def kill(self):
        """End it, whatever it does."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self.process.wait()


def out_and_back(*arguments):
    """The exercise as a Process."""
    return Process('rosrun', 'rbx1_nav', 'timed_out_and_back.py', *arguments)


def by_odometry(*arguments):
    """The exercise by odometry as a Process."""
    return Process('rosrun', 'rbx1_nav', 'odom_out_and_back.py', *arguments)


def pose(odom):
    """(x, y, yaw) of an Odometry message, m and rad."""
    point = odom.pose.pose.position
    return point.x, point.y, yaw(odom)


def main(name, case):
    """Run a test case under rostest."""
    rostest.rosrun('rbx1_nav', name, case)
