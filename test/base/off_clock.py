#!/usr/bin/python3
"""The base names each driver whose commands depend on wall time or on chance, and none that is on the clock."""
import os
import signal
import tempfile
import time
import unittest

from geometry_msgs.msg import Twist
import rosbag
from rosgraph_msgs.msg import Log
import rospy
from std_srvs.srv import Empty

import support

FOLDER = os.path.dirname(os.path.realpath(__file__))
DRIVER = os.path.join(FOLDER, 'off_clock_driver.py')
AT_RATE = os.path.join(FOLDER, 'driver_at_rate.py')
FEEDBACK = os.path.join(FOLDER, 'feedback_driver.py')
PAUSES = 0.1, 0.4, 0.2, 0.3, 0.1    # s between two keys
REPEATED = 1.5      # s of wall time: rostopic sends 15 commands at 10 Hz
# s of simulated time after the run; at 20 times real time, a warning takes much less than these 2 s to arrive
REST = 40


def roscpp(name):
    """Return the path of a C++ driver."""
    return os.path.join(os.environ['CMAKE_PREFIX_PATH'].split(':')[0], 'lib/rbx1_nav', name)


def type_keys(driver):
    """Type for the kind keys."""
    driver.wait_for_line('waits for a key')
    for pause in PAUSES:
        driver.type('0.1')
        time.sleep(pause)
    driver.process.stdin.close()


def write_commands(path):
    """Write a bag with commands at 10 Hz, of which the last one is the stop."""
    with rosbag.Bag(path, 'w') as bag:
        for number in range(21):
            bag.write('/cmd_vel', support.twist(0.1 if number < 20 else 0.0), rospy.Time(1 + number / 10))


class TestOffClock(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('off_clock')
        cls.odom = support.OdomWatch()
        cls.log = support.Watch('/rosout', Log)

    def warnings(self):
        """Return the warnings so far."""
        return [message.msg for message in self.log.messages if 'not in step with /clock' in message.msg]

    def start(self, *command):
        """Start a driver."""
        self.before = len(self.warnings())
        driver = support.Process(*map(str, command), OPENBLAS_NUM_THREADS='')
        self.addCleanup(driver.kill)
        return driver

    def check(self, driver, pattern, status=0):
        """Check, after the driver's run, the name of the node in the only warning; pattern: of the name, None: no
        warning; status: of the driver."""
        self.assertEqual(driver.wait(), status, driver.output)
        end = self.odom.last.header.stamp.to_sec()
        support.wait_for(lambda: self.odom.last.header.stamp.to_sec() > end + REST, f'{REST} s of simulated time')
        found = self.warnings()[self.before:]
        if pattern is None:
            self.assertEqual(found, [])
        else:
            self.assertEqual(len(found), 1, found)
            self.assertRegex(found[0], f'^{pattern} ')

    def test_wall_rate(self):
        self.check(self.start(DRIVER, 'wall_rate'), '/wall_rate')

    def test_wall_thread(self):
        self.check(self.start(DRIVER, 'wall_thread'), '/wall_thread')

    def test_wait_for_message(self):
        self.check(self.start(DRIVER, 'wait_for_message'), '/wait_for_message')

    def test_two_threads(self):
        self.check(self.start(DRIVER, 'two_threads'), '/two_threads')

    def test_keys(self):
        driver = self.start(DRIVER, 'keys')
        type_keys(driver)
        self.check(driver, '/keys')

    def test_rosbag_play(self):
        with tempfile.NamedTemporaryFile(suffix='.bag') as file:
            write_commands(file.name)
            self.check(self.start('rosbag', 'play', file.name), r'/play_\d+')

    def test_rostopic_pub(self):
        driver = self.start('rostopic', 'pub', '-r', 10, '/cmd_vel', Twist._type, '{linear: {x: 0.1}}')
        self.odom.wait_for_twist(0.1)
        time.sleep(REPEATED)
        driver.signal(signal.SIGKILL)       # SIGINT is a traceback in rospy on Debian 11
        self.check(driver, r'/rostopic_\w+', -signal.SIGKILL)

    def test_two_commands(self):
        self.check(self.start(DRIVER, 'two_commands'), None)

    def test_last_command(self):
        self.check(self.start(DRIVER, 'last_command'), None)

    def test_rate(self):
        self.check(self.start(AT_RATE, 'rate', 20, 20), None)

    def test_sleep(self):
        self.check(self.start(AT_RATE, 'sleep', 20, 20), None)

    def test_timer(self):
        self.check(self.start(AT_RATE, 'timer', 20, 20), None)

    def test_roscpp_rate(self):
        self.check(self.start(roscpp('driver_at_rate'), 20, 20), None)

    def test_feedback(self):
        self.check(self.start(FEEDBACK, 'latest', 50), None)

    def test_callback(self):
        self.check(self.start(FEEDBACK, 'callback', 50), None)

    def test_roscpp_callback(self):
        self.check(self.start(roscpp('feedback_driver'), 'callback', 50), None)

    def test_roscpp_timer(self):
        """A ros::Timer is exact, or named."""
        for rate in 10, 20, 50:
            rospy.ServiceProxy('/arbotix/reset', Empty)()
            driver = self.start(roscpp('timer_driver'), rate, rate)
            try:
                self.check(driver, None)
            except AssertionError:
                self.check(driver, r'/timer_driver_\d+')
                continue
            # 0.2 m/s for one second
            self.assertAlmostEqual(self.odom.next().pose.pose.position.x, 0.2, delta=support.MICROMETRE)


if __name__ == '__main__':
    support.main('off_clock', TestOffClock)
