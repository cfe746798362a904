"""The evaluation against GPS: projection, alignment and figures, for runs that are known exactly."""
from math import cos, pi, sin

from geometry_msgs.msg import Quaternion
from nav_msgs.msg import Odometry
import numpy
import pytest
import rosbag
import rospy
from sensor_msgs.msg import Imu, NavSatFix

import gps

BERLIN = 52.52, 13.405      # degrees
METRE, METRE_EAST = 111267.0, 67879.0   # m in a degree of latitude and of longitude there, by the radii of curvature
ROOT = 0.5 ** 0.5


def on_its_side(yaw):
    """The orientation of an IMU whose y axis points up, on a robot with this yaw."""
    c, s = cos(yaw / 2) * ROOT, sin(yaw / 2) * ROOT
    return Quaternion(c, s, s, c)


def write_bag(path, slip=1.0, bias=0.0):
    """A robot that rests for 5 s, then drives one and a half circles with a radius of 5 m. slip: wheels' turn / true
    turn; bias: of the gyro, rad/s."""
    radius, rate = 5.0, 0.2
    with rosbag.Bag(str(path), 'w') as bag:
        for tick in range(int((5 + 3 * pi / rate) * 50)):
            stamp = rospy.Time(1000 + tick / 50)
            turned = max(0.0, tick / 50 - 5) * rate
            moving = turned > 0

            odom = Odometry()
            odom.header.stamp, odom.header.frame_id = stamp, 'odom'
            odom.pose.pose.position.x = radius / slip * sin(turned * slip)
            odom.pose.pose.position.y = radius / slip * (1 - cos(turned * slip))
            odom.pose.pose.orientation = Quaternion(0, 0, sin(turned * slip / 2), cos(turned * slip / 2))
            odom.pose.covariance[::7] = odom.twist.covariance[::7] = [1e-3] * 6
            odom.twist.twist.linear.x, odom.twist.twist.angular.z = moving * radius * rate, moving * rate * slip
            bag.write('/odom', odom, stamp)

            imu = Imu()
            imu.header.stamp = stamp
            imu.orientation = on_its_side(turned)
            imu.angular_velocity.y = moving * rate + bias
            imu.angular_velocity_covariance[::4] = [1e-6] * 3
            bag.write('/imu/data', imu, stamp)

            if tick % 25 == 0:
                # north is the initial direction of the robot's x axis
                fix = NavSatFix(latitude=BERLIN[0] + radius * sin(turned) / METRE,
                                longitude=BERLIN[1] - radius * (1 - cos(turned)) / METRE_EAST)
                fix.header.stamp = stamp
                bag.write('/fix', fix, stamp)
    return str(path)


def judge(path):
    return gps.judge(gps.read_record(path, '/odom', '/imu/data', '/fix'))


def test_an_exact_run_is_exact(tmp_path):
    figures = judge(write_bag(tmp_path / 'exact.bag'))
    # 0.02 m: the degrees above are rounded; the gyro reading is taken at the end of its interval
    assert max(figures['filter'], figures['wheels'], figures['reckoned']) < 0.02


def test_wheels_that_slip_are_wrong_and_the_gyro_is_right(tmp_path):
    figures = judge(write_bag(tmp_path / 'slip.bag', slip=2.0, bias=0.05))
    assert figures['wheels'] > 1.0
    assert figures['reckoned'] < 0.1 and figures['filter'] < 0.3


def test_rotation_and_translation_do_not_count_and_a_mirror_image_does():
    stamps = numpy.arange(20.0)
    path = numpy.stack([stamps, stamps ** 2 / 20], 1)
    turned = path @ numpy.array([[cos(1), sin(1)], [-sin(1), cos(1)]]) + [100, -50]
    assert gps.rms_to_gps(stamps, path, (stamps, turned)) == pytest.approx(0.0, abs=1e-9)
    assert gps.rms_to_gps(stamps, path * [1, -1], (stamps, turned)) > 1.0
