#!/usr/bin/python3
"""With start_filter false, the combined pose of another filter is republished as /odom_ekf."""
import rosnode
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

import support


class TestRepublish(support.Case):
    def test_the_pose_of_another_filter_is_republished(self):
        republished = support.Watch('/odom_ekf', support.Odometry)
        odom = rospy.Publisher('odom', support.Odometry, queue_size=1, latch=True)
        frames = support.Odometry()
        frames.header.frame_id, frames.child_frame_id = 'odom', 'base_link'
        odom.publish(frames)

        poses = rospy.Publisher('robot_pose_ekf/odom_combined', PoseWithCovarianceStamped, queue_size=10)
        pose = PoseWithCovarianceStamped()
        pose.header.frame_id = 'odom_combined'
        pose.pose.pose.orientation.w = 1.0
        pose.pose.covariance[0] = 0.25

        def send():
            pose.header.stamp = rospy.Time.from_sec(pose.header.stamp.to_sec() + 0.1)
            pose.pose.pose.position.x += 0.02
            poses.publish(pose)
            return len(republished.messages) > 5
        support.wait_for(send, '/odom_ekf')
        message = republished.last
        self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom', 'base_link'))
        self.assertEqual(message.pose.covariance[0], 0.25)
        self.assertEqual(message.twist.covariance[0], 1e6)
        self.assertNotIn('/robot_pose_ekf', rosnode.get_node_names())


if __name__ == '__main__':
    support.main(TestRepublish)
