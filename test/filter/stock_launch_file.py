#!/usr/bin/python3
"""With a new pkg and type, robot_pose_ekf's launch file yields the combined pose and one connected tree of frames."""
import rospy
import tf2_ros
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

import support


class TestStockLaunchFile(support.Case):
    def test_the_pose_and_the_tree(self):
        log = support.Watch('/rosout', Log)
        odom = support.Watch('/pr2_base_odometry/odom', Odometry)
        truth = support.Watch('/ground_truth', Odometry)
        poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        transforms = support.Watch('/tf', TFMessage)
        buffer = tf2_ros.Buffer()
        self.listener = tf2_ros.TransformListener(buffer)
        commander = support.Commander()

        def combined_transforms():
            return [t for m in list(transforms.messages) for t in m.transforms
                    if m._connection_header['callerid'] == '/robot_pose_ekf']
        support.wait_for(combined_transforms, 'a transform of the filter')
        for _ in range(3):
            commander.send(0.2, 0.7)
            support.wait_for(lambda: odom.last.twist.twist.linear.x, 'the robot to move')
            support.wait_for(lambda: not odom.last.twist.twist.linear.x, 'the robot to stop')
        count = len(poses.messages)
        support.wait_for(lambda: len(poses.messages) > count + 10, 'combined poses after the motion')

        x, y, yaw = support.pose(poses.last)
        true_x, true_y, true_yaw = support.pose(truth.last)
        # 0.5 m and 2 rad on carpet: five standard deviations of the wheel measurements, and a few percent
        self.assertAlmostEqual(x, true_x, delta=0.15)
        self.assertAlmostEqual(y, true_y, delta=0.15)
        self.assertAlmostEqual(support.wrapped(yaw - true_yaw), 0.0, delta=0.05)
        self.assertGreater(abs(true_yaw), 1.0)

        self.assertEqual({(t.header.frame_id, t.child_frame_id) for t in combined_transforms()},
                         {('odom_combined', 'base_footprint')})
        poses_by_stamp = {m.header.stamp: m for m in list(poses.messages)}
        last = combined_transforms()[-1]
        pose = poses_by_stamp[last.header.stamp]
        self.assertEqual(pose.header.frame_id, 'odom_combined')
        self.assertEqual((last.transform.translation.x, last.transform.rotation), (
            pose.pose.pose.position.x, pose.pose.pose.orientation))
        rotation = pose.pose.pose.orientation
        self.assertEqual((pose.pose.pose.position.z, rotation.x, rotation.y), (0, 0, 0))
        self.assertEqual([pose.pose.covariance[7 * axis] for axis in (2, 3, 4)], [1e6] * 3)
        services = [name for name, _ in rospy.get_master().getSystemState()[2][2]]
        self.assertIn('/robot_pose_ekf/get_loggers', services)
        self.assertNotIn('/robot_pose_ekf/get_status', services)
        for frame in 'base_footprint', 'base_link', 'base_l_wheel_link', 'gyro_link':
            support.wait_for(lambda: buffer.can_transform('odom_combined', frame, rospy.Time()), f'the frame {frame}')

        # 30 Hz from messages that arrive at 50 Hz: every second one, or two of three
        stamps = [m.header.stamp.to_sec() for m in poses.messages]
        self.assertAlmostEqual((len(stamps) - 1) / (stamps[-1] - stamps[0]), 30, delta=6)
        self.assertEqual([m.msg for m in log.messages if m.name == '/robot_pose_ekf' and 'transform' in m.msg], [
            'Publishing the transform odom_combined -> base_footprint (no other node publishes a transform to '
            'base_footprint)'])


if __name__ == '__main__':
    support.main(TestStockLaunchFile)
