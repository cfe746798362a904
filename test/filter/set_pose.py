#!/usr/bin/python3
"""set_pose moves the estimate to a pose in the output frame; an invalid pose, or one in another frame, is rejected."""
import math

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log

from still_robot import Sender, make_imu, make_odom
import support


def make_pose(frame_id, x, y, yaw):
    """Return a message for set_pose."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id = frame_id
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation.z, message.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    message.pose.covariance[0] = message.pose.covariance[7] = 0.25
    message.pose.covariance[35] = 0.01
    return message


class TestSetPose(support.Case):
    def test_poses_in_the_output_frame_and_others(self):
        log = support.Watch('/rosout', Log)
        poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        estimates = support.Watch('/robot_pose_ekf/odometry', Odometry)
        publisher = rospy.Publisher('/set_pose', PoseWithCovarianceStamped, queue_size=10)
        support.wait_for(publisher.get_num_connections, 'the filter to subscribe to /set_pose')

        def wait_for_log(text):
            support.wait_for(lambda: any(
                m.name == '/robot_pose_ekf' and text in m.msg for m in list(log.messages)), text)

        def is_at(x, y, yaw):
            at = poses.last and support.pose(poses.last)
            return at and math.hypot(at[0] - x, at[1] - y) < 1e-6 and abs(support.wrapped(at[2] - yaw)) < 1e-3
        publisher.publish(make_pose('odom_combined', 3.0, 4.0, 1.0))
        wait_for_log('/set_pose: odom: None: expected a message before this one; rejected')

        Sender('odom', make_odom)
        Sender('imu_data', make_imu)
        support.wait_for(lambda: estimates.last and is_at(0.5, 0.0, 0.0), 'the pose of the odometry')
        for frame_id, pose in ('odom_combined', (3.0, 4.0, 1.0)), ('', (-2.0, 1.0, -3.0)):
            publisher.publish(make_pose(frame_id, *pose))
            support.wait_for(lambda: is_at(*pose), f'the pose {pose}')
            covariance = poses.next().pose.covariance
            self.assertAlmostEqual(covariance[0], 0.25, delta=0.01)
            self.assertAlmostEqual(covariance[35], 0.01, delta=0.001)
        # set_pose is not a motion
        self.assertLess(max(abs(m.twist.twist.angular.z) for m in estimates.messages), 0.01)

        publisher.publish(make_pose('map', 0.0, 0.0, 0.0))
        wait_for_log("/set_pose: header.frame_id: 'map': expected odom_combined, the output_frame; rejected")
        poses.next()
        self.assertTrue(is_at(-2.0, 1.0, -3.0))


if __name__ == '__main__':
    support.main(TestSetPose)
