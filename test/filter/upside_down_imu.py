#!/usr/bin/python3
"""An IMU that is mounted upside down is used as soon as there is a transform to its frame, which rotates it."""
import rospy
from geometry_msgs.msg import Quaternion, TransformStamped
from tf2_msgs.msg import TFMessage

from altered import AlteredRobot
import support


def upside_down(imu):
    """Change the message to the message of an IMU that is rolled by 180 degrees."""
    imu.header.frame_id = 'imu_link'
    imu.angular_velocity.y *= -1
    imu.angular_velocity.z *= -1
    heading = imu.orientation
    imu.orientation = Quaternion(heading.w, heading.z, -heading.y, -heading.x)      # times the roll (1, 0, 0, 0)


class TestUpsideDownImu(support.Case):
    def test_it_is_turned_by_the_transform(self):
        robot = AlteredRobot(imu=upside_down)
        robot.wait_for_line("/imu_altered: header.frame_id: 'imu_link': expected a transform from base_footprint to it")
        robot.estimates.next()      # from the wheels alone

        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = 'base_link', 'imu_link'
        transform.transform.rotation.x = 1.0
        publisher = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        publisher.publish([transform])
        robot.wait_for_line('rotating readings from imu_link to base_footprint, vertical axis tilted by 180 degrees')
        robot.turn()
        robot.check_heading(self)

        # the transform is looked up once
        transform.transform.rotation.x, transform.transform.rotation.w = 0.0, 1.0
        publisher.publish([transform])
        robot.turn()
        robot.check_heading(self)


if __name__ == '__main__':
    support.main(TestUpsideDownImu)
