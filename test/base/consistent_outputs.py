#!/usr/bin/python3
"""Odometry, transform and wheel angles describe the same motion."""
import unittest

from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

import support

WIDTH, RADIUS = 0.26, 0.033     # m, of the TurtleBot's configuration


class TestConsistentOutputs(unittest.TestCase):
    def test_transform_and_wheel_angles_agree_with_the_odometry(self):
        support.init_node('consistent_outputs')
        odom = support.OdomWatch()
        transforms = support.Watch('/tf', TFMessage)
        joints = support.Watch('/joint_states', JointState)
        commander = support.Commander()
        for linear, angular in [(0.2, 0.7), (0.1, -0.4)]:
            commander.send(linear, angular)
            odom.wait_for_twist(linear, angular, since=0)
            odom.wait_for_twist(0.0)
        end = odom.last.header.stamp
        support.wait_for(lambda: joints.last and joints.last.header.stamp > end, 'joint states after the motion')

        # each transform has exactly the pose of the odometry with the same stamp
        poses = {m.header.stamp: m for m in list(odom.messages)}
        sent = [t for m in list(transforms.messages) for t in m.transforms
                if t.child_frame_id == 'base_footprint' and t.header.stamp in poses]
        self.assertGreater(len(sent), 50)
        for transform in sent:
            message = poses[transform.header.stamp]
            self.assertEqual((transform.header.frame_id, message.header.frame_id, message.child_frame_id),
                             ('odom', 'odom', 'base_footprint'))
            self.assertEqual((transform.transform.translation.x, transform.transform.translation.y),
                             (message.pose.pose.position.x, message.pose.pose.position.y))
            self.assertEqual(transform.transform.rotation, message.pose.pose.orientation)

        # the difference of the wheels gives the heading; 1e-9 rad is far above rounding
        state = joints.last
        angles = dict(zip(state.name, state.position))
        heading = (angles['base_r_wheel_joint'] - angles['base_l_wheel_joint']) * RADIUS / WIDTH
        self.assertAlmostEqual(support.wrapped(heading - support.yaw(odom.last)), 0, delta=1e-9)
        # 0.2 m and 0.1 m, each during the timeout of 1.0 s
        distance = (angles['base_r_wheel_joint'] + angles['base_l_wheel_joint']) * RADIUS / 2
        self.assertAlmostEqual(distance, 0.3, delta=support.MICROMETRE)
        for variance in (0, 7, 14, 21, 28, 35):
            self.assertGreater(odom.last.pose.covariance[variance], 0)
            self.assertGreater(odom.last.twist.covariance[variance], 0)


if __name__ == '__main__':
    support.main('consistent_outputs', TestConsistentOutputs)
