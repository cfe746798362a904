#!/usr/bin/python3
"""Without a base, odom_ekf.launch logs one warning, and one line as soon as there is a base."""
import rospy
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

import support

BASE = {'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26}}}


class TestMissingBase(support.Case):
    def test_warning(self):
        logs = support.Watch('/rosout', Log)

        def lines(level):
            return [log.msg for log in logs.messages
                    if log.name in ('/odom_ekf', '/robot_pose_ekf') and log.level == level]
        missing = 'No message on /odom for 5 s: expected a running base; /odom_ekf starts as soon as there is one'
        support.wait_for(lambda: missing in lines(Log.WARN), 'the warning')

        rospy.set_param('/arbotix', BASE)
        support.Process('rosrun', 'rbx1_nav', 'fake_base.py')
        support.wait_for(lambda: 'Publishing /odom_ekf' in lines(Log.INFO), 'the end of the wait')
        support.Watch('/odom_ekf', Odometry).next()
        self.assertEqual(lines(Log.WARN).count(missing), 1)


if __name__ == '__main__':
    support.main(TestMissingBase)
