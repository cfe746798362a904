#!/usr/bin/python3
"""Odometry, transform, wheel angles, and on the ideal surface ground truth and gyro, describe the same motion."""
from sensor_msgs.msg import Imu, JointState
from tf2_msgs.msg import TFMessage

import support

WIDTH, RADIUS = 0.26, 0.033     # m, of the TurtleBot's configuration
MOTIONS = (0.2, 0.7), (0.1, -0.4)       # m/s, rad/s


class TestConsistentOutputs(support.Case):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.odom = support.OdomWatch()
        cls.transforms = support.Watch('/tf', TFMessage)
        cls.joints = support.Watch('/joint_states', JointState)
        cls.truth = support.Watch('/ground_truth', support.Odometry)
        cls.imu = support.Watch('/imu/data', Imu)
        commander = support.Commander()
        support.wait_for(lambda: cls.truth.last and cls.imu.last and cls.joints.last, 'all topics')
        cls.start = cls.joints.last     # a reset of the base does not turn its wheels back
        for linear, angular in MOTIONS:
            commander.send(linear, angular)
            cls.odom.wait_for_twist(linear, angular, since=0)
            cls.odom.wait_for_twist(0.0)
        end = cls.odom.last.header.stamp
        support.wait_for(lambda: min(
            watch.last.header.stamp for watch in (cls.joints, cls.truth, cls.imu)) > end, 'messages after the motion')
        cls.odometry = {message.header.stamp: message for message in list(cls.odom.messages)}

    def with_odometry(self, messages):
        """Return the messages of which there is odometry with the same stamp."""
        found = [message for message in messages if message.header.stamp in self.odometry]
        self.assertGreater(len(found), 50)
        return found

    def test_each_transform_has_exactly_the_pose_of_the_odometry_with_the_same_stamp(self):
        for transform in self.with_odometry([t for m in list(self.transforms.messages) for t in m.transforms
                                             if t.child_frame_id == 'base_footprint']):
            message = self.odometry[transform.header.stamp]
            self.assertEqual((transform.header.frame_id, message.header.frame_id, message.child_frame_id),
                             ('odom', 'odom', 'base_footprint'))
            self.assertEqual((transform.transform.translation.x, transform.transform.translation.y),
                             (message.pose.pose.position.x, message.pose.pose.position.y))
            self.assertEqual(transform.transform.rotation, message.pose.pose.orientation)

    def test_the_wheels(self):
        # the difference of the wheels gives the heading; 1e-9 rad is far above rounding
        names, end = self.joints.last.name, self.joints.last.position
        travel = {name: (after - before) * RADIUS for name, before, after in zip(names, self.start.position, end)}
        heading = (travel['base_r_wheel_joint'] - travel['base_l_wheel_joint']) / WIDTH
        self.assertAlmostEqual(support.wrapped(heading - support.yaw(self.odom.last)), 0, delta=1e-9)
        # 0.2 m and 0.1 m, each during the timeout of 1.0 s
        distance = (travel['base_r_wheel_joint'] + travel['base_l_wheel_joint']) / 2
        self.assertAlmostEqual(distance, 0.3, delta=support.MICROMETRE)

    def test_the_covariances(self):
        for variance in (0, 7, 14, 21, 28, 35):
            self.assertGreater(self.odom.last.pose.covariance[variance], 0)
            self.assertGreater(self.odom.last.twist.covariance[variance], 0)

    def test_the_ground_truth(self):
        for message in self.with_odometry(list(self.truth.messages)):
            other = self.odometry[message.header.stamp]
            self.assertEqual(message.pose.pose, other.pose.pose)
            self.assertEqual(message.twist.twist, other.twist.twist)
            self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom', 'base_footprint'))

    def test_the_gyro(self):
        readings = self.with_odometry(list(self.imu.messages))
        rates = {0.0, *(angular for _, angular in MOTIONS)}
        for message in readings:
            self.assertEqual(message.header.frame_id, 'base_footprint')
            self.assertEqual(message.orientation, self.odometry[message.header.stamp].pose.pose.orientation)
            # the mean since the last reading, which is in between if the command has changed
            rate = message.angular_velocity.z
            self.assertTrue(any(abs(rate - each) < 1e-9 for each in rates) or -0.4 < rate < 0.7, rate)
            for covariance in (message.orientation_covariance, message.angular_velocity_covariance):
                self.assertTrue(all(covariance[i] > 0 for i in (0, 4, 8)), covariance)
            self.assertEqual(message.linear_acceleration_covariance[0], -1)
        for _, rate in MOTIONS:
            self.assertTrue(any(abs(m.angular_velocity.z - rate) < 1e-9 for m in readings), rate)


if __name__ == '__main__':
    support.main(TestConsistentOutputs)
