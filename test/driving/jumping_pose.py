#!/usr/bin/python3
"""If the pose jumps during a run, as when the base restarts, the odometry-based script stops the robot and exits."""
import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import Empty

import support


class TestJumpingPose(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.commands = support.Watch('/cmd_vel', Twist)
        rospy.wait_for_service('/arbotix/reset', support.LIMIT)
        # back to the origin without a notice, because the launch file has remapped reset_odometry
        cls.to_origin = rospy.ServiceProxy('/arbotix/reset', Empty)

    def check(self, condition, what):
        """Drive until a condition holds, and move the base to the origin."""
        self.to_origin()
        driver = support.by_odometry()
        support.wait_for(condition, what)
        self.to_origin()
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[ERROR]' in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertRegex(errors[0], r': The pose of base_footprint in odom jumped from \(.*\) to '
                                    r'\(-?0\.\d+ m, -?0\.\d+ m, -?0\.\d+ rad\): was the base restarted\?$')
        self.assertNotIn('Traceback', driver.output)
        self.assertEqual(self.commands.last, Twist())

    def test_on_the_way_out(self):
        self.check(lambda: self.odom.position()[0] > 0.3, 'the first leg')

    def test_in_a_turn(self):
        self.check(lambda: self.odom.last.twist.twist.angular.z > 0.5, 'a turn')

    def test_during_a_rest(self):
        self.check(lambda: self.odom.position()[0] > 0.9 and self.odom.last.twist.twist.linear.x == 0, 'a rest')


if __name__ == '__main__':
    support.main(TestJumpingPose)
