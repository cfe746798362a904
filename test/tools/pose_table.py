#!/usr/bin/python3
"""pose.py prints truth, odometry and estimate below each other, and always exits by itself."""
import math
import re

import rospy
from nav_msgs.msg import Odometry

import support

ROW = r'(?:truth|odometry|estimate) +(/\w+) +(-?\d+\.\d{3}) +(-?\d+\.\d{3}) +(-?\d+\.\d) +(\d+\.\d{3})'


class TestPoseTable(support.Case):
    def pose(self, *prefix):
        """Run pose.py; return its exit status and its lines."""
        process = support.Process(*prefix, 'rosrun', 'rbx1_nav', 'pose.py')
        return process.wait(), process.lines

    def publish_odometry(self, x, y, yaw):
        """Publish the odometry of a stationary robot; return the message."""
        publisher = rospy.Publisher('/odom', Odometry, queue_size=1, latch=True)
        self.addCleanup(publisher.unregister)
        odom = Odometry()
        odom.pose.pose.position.x, odom.pose.pose.position.y = x, y
        odom.pose.pose.orientation.z, odom.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        publisher.publish(odom)
        return odom

    def check(self, line, message):
        """Compare a line of the table with the message that it shows, within half a digit."""
        row = re.fullmatch(ROW, line)
        self.assertTrue(row, line)
        x, y, yaw = support.pose(message)
        shown = list(map(float, row.groups()[1:]))
        for value, number, tolerance in zip((x, y, math.degrees(support.wrapped(yaw)), math.hypot(x, y)), shown,
                                            (0.00051, 0.00051, 0.051, 0.00051)):
            self.assertAlmostEqual(value, number, delta=tolerance, msg=line)
        self.assertNotRegex(line, r'-0\.0+ ')

    def test_without_a_master_or_a_base(self):
        for command, text in [
                (('env', 'ROS_MASTER_URI=http://127.0.0.1:1'),
                 r'^The master at http://127\.0\.0\.1:1 does not answer .*: expected a running roscore$'),
                ((), r'\[ERROR\] .*: No message on /ground_truth, /odom, /odom_ekf for 5 s: expected a running base$')]:
            status, lines = self.pose(*command)
            self.assertEqual((status, len(lines)), (1, 1), lines)
            self.assertRegex(lines[0], text)

    def test_a_base_that_starts_later(self):
        process = support.Process('rosrun', 'rbx1_nav', 'pose.py')
        support.wait_for(lambda: '/pose' in str(rospy.get_master().getSystemState()), 'pose.py to start')
        # not a real base, which may take longer to start than pose.py waits
        odom = self.publish_odometry(1.0, 0.0, 0.0)
        self.assertEqual(process.wait(), 0, process.output)
        self.assertRegex(process.lines[1], 'truth +/ground_truth +not published')
        self.check(process.lines[2], odom)
        self.assertRegex(process.lines[3], 'estimate +/odom_ekf +not published')


if __name__ == '__main__':
    support.main(TestPoseTable)
