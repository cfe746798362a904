#!/usr/bin/python3
"""If the base exits while the robot is driving, the driving script exits with an error."""
import signal
import unittest

import rospy

import support

BASE = {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26, 'base_frame_id': 'base_footprint'}}}


class TestLostSubscriber(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        support.init_node('lost_subscriber')

    def test_the_last_subscriber_ends(self):
        subscriber = support.Process('rostopic', 'echo', '/cmd_vel')
        self.addCleanup(subscriber.kill)
        driver = support.out_and_back('_linear_speed:=0.01')
        self.addCleanup(driver.kill)
        driver.wait_for_line('forward: 1.00 m')
        subscriber.wait_for_line('x: 0.01')
        subscriber.signal(signal.SIGKILL)
        self.check(driver, r'/rostopic_\w+')

    def test_the_base_ends_and_the_clock_with_it(self):
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
            self.check(driver, '/arbotix')

    def check(self, driver, name):
        """Check that the driving script has named the lost node, sent a stop, and exited with an error."""
        self.assertEqual(driver.wait(), 1, driver.output)
        self.assertRegex(driver.output,
                         fr'ERROR.*/cmd_vel: {name} disconnected, and no subscriber is left: expected a base')
        self.assertIn('Stopping the robot...', driver.output)
        self.assertNotIn('Traceback', driver.output)


if __name__ == '__main__':
    support.main('lost_subscriber', TestLostSubscriber)
