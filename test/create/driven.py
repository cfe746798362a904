"""The base node and an emulated robot, both as processes, for the tests in this folder."""
import contextlib
import glob
import itertools
import os
import signal
import threading
import unittest

import numpy
import rospy
from diagnostic_msgs.msg import DiagnosticArray

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import command, drive_direct
import support

STOP = drive_direct(0, 0)
CHI_SQUARE = 16.3       # 99.9 % quantile for 3 degrees of freedom
# parameters of the node: an ideal floor adds no error
IDEAL = dict(odom_linear_error=0.0, odom_angular_error=0.0, odom_heading_error=0.0)


def guardian_of(pid):
    """Return the process id of the guardian of a node's process; None if there is none."""
    for name in glob.glob('/proc/[0-9]*'):
        try:
            with open(f'{name}/stat', encoding='ascii') as stat, open(f'{name}/cmdline', 'rb') as command:
                parent = int(stat.read().rpartition(')')[2].split()[1])
                if parent == pid and b'guardian.py' in command.read():
                    return int(os.path.basename(name))
        except OSError:     # the process has exited
            pass
    return None


def faults_of_both(row):
    """Yield (robot type, DrivenRobot, number) for each fault of a row; half of the faults on a robot of each type."""
    row.roscore()
    support.init_node('faults')
    for robot_type in ('create', 'create2'):
        case = unittest.TestCase()
        robot = DrivenRobot(case, robot_type)
        for number in range((row.times + 1) // 2):
            yield robot_type, robot, number
        case.doCleanups()


class DrivenRobot(EmulatedRobot):
    """turtlebot_node.py on the port of an emulated robot."""

    def __init__(self, case, robot_type, emulated=(), obstacle='', **params):
        """case: the TestCase, whose cleanup stops both processes; emulated: parameters of the robot; obstacle: the
        service of the robot that prevents the node from driving it at first, or ''; params: parameters of the node."""
        super().__init__(case, robot_type, **dict(emulated))
        self.case = case
        if obstacle:
            self.switch(obstacle, True)
        self.diagnostics = support.Watch('/diagnostics', DiagnosticArray)
        self.node = self.start_node(**{f'_{name}': value for name, value in params.items()})
        self.odom = support.OdomWatch()
        self.commander = support.Commander()
        if obstacle:
            return
        self.wait_for_status('Stationary')
        if robot_type == 'create':
            self.wait_for_status('Calibrated', 'Gyro')

    def start_node(self, *arguments, **params):
        """Start another base node on this port."""
        if rospy.has_param('/turtlebot_node'):
            rospy.delete_param('/turtlebot_node')
        node = support.Process('rosrun', 'rbx1_nav', 'turtlebot_node.py', f'_port:={self.link}', *arguments,
                               *('%s:=%s' % item for item in params.items()))
        self.case.addCleanup(self.end_node, node)
        return node

    def end_node(self, node):
        """Stop a node if it is running, and check its log."""
        if node.process.poll() is None:
            node.signal(signal.SIGINT)
            self.case.assertEqual(node.wait(), 0, node.output)
        node.kill()
        self.case.assertNotIn('Traceback', node.output)

    def status(self, name=None):
        """Return the latest status of a part of the robot, by default of the base; None if there is none."""
        name = name or 'Base'
        statuses = [status for message in list(self.diagnostics.messages) for status in message.status]
        return next((status for status in reversed(statuses) if status.name == f'turtlebot_node: {name}'), None)

    def value(self, part, key):
        """Return a value in the status of a part."""
        return next(each.value for each in self.status(part).values if each.key == key)

    def wait_for_status(self, message, name=None):
        """Wait until the message of a status contains `message`."""
        try:
            return support.wait_for(lambda: message in getattr(self.status(name), 'message', ''), repr(message))
        except AssertionError as error:
            raise AssertionError(f'{error}; status: {self.status(name)}; node: {self.node.output}')

    def drive(self, linear, angular, condition, what):
        """Repeat a command until a condition holds."""
        def check():
            self.commander.send(linear, angular)
            rospy.sleep(0.02)
            return condition()
        return support.wait_for(check, what)

    @contextlib.contextmanager
    def driving(self, linear=0.2, angular=0.0, rate=50):
        """A context in which the robot moves, because a thread repeats the command (rate: Hz) even if this one has to
        wait. It returns an Event that ends the commands."""
        left = threading.Event()

        def send():
            while not left.wait(1 / rate):
                self.commander.send(linear, angular)
        thread = threading.Thread(target=send)
        thread.start()
        try:
            support.wait_for(lambda: self.moving, f'the robot to move: {self.node.output}')
            yield left
        finally:
            left.set()
            thread.join()

    def wait_for_motion(self, linear=0.2, angular=0.0):
        """Drive until the robot moves."""
        self.drive(linear, angular, lambda: self.moving, f'the robot to move: {self.node.output}')

    def drive_again(self):
        """Drive until the robot moves. Zero commands now and then end a lockout, which there may be on a busy machine.
        """
        commands = itertools.cycle([(0.0, 0.0), *50 * [(0.2, 0.0)]])

        def moves():
            self.commander.send(*next(commands))
            rospy.sleep(0.02)
            return self.moving
        support.wait_for(moves, 'the robot to move')

    def wait_for_standstill(self):
        """Wait until the robot is stationary according to the ground truth."""
        support.wait_for(lambda: not self.moving, f'the robot to stop: {self.node.output}')

    def wait_for_mode(self, mode):
        """Wait until the diagnostics show a mode."""
        support.wait_for(lambda: self.value(None, 'Mode') == mode, f'mode {mode}')

    def commands_since(self, count):
        """Return the commands that the robot has received after the first `count`."""
        return [data for _, data in self.received()[count:]]

    def wait_for_command(self, count, matches=lambda stamp, data: True):
        """Return the first matching command after the first `count`, (s of ROS time, bytes).

        It may arrive after the ground truth of its effect, over another connection.
        """
        return support.wait_for(lambda: [each for each in self.received()[count:] if matches(*each)], 'a command')[0]

    def wait_for_stop(self, count):
        """Wait for a stop that leaves the robot in passive mode, after the first `count` commands."""
        def stopped():
            since = self.commands_since(count)
            return command('start') in since and STOP in since[:since.index(command('start'))]
        support.wait_for(stopped, 'a stop on the line')
        self.wait_for_standstill()

    def poses(self):
        """Return (odometry, ground truth), each (x, y, yaw), of a stationary robot."""
        self.wait_for_standstill()
        self.odom.next()
        self.odom.next()
        return support.pose(self.odom.last), support.pose(self.truth.next())

    def error(self):
        """Return the error of the odometry, (x, y, yaw)."""
        (x, y, yaw), (true_x, true_y, true_yaw) = self.poses()
        return x - true_x, y - true_y, support.wrapped(yaw - true_yaw)

    def normalized_error(self):
        """Return the squared error of the odometry, normalized by its covariance: chi-square with 3 degrees of freedom.
        """
        error = numpy.array(self.error())
        covariance = numpy.array(self.odom.last.pose.covariance).reshape(6, 6)[numpy.ix_([0, 1, 5], [0, 1, 5])]
        return error @ numpy.linalg.solve(covariance, error)
