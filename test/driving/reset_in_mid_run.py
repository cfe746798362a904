#!/usr/bin/python3
"""After a reset during a run, the odometry-based script stops the robot and exits."""
import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import Empty

import support


class TestResetInMidRun(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.commands = support.Watch('/cmd_vel', Twist)
        rospy.wait_for_service('/arbotix/reset', support.LIMIT)
        cls.reset = rospy.ServiceProxy('/arbotix/reset', Empty)
        rospy.wait_for_message('/odom_ekf', rospy.AnyMsg, support.LIMIT)

    def check(self, frame):
        driver = support.by_odometry(f'_odom_frame:={frame}')
        support.wait_for(lambda: self.odom.position()[0] > 0.1, 'the robot to move')
        self.reset()
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[INFO]' not in line and '[WARN]' not in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertRegex(errors[0], r'\[ERROR\].*: The base was reset during the run: '
                                    'its pose is no longer measured from the start$')
        self.assertEqual(self.commands.last, Twist())
        self.reset()

    def test_by_odometry(self):
        self.check('odom')

    def test_by_combined_odometry(self):
        self.check('odom_combined')


if __name__ == '__main__':
    support.main(TestResetInMidRun)
