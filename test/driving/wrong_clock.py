#!/usr/bin/python3
"""A script that was started before /use_sim_time was set does not drive a base on simulated time."""
import rospy

import support


class TestWrongClock(support.Case):
    def test_real_time(self):
        odom = support.OdomWatch()
        rospy.set_param('/use_sim_time', False)
        driver = support.out_and_back()
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertRegex(driver.output, r'\[ERROR\].*: /use_sim_time was false when this node started, but /arbotix '
                                        'publishes /clock: start this node again')
        self.assertEqual(odom.next().pose.pose.position.x, 0)


if __name__ == '__main__':
    support.main(TestWrongClock)
