#!/usr/bin/python3
"""The transform of the filter is from odom_combined to odom, and with the rest of the tree yields the estimate."""
import math

from geometry_msgs.msg import PoseWithCovarianceStamped
from tf2_msgs.msg import TFMessage

import support


def pose(transform):
    """Return (x, y, yaw) of a Transform."""
    rotation = transform.rotation
    return transform.translation.x, transform.translation.y, 2 * math.atan2(rotation.z, rotation.w)


class TestEkfFrames(support.Case):
    def test_each_frame_has_one_parent_and_the_tree_ends_at_the_estimate(self):
        parent, child = 'odom_combined', 'odom'
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        combined = support.Watch('odom_combined', PoseWithCovarianceStamped)
        republished = support.Watch('/odom_ekf', support.Odometry)
        for watch in transforms, combined, republished:
            support.wait_for(lambda: watch.last, watch.subscriber.name)
        commander = support.Commander()
        for linear, angular in [(0.2, 0.7), (-0.1, 0.9)]:
            commander.send(linear, angular)
            support.wait_for(lambda: odom.last.twist.twist.linear.x, 'the robot to move')
            odom.wait_for_twist(0.0)
        count = len(combined.messages)
        support.wait_for(lambda: len(combined.messages) > count + 10, 'combined poses after the motion')

        sent, parents = [], {}
        for message in list(transforms.messages):
            for transform in message.transforms:
                sent.append(transform)
                parents.setdefault(transform.child_frame_id, set()).add(
                    (transform.header.frame_id, message._connection_header['callerid']))
        self.assertEqual(parents[child], {(parent, '/robot_pose_ekf')})
        self.assertTrue(all(len(each) == 1 for each in parents.values()), parents)

        odom_by_stamp = {m.header.stamp: m for m in list(odom.messages)}
        transform_by_stamp = {t.header.stamp: t for t in sent if t.child_frame_id == child}
        republished_by_stamp = {m.header.stamp: m for m in list(republished.messages)}
        compared = 0
        for message in list(combined.messages):
            stamp = message.header.stamp
            self.assertEqual(message.header.frame_id, parent)
            if not (stamp in odom_by_stamp and stamp in transform_by_stamp and stamp in republished_by_stamp):
                continue
            compared += 1
            x, y, yaw = pose(transform_by_stamp[stamp].transform)
            base = support.pose(odom_by_stamp[stamp])
            x, y, yaw = (x + base[0] * math.cos(yaw) - base[1] * math.sin(yaw),
                         y + base[0] * math.sin(yaw) + base[1] * math.cos(yaw), yaw + base[2])
            # 1e-9 is far above the rounding errors of two rotations
            self.assertAlmostEqual(x, message.pose.pose.position.x, delta=1e-9)
            self.assertAlmostEqual(y, message.pose.pose.position.y, delta=1e-9)
            self.assertAlmostEqual(support.wrapped(yaw - support.yaw(message)), 0, delta=1e-9)
            # /odom_ekf has the same pose and covariance, and the frames of the odometry
            visible = republished_by_stamp[stamp]
            self.assertEqual(visible.pose, message.pose)
            self.assertEqual((visible.header.frame_id, visible.child_frame_id), ('odom', 'base_footprint'))
        self.assertGreater(compared, 20)


if __name__ == '__main__':
    support.main(TestEkfFrames)
