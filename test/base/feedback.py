#!/usr/bin/python3
"""A driver with feedback takes the same path in every run: the one on which it always knows the pose of its tick.

    feedback.py rospy|roscpp|filter
"""
import importlib.util
from math import cos, sin
import os
import sys

import rospy
from nav_msgs.msg import Odometry
from std_srvs.srv import Empty

import support

DRIVER = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'feedback_driver.py')
RUNS = 2
SECOND = 10 ** 9
STEP = 20_000_000       # ns of the clock
# rates (Hz) of each kind; 20 Hz is no whole number of ticks
RATES = {
    'rospy': {'latest': (20, 50), 'tf_loop': (20,), 'callback': (10, 50), 'tf_callback': (50,), 'filters': (50,)},
    'roscpp': {'latest': (20, 50), 'tf_loop': (20,), 'callback': (10, 50), 'tf_callback': (50,)},
    'filter': {'latest_ekf': (10, 20, 50)}}
# those that are also started on wall time; a loop may then begin a tick earlier than its first command takes effect
WALL = (('callback', 50),)


def driver_in(language):
    """Return the path of the driver."""
    return support.roscpp('feedback_driver') if language == 'roscpp' else DRIVER


def commands(x, y, yaw):
    """Return the velocities that feedback_driver.py sends at a pose."""
    return min(max(1.0 * (1.0 - x), 0.05), 0.3), 0.5 * (0.05 - y) - 0.5 * yaw


def effective_rate(kind, rate):
    """Return the rate (Hz) of a Rate loop that sends the same commands. Callbacks count messages, at 50 Hz. Between two
    estimates, at 10 Hz, a driver has no reason to change its command, whatever its rate is."""
    return 10 if kind == 'latest_ekf' else rate if kind in ('latest', 'tf_loop') else 50 / (50 // rate)


def ideal_end(rate):
    """Return the x and y (m) at which the driver stops if it knows the current pose at each of its ticks."""
    x = y = yaw = linear = angular = 0.0
    tick = sent = 0
    while True:
        if tick == -(-sent * int(SECOND / rate) // STEP):       # the first tick not before the time, as in rospy.Rate
            if x >= 0.999:
                return x, y
            linear, angular = commands(x, y, yaw)
            sent += 1
        turned = yaw + angular * STEP / SECOND
        x += linear / angular * (sin(turned) - sin(yaw))
        y -= linear / angular * (cos(turned) - cos(yaw))
        yaw = turned
        tick += 1


class TestFeedback(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        rospy.wait_for_service('/arbotix/reset')
        if 'filter' in sys.argv:
            rospy.wait_for_message('/odom_ekf', Odometry)

    def setUp(self):
        self.assertFalse(rospy.is_shutdown(), 'the base has exited')

    def drive(self, command, *arguments):
        """Run a driver from the origin, and return the true end pose as text, and its x and y (m)."""
        try:
            return self.run_driver(command, *arguments)
        except KeyboardInterrupt:       # roslaunch ends all nodes
            return self.fail(f"{' '.join(map(str, arguments))}: the base has exited: see its output for the reason")

    def run_driver(self, command, *arguments):
        """See drive()."""
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        driver = support.Process(command, *map(str, arguments), OPENBLAS_NUM_THREADS='')
        self.assertEqual(driver.wait(), 0, driver.output)
        # through a new connection, because old messages may be queued in the connection of a busy subscriber
        end = support.pose(rospy.wait_for_message('/ground_truth', Odometry))
        return repr(end), end[:2]

    def check(self, language, kind, rate, *start):
        """Check all runs of a driver."""
        if kind == 'filters' and not importlib.util.find_spec('message_filters'):
            self.skipTest('no package message_filters')
        ends = [self.drive(driver_in(language), kind, rate, *start) for _ in range(RUNS)]
        texts = [text for text, _ in ends]
        # the filter's estimate rounds differently after another time at rest
        if kind != 'latest_ekf':
            self.assertEqual(len(set(texts)), 1, '\n'.join(['end poses of the runs:'] + texts))
        for _, end in ends:
            for coordinate, ideal in zip(end, ideal_end(effective_rate(kind, rate))):
                # the base and this test round differently
                self.assertAlmostEqual(coordinate, ideal, delta=support.MICROMETRE, msg=texts)


if __name__ == '__main__':
    for each, rates in RATES[sys.argv[1]].items():
        for number in rates:
            for start in [(), ('wall',)][:1 + ((each, number) in WALL)]:
                setattr(TestFeedback, '_'.join(['test', each, str(number), *start]),
                        lambda self, arguments=(sys.argv[1], each, number, *start): self.check(*arguments))
    support.main(TestFeedback)
