#!/usr/bin/python3
"""Of an IMU without an angular velocity, the filter uses the change of the orientation."""
import unittest

from geometry_msgs.msg import Vector3

from altered import AlteredRobot
import support


def orientation_only(imu):
    """What an IMU sends that has no angular velocity, by the definition of the message."""
    imu.angular_velocity = Vector3()
    imu.angular_velocity_covariance = [-1.0] + [0.0] * 8


class TestOrientationOnlyImu(unittest.TestCase):
    def test_the_change_of_the_orientation_is_used(self):
        support.init_node('orientation_only_imu')
        robot = AlteredRobot(imu=orientation_only)
        robot.turn()
        robot.check_heading(self)
        self.assertEqual(robot.lines('/imu_altered'), [
            '/imu_altered: no angular velocity: the change of its orientation is used'])


if __name__ == '__main__':
    support.main('orientation_only_imu', TestOrientationOnlyImu)
