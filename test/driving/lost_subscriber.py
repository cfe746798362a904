#!/usr/bin/python3
"""When the base dies in mid-motion the driver says so and ends with an error."""
import signal
import unittest

import rospy

import support


BASE = {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'base_frame_id': 'base_footprint'}}}


class TestLostListener(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('lost_subscriber')

    def test_lost(self):
        listener = support.Process('rostopic', 'echo', '/cmd_vel')
        self.addCleanup(listener.kill)
        driver = support.out_and_back('_linear_speed:=0.01')
        self.addCleanup(driver.kill)
        driver.wait_for_line('forward: 1.00 m')
        listener.wait_for_line('x: 0.01')
        listener.signal(signal.SIGKILL)
        self.check(driver)

    def test_lost_with_the_clock(self):
        rospy.set_param('/use_sim_time', True)
        self.addCleanup(rospy.set_param, '/use_sim_time', False)
        rospy.set_param('/arbotix', dict(BASE, real_time_factor=5))
        self.addCleanup(rospy.delete_param, '/arbotix')
        for start in (support.out_and_back, support.by_odometry):
            base = support.Process('rosrun', 'rbx1_nav', 'fake_base.py')
            self.addCleanup(base.kill)
            base.wait_for_line('at the origin')
            driver = start('_linear_speed:=0.01')
            self.addCleanup(driver.kill)
            driver.wait_for_line('forward: 1.00 m')
            base.kill()
            self.check(driver)

    def check(self, driver):
        """It has noticed, stopped, and ended with an error."""
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertIn('Nobody listens on /cmd_vel any more', driver.output)
        self.assertIn('Stopping the robot...', driver.output)
        self.assertNotIn('Traceback', driver.output)


if __name__ == '__main__':
    support.main('lost_subscriber', TestLostListener)
