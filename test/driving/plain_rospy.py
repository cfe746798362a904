#!/usr/bin/python3
"""A driver of rospy, tf and rbx1_nav.transform_utils alone, as in tutorials: half a meter forward, a quarter turn."""
from math import hypot, pi

import rospy
import tf
from geometry_msgs.msg import Quaternion, Twist

from rbx1_nav.transform_utils import normalize_angle, quat_to_angle

SPEED, TURN_SPEED = 0.2, 0.5    # m/s, rad/s


class Driver:
    def __init__(self):
        rospy.init_node('plain_rospy')
        rospy.on_shutdown(self.stop)
        self.cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)
        self.listener = tf.TransformListener()
        rospy.sleep(2)
        # tf, unlike tf2, accepts a leading slash, as old scripts have it
        self.listener.waitForTransform('/odom', '/base_footprint', rospy.Time(), rospy.Duration(60))
        command, rate = Twist(), rospy.Rate(20)
        start, _ = self.pose()
        command.linear.x = SPEED
        while hypot(*(a - b for a, b in zip(self.pose()[0], start))) < 0.5 and not rospy.is_shutdown():
            self.cmd_vel.publish(command)
            rate.sleep()
        self.cmd_vel.publish(Twist())
        rospy.sleep(1)
        command, turned, last = Twist(), 0.0, self.pose()[1]
        command.angular.z = TURN_SPEED
        while turned < pi / 2 and not rospy.is_shutdown():
            self.cmd_vel.publish(command)
            rate.sleep()
            heading = self.pose()[1]
            turned += normalize_angle(heading - last)
            last = heading
        self.cmd_vel.publish(Twist())
        rospy.sleep(1)

    def pose(self):
        """((x, y), heading): m and rad."""
        position, rotation = self.listener.lookupTransform('/odom', '/base_footprint', rospy.Time(0))
        return position[:2], quat_to_angle(Quaternion(*rotation))

    def stop(self):
        self.cmd_vel.publish(Twist())


if __name__ == '__main__':
    Driver()
