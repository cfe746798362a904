#!/usr/bin/python3
"""A namespace called tf_prefix is not a prefix: the filter starts with the same frames as without a prefix."""

from geometry_msgs.msg import PoseWithCovarianceStamped

from still_robot import Sender, make_imu, make_odom
import support


class TestNamespaceCalledTfPrefix(support.Case):
    def test_the_filter_starts(self):
        poses = support.Watch('/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped)
        Sender('odom', make_odom)
        Sender('imu_data', make_imu)
        support.wait_for(lambda: poses.last, 'a pose')
        self.assertEqual(poses.last.header.frame_id, 'odom_combined')


if __name__ == '__main__':
    support.main(TestNamespaceCalledTfPrefix)
