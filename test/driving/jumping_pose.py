#!/usr/bin/python3
"""If the pose jumps during a run, as when the base restarts, the odometry-based script stops the robot and exits."""
import rospy
from geometry_msgs.msg import Twist
from std_srvs.srv import Empty

import support


class TestJumpingPose(support.Case):
    def test_on_the_way_out(self):
        odom, commands = support.OdomWatch(), support.Watch('/cmd_vel', Twist)
        rospy.wait_for_service('/arbotix/reset', support.LIMIT)
        driver = support.by_odometry()
        support.wait_for(lambda: odom.position()[0] > 0.3, 'the first leg')
        # back to the origin without a notice, because the launch file has remapped reset_odometry
        rospy.ServiceProxy('/arbotix/reset', Empty)()
        self.assertEqual(driver.wait(), 1, driver.output)
        errors = [line for line in driver.lines if '[ERROR]' in line]
        self.assertEqual(len(errors), 1, driver.output)
        self.assertRegex(errors[0], r': The pose of base_footprint in odom jumped from \(.*\) to '
                                    r'\(-?0\.\d+ m, -?0\.\d+ m, -?0\.\d+ rad\): was the base restarted\?$')
        self.assertNotIn('Traceback', driver.output)
        self.assertEqual(commands.last, Twist())


if __name__ == '__main__':
    support.main(TestJumpingPose)
