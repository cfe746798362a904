#!/usr/bin/python3
"""The base names each driver whose commands depend on wall time or on chance, and none that is on the clock."""
import os
import re
import tempfile
import time

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


class TestOffClock(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.log = support.Watch('/rosout', Log)

    def warnings(self):
        """Return the warnings so far."""
        return [message.msg for message in self.log.messages if 'not in step with /clock' in message.msg]

    def start(self, *command):
        """Start a driver."""
        return support.Process(*map(str, command), OPENBLAS_NUM_THREADS='')

    def drive(self, *command):
        """Run a driver."""
        driver = self.start(*command)
        self.assertEqual(driver.wait(), 0, driver.output)

    def check(self, before, *patterns):
        """Check the names of the nodes in the warnings after the first `before`: one matches each pattern."""
        end = self.odom.last.header.stamp.to_sec()
        support.wait_for(lambda: self.odom.last.header.stamp.to_sec() > end + REST, f'{REST} s of simulated time')
        found = self.warnings()[before:]
        for pattern in patterns:
            self.assertEqual(len([each for each in found if re.match(f'{pattern} ', each)]), 1, (pattern, found))
        self.assertEqual(len(found), len(patterns), found)

    def test_off_the_clock(self):
        before = len(self.warnings())
        for kind in 'wall_rate', 'wall_thread', 'wait_for_message':
            self.drive(DRIVER, kind)
        driver = self.start(DRIVER, 'keys')
        type_keys(driver)
        self.assertEqual(driver.wait(), 0, driver.output)
        with tempfile.NamedTemporaryFile(suffix='.bag') as file:
            write_commands(file.name)
            self.drive('rosbag', 'play', file.name)
        driver = self.start('rostopic', 'pub', '-r', 10, '/cmd_vel', Twist._type, '{linear: {x: 0.1}}')
        self.odom.wait_for_twist(0.1)
        time.sleep(REPEATED)
        driver.kill()       # SIGINT is a traceback in rospy on Debian 11
        self.check(before, '/wall_rate', '/wall_thread', '/wait_for_message', '/keys', r'/play_\d+', r'/rostopic_\w+')

    def test_on_the_clock(self):
        before = len(self.warnings())
        for command in [(DRIVER, 'two_commands'), (DRIVER, 'last_command'), (AT_RATE, 'rate', 20),
                        (AT_RATE, 'sleep', 20), (AT_RATE, 'timer', 20), (roscpp('driver_at_rate'), 20),
                        (FEEDBACK, 'latest', 50), (FEEDBACK, 'callback', 50),
                        (roscpp('feedback_driver'), 'callback', 50)]:
            self.drive(*command)
        self.check(before)

    def test_roscpp_timer(self):
        """A ros::Timer is exact, or named."""
        for rate in 10, 20, 50:
            rospy.ServiceProxy('/arbotix/reset', Empty)()
            before = len(self.warnings())
            self.drive(roscpp('timer_driver'), rate, rate)
            try:
                self.check(before)
            except AssertionError:
                self.check(before, r'/timer_driver_\d+')
                continue
            # 0.2 m/s for one second
            self.assertAlmostEqual(self.odom.next().pose.pose.position.x, 0.2, delta=support.MICROMETRE)


if __name__ == '__main__':
    support.main(TestOffClock)
