#!/usr/bin/python3
"""If an IMU sends no angular velocity, the filter uses the change of its orientation."""

from geometry_msgs.msg import Vector3

from altered import AlteredRobot
import support


def orientation_only(imu):
    """Mark the angular velocity as not measured, as defined for the message."""
    imu.angular_velocity = Vector3()
    imu.angular_velocity_covariance = [-1.0] + [0.0] * 8


class TestOrientationOnlyImu(support.Case):
    def test_the_change_of_the_orientation_is_used(self):
        robot = AlteredRobot(imu=orientation_only)
        robot.turn()
        robot.check_heading(self)
        self.assertEqual(robot.lines('/imu_altered'), [
            '/imu_altered: no angular velocity: using the change in orientation instead'])


if __name__ == '__main__':
    support.main(TestOrientationOnlyImu)
