#!/usr/bin/python3
"""The filter logs a line for each requested feature of robot_pose_ekf that it does not support, and runs without it."""
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry

import support

LINES = ['vo_used: visual odometry is not supported and not used', 'gps_used: GPS is not supported and not used',
         'debug: no files are written; record the topics with rosbag', 'self_diagnose: see /diagnostics']


class TestUnsupportedInputs(support.Case):
    def start(self, value):
        """Start the filter with this value of all four parameters and wait for a pose; return the process."""
        ekf = support.Process('rosrun', 'rbx1_nav', 'ekf.py', '_imu_used:=false', *(
            f"_{line.split(':')[0]}:={value}" for line in LINES))
        poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        odometry = rospy.Publisher('/odom', Odometry, queue_size=10)

        def send():
            message = Odometry()
            message.header.frame_id, message.header.stamp = 'odom', rospy.Time.now()
            message.pose.pose.orientation.w = 1.0
            message.pose.covariance[::7] = [1e-6] * 6
            odometry.publish(message)
            return poses.last
        support.wait_for(send, 'a pose')
        return ekf

    def test_each_is_named_if_it_is_asked_for(self):
        process = self.start('true')
        for line in LINES:
            self.assertEqual(process.output.count(line), 1, process.output)
        process.kill()
        process = self.start('false')
        process.wait_for_line('Initially assumed floor')
        self.assertNotIn('[WARN]', process.output)


if __name__ == '__main__':
    support.main(TestUnsupportedInputs)
