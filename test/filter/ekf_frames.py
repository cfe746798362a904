#!/usr/bin/python3
"""The filter's transform: ekf_frames.py PARENT CHILD. One parent for each frame, and the pose at the end of the way."""
import math
import sys
import unittest

from geometry_msgs.msg import PoseWithCovarianceStamped
from tf2_msgs.msg import TFMessage

import support


def pose(transform):
    """(x, y, yaw) of a Transform."""
    rotation = transform.rotation
    return transform.translation.x, transform.translation.y, 2 * math.atan2(rotation.z, rotation.w)


class TestEkfFrames(unittest.TestCase):
    def test_frames(self):
        parent, child, _ = sys.argv[1:4]
        support.init_node('ekf_frames')
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        combined = support.Watch('odom_combined', PoseWithCovarianceStamped)
        visible = support.Watch('/odom_ekf', support.Odometry)
        support.wait_for(lambda: visible.last, '/odom_ekf')
        commander = support.Commander()
        for linear, angular in [(0.2, 0.7), (-0.1, 0.9)]:
            commander.send(linear, angular)
            support.wait_for(lambda: odom.last.twist.twist.linear.x, 'the robot to move')
            odom.wait_for_twist(0.0)
        count = len(combined.messages)
        support.wait_for(lambda: len(combined.messages) > count + 10, 'combined poses after the motion')

        told, parents = [], {}
        for message in list(transforms.messages):
            for transform in message.transforms:
                told.append(transform)
                parents.setdefault(transform.child_frame_id, set()).add(
                    (transform.header.frame_id, message._connection_header['callerid']))
        self.assertEqual(parents[child], {(parent, '/robot_pose_ekf')})
        self.assertTrue(all(len(each) == 1 for each in parents.values()), parents)

        odometry = {m.header.stamp: m for m in list(odom.messages)}
        ours = {t.header.stamp: t for t in told if t.child_frame_id == child}
        seen = {m.header.stamp: m for m in list(visible.messages)}
        compared = 0
        for message in list(combined.messages):
            stamp = message.header.stamp
            self.assertEqual(message.header.frame_id, parent)
            if not (stamp in odometry and stamp in ours and stamp in seen):
                continue
            compared += 1
            x, y, yaw = pose(ours[stamp].transform)
            if child == 'odom':
                there = support.pose(odometry[stamp])
                x, y, yaw = (x + there[0] * math.cos(yaw) - there[1] * math.sin(yaw),
                             y + there[0] * math.sin(yaw) + there[1] * math.cos(yaw), yaw + there[2])
            # 1e-9: what floats lose in a rotation and back
            self.assertAlmostEqual(x, message.pose.pose.position.x, delta=1e-9)
            self.assertAlmostEqual(y, message.pose.pose.position.y, delta=1e-9)
            self.assertAlmostEqual(support.wrapped(yaw - support.yaw(message)), 0, delta=1e-9)
            # made visible: the same pose and covariance, in the frames that RViz shows the wheels' odometry in
            self.assertEqual(seen[stamp].pose, message.pose)
            self.assertEqual((seen[stamp].header.frame_id, seen[stamp].child_frame_id), ('odom', 'base_footprint'))
        self.assertGreater(compared, 20)
        self.assertGreater(max(m.twist.twist.linear.x for m in visible.messages), 0.1)


if __name__ == '__main__':
    support.main('ekf_frames', TestEkfFrames)
