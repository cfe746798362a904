#!/usr/bin/python3
"""An IMU without covariances is used with robot_pose_ekf's covariances; odometry does not need any."""
from altered import AlteredRobot
import support


def without_covariances(imu):
    """Set the covariances to zero, as many IMU drivers do."""
    imu.angular_velocity_covariance = imu.orientation_covariance = [0.0] * 9


class TestZeroCovariances(support.Case):
    def test_of_an_imu_and_of_odometry(self):

        def odometry_without(odom):
            odom.pose.covariance = odom.twist.covariance = [0.0] * 36
        robot = AlteredRobot(odometry_without, without_covariances)
        robot.estimates.next()
        robot.turn()
        robot.check_heading(self)
        self.assertEqual(robot.lines('/imu_altered'), [
            '/imu_altered: no angular velocity covariance: assuming 0.00017 rad/s'])
        self.assertEqual(robot.lines('/odom_altered'), [])


if __name__ == '__main__':
    support.main(TestZeroCovariances)
