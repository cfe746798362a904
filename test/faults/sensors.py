"""Good sensor messages for the filter, which a fault may spoil."""
import math
import threading
import time

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu


class Sensors(threading.Thread):
    """Sends odometry and a gyro's readings at 50 Hz: a robot on a circle. A fault may spoil what is sent."""

    def __init__(self, odom='/odom'):
        super().__init__(daemon=True)
        self.publishers = [rospy.Publisher(odom, Odometry, queue_size=100),
                           rospy.Publisher('/imu_data', Imu, queue_size=100)]
        self.spoil = lambda odom, imu: (odom, imu)
        self.turned = 0.0       # rad

    def run(self):
        while True:
            time.sleep(0.02)
            self.turned += 0.01
            odom, imu = Odometry(), Imu()
            imu.header.stamp = odom.header.stamp = rospy.Time.now()
            odom.header.frame_id, odom.child_frame_id = 'odom', 'base_footprint'
            odom.pose.pose.position.x, odom.pose.pose.position.y = math.sin(self.turned), 1 - math.cos(self.turned)
            turn(odom, self.turned)
            odom.pose.covariance[::7] = odom.twist.covariance[::7] = [1e-6] * 6
            imu.angular_velocity.z = 0.5
            imu.angular_velocity_covariance[8] = 1e-6
            for publisher, message in zip(self.publishers, self.spoil(odom, imu)):
                if message:
                    publisher.publish(message)


def turn(odom, heading):
    """Set the heading of an Odometry, rad."""
    rotation = odom.pose.pose.orientation
    rotation.z, rotation.w = math.sin(heading / 2), math.cos(heading / 2)
