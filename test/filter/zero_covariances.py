#!/usr/bin/python3
"""An IMU without covariances is used with robot_pose_ekf's covariances; odometry without covariances is rejected."""
import unittest

from altered import AlteredRobot
import support


def without_covariances(imu):
    """Set the covariances to zero, as many IMU drivers do."""
    imu.angular_velocity_covariance = imu.orientation_covariance = [0.0] * 9


class TestZeroCovariances(unittest.TestCase):
    def test_of_an_imu_and_of_odometry(self):
        support.init_node('zero_covariances')
        known = []

        def odometry_without(odom):
            if not known:
                odom.pose.covariance = odom.twist.covariance = [0.0] * 36
        robot = AlteredRobot(odometry_without, without_covariances)
        robot.wait_for_line('/odom_altered: pose.covariance[0]: 0.0: expected a variance above 0')
        self.assertEqual(robot.estimates.messages, [])

        known.append(True)
        robot.estimates.next()
        robot.turn()
        robot.check_heading(self)
        self.assertEqual(robot.lines('/imu_altered'), [
            '/imu_altered: no angular velocity covariance: assuming 0.00017 rad/s'])


if __name__ == '__main__':
    support.main('zero_covariances', TestZeroCovariances)
