#!/usr/bin/python3
"""The base names no driver that is on the clock."""
import os
import re

from rosgraph_msgs.msg import Log
import rospy
from std_srvs.srv import Empty

import support

FOLDER = os.path.dirname(os.path.realpath(__file__))
DRIVER = os.path.join(FOLDER, 'off_clock_driver.py')
AT_RATE = os.path.join(FOLDER, 'driver_at_rate.py')
FEEDBACK = os.path.join(FOLDER, 'feedback_driver.py')
# s of simulated time after the run; at 20 times real time, a warning takes much less than these 2 s to arrive
REST = 40


class TestOffClock(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.log = support.Watch('/rosout', Log)

    def warnings(self):
        """Return the warnings so far."""
        return [message.msg for message in self.log.messages if 'not in step with /clock' in message.msg]

    def drive(self, *command):
        """Run a driver."""
        driver = support.Process(*map(str, command), OPENBLAS_NUM_THREADS='')
        self.assertEqual(driver.wait(), 0, driver.output)

    def check(self, before, *patterns):
        """Check the names of the nodes in the warnings after the first `before`: one matches each pattern."""
        end = self.odom.last.header.stamp.to_sec()
        support.wait_for(lambda: self.odom.last.header.stamp.to_sec() > end + REST, f'{REST} s of simulated time')
        found = self.warnings()[before:]
        for pattern in patterns:
            self.assertEqual(len([each for each in found if re.match(f'{pattern} ', each)]), 1, (pattern, found))
        self.assertEqual(len(found), len(patterns), found)

    def test_on_the_clock(self):
        before = len(self.warnings())
        for command in [(DRIVER, 'two_commands'), (DRIVER, 'last_command'), (AT_RATE, 'rate', 20),
                        (AT_RATE, 'sleep', 20), (AT_RATE, 'timer', 20), (support.roscpp('driver_at_rate'), 20),
                        (FEEDBACK, 'latest', 50), (FEEDBACK, 'callback', 50),
                        (support.roscpp('feedback_driver'), 'callback', 50)]:
            self.drive(*command)
        self.check(before)

    def test_roscpp_timer(self):
        """A ros::Timer is exact, or named."""
        for rate in 10, 20, 50:
            rospy.ServiceProxy('/arbotix/reset', Empty)()
            before = len(self.warnings())
            self.drive(support.roscpp('timer_driver'), rate, rate)
            try:
                self.check(before)
            except AssertionError:
                self.check(before, r'/timer_driver_\d+')
                continue
            # 0.2 m/s for one second
            self.assertAlmostEqual(self.odom.next().pose.pose.position.x, 0.2, delta=support.MICROMETRE)


if __name__ == '__main__':
    support.main(TestOffClock)
