#!/usr/bin/python3
"""~reset moves the base back to the origin, at standstill, even while it is driving."""
import time

import rospy
from std_msgs.msg import Empty as EmptyMessage
from std_srvs.srv import Empty

import support


class TestReset(support.Case):
    def test_reset_while_driving(self):
        odom = support.OdomWatch()
        commander = support.Commander()
        commander.send(0.2, 0.5)
        odom.wait_for_twist(0.2, 0.5, since=0)
        support.wait_for(lambda: odom.position()[0] > 0.05, 'the base to move')
        rospy.wait_for_service('/arbotix/reset', support.LIMIT)
        resets = support.Watch('/reset_odometry', EmptyMessage)
        support.wait_for(lambda: resets.subscriber.get_num_connections(), 'the base to connect')
        reset = rospy.ServiceProxy('/arbotix/reset', Empty)

        def is_announced():     # the base may register the connection a little later than the subscriber
            reset()
            time.sleep(0.1)
            return resets.last
        support.wait_for(is_announced, '/reset_odometry')
        odom.wait_for_twist(0.0)
        self.assertEqual(odom.position(), (0.0, 0.0))
        self.assertEqual(support.yaw(odom.last), 0.0)
        # the base can drive again
        commander.send(0.2)
        support.wait_for(lambda: odom.position()[0] > 0.05, 'the base to move again')


if __name__ == '__main__':
    support.main(TestReset)
