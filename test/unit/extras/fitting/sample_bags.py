"""Writes bags for tests with rosbag, with the messages that a base would have published in a run."""
from math import cos, pi, sin

from geometry_msgs.msg import PoseStamped, Quaternion, Twist
from nav_msgs.msg import Odometry
import rosbag
import rospy
from sensor_msgs.msg import Imu

RATE = 20       # Hz
MOTIONS = ((0.0, 0.0, 10), (0.2, 0.0, 30), (0.0, 1.0, 63), (0.2, 0.5, 20), (0.0, 0.0, 10))   # m/s, rad/s, ticks


def twist(linear, angular):
    """Return a Twist."""
    message = Twist()
    message.linear.x, message.angular.z = linear, angular
    return message


def odometry(stamp, x, y, yaw):
    """Return an Odometry message; stamp: s."""
    message = Odometry()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.header.frame_id, message.child_frame_id = 'odom', 'base_footprint'
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.pose.pose.orientation = Quaternion(0.0, 0.0, sin(yaw / 2), cos(yaw / 2))
    return message


def pose_stamped(stamp, x, y, yaw):
    """Return a PoseStamped message; stamp: s."""
    message = PoseStamped()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.pose = odometry(stamp, x, y, yaw).pose.pose
    return message


def imu(stamp, rate):
    """Return an Imu message; stamp: s, rate: rad/s."""
    message = Imu()
    message.header.stamp = rospy.Time.from_sec(stamp)
    message.angular_velocity.z = rate
    return message


def run_messages(motions=MOTIONS, start=100.0):
    """Return [(topic, message, time)] of a run on the ideal floor, on which the base follows immediately."""
    messages, now, x, y, yaw = [], start, 0.0, 0.0, 0.0
    for linear, angular, ticks in motions:
        for _ in range(ticks):
            messages += [('/odom', odometry(now, x, y, yaw), now), ('/ground_truth', odometry(now, x, y, yaw), now),
                         ('/imu/data', imu(now, angular), now), ('/cmd_vel', twist(linear, angular), now)]
            now += 1 / RATE
            x, y, yaw = x + linear / RATE * cos(yaw), y + linear / RATE * sin(yaw), (yaw + angular / RATE) % (2 * pi)
    return messages


def write_bag(path, messages):
    """Write a bag of (topic, message, time in s)."""
    with rosbag.Bag(path, 'w') as bag:
        for topic, message, time in messages:
            bag.write(topic, message, rospy.Time.from_sec(time))
    return str(path)
