#!/usr/bin/python3
"""On the ideal surface, ground truth and gyro agree with the odometry."""
import unittest

from sensor_msgs.msg import Imu

import support


class TestIdealSensors(unittest.TestCase):
    def test_ground_truth_and_gyro_agree_with_the_odometry(self):
        support.init_node('ideal_sensors')
        odom = support.OdomWatch()
        truth = support.Watch('/ground_truth', support.Odometry)
        imu = support.Watch('/imu/data', Imu)
        commander = support.Commander()
        support.wait_for(lambda: truth.last and imu.last, '/ground_truth and /imu/data')
        for linear, angular in [(0.2, 0.7), (0.1, -0.4)]:
            commander.send(linear, angular)
            odom.wait_for_twist(linear, angular, since=0)
            odom.wait_for_twist(0.0)
        end = odom.last.header.stamp
        support.wait_for(lambda: min(truth.last.header.stamp, imu.last.header.stamp) >= end, 'all messages')

        odometry = {m.header.stamp: m for m in list(odom.messages)}
        true = [m for m in list(truth.messages) if m.header.stamp in odometry]
        self.assertGreater(len(true), 50)
        for message in true:
            other = odometry[message.header.stamp]
            self.assertEqual(message.pose.pose, other.pose.pose)
            self.assertEqual(message.twist.twist, other.twist.twist)
            self.assertEqual((message.header.frame_id, message.child_frame_id), ('odom', 'base_footprint'))

        readings = [m for m in list(imu.messages) if m.header.stamp in odometry]
        self.assertGreater(len(readings), 50)
        rates = {0.0, 0.7, -0.4}
        for message in readings:
            self.assertEqual(message.header.frame_id, 'base_footprint')
            self.assertEqual(message.orientation, odometry[message.header.stamp].pose.pose.orientation)
            # the mean since the last reading, which is in between if the command has changed
            rate = message.angular_velocity.z
            self.assertTrue(any(abs(rate - each) < 1e-9 for each in rates) or -0.4 < rate < 0.7, rate)
            for covariance in (message.orientation_covariance, message.angular_velocity_covariance):
                self.assertTrue(all(covariance[i] > 0 for i in (0, 4, 8)), covariance)
            self.assertEqual(message.linear_acceleration_covariance[0], -1)
        for rate in (0.7, -0.4):
            self.assertTrue(any(abs(m.angular_velocity.z - rate) < 1e-9 for m in readings), rate)


if __name__ == '__main__':
    support.main('ideal_sensors', TestIdealSensors)
