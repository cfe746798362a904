#!/usr/bin/python3
"""A driver of rospy and tf alone reaches its goals on this base, in real and in simulated time."""
import math
import os

import support

DRIVER = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'plain_rospy.py')
PERIOD = 1 / 20     # s, of the driver


class TestPlainDriver(support.Case):
    def test_it_reaches_its_goals(self):
        odom = support.OdomWatch()
        driver = support.Process('/usr/bin/python3', DRIVER)
        self.assertEqual(driver.wait(), 0, driver.output)
        x, y, heading = support.pose(odom.last)
        # it stops after its goal, by up to a few periods: on a busy machine, tf and the script are late
        self.assertGreaterEqual(x, 0.5 - 1e-6)
        self.assertLess(x, 0.5 + 0.2 * 20 * PERIOD)
        self.assertAlmostEqual(y, 0, delta=1e-6)
        self.assertGreaterEqual(heading, math.pi / 2 - 1e-3)
        self.assertLess(heading, math.pi / 2 + 0.5 * 20 * PERIOD)


if __name__ == '__main__':
    support.main(TestPlainDriver)
