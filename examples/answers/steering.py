#!/usr/bin/python3
"""Drive out and back with odometry and gyro, and steer on the legs, so that the robot stays on the line to its goal."""
from rbx1_nav.driving import Drive

from math import cos, pi, remainder, sin

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav.driving.odometry import PoseListener, Straight, Turn

OFFSET_GAIN = 10.0      # rad/s for each meter beside the line
HEADING_GAIN = 3.0      # rad/s for each radian between the heading and the direction of the line


def steering(pose, start, direction):
    """Return the turning speed (rad/s) that leads to the line through the pose `start` in a direction (rad)."""
    to_the_left = (pose.y - start.y) * cos(direction) - (pose.x - start.x) * sin(direction)
    return -OFFSET_GAIN * to_the_left - HEADING_GAIN * remainder(pose.yaw - direction, 2 * pi)


def drive(leg, odom, correction):
    """Drive a leg to its goal. correction(pose): returns the turning speed on a straight leg, rad/s."""
    for rest in leg.rests:
        move_cmd = Twist()
        r = rospy.Rate(50)
        speed = leg.next_speed(odom.pose())
        while speed:
            move_cmd.linear.x, move_cmd.angular.z = leg.velocity(speed)
            if move_cmd.linear.x:
                move_cmd.angular.z = correction(leg.last)
            cmd_vel.publish(move_cmd)
            r.sleep()
            speed = leg.next_speed(odom.pose())
        cmd_vel.publish(Twist())
        rospy.sleep(rest)


def drive_out_and_back(odom):
    start = odom.pose()
    for direction in start.yaw, start.yaw + pi:
        for leg in Straight('forward', 1.0, 0.2, 0.05, 50), Turn('turn left', pi, 1.0, 0.2, 50):
            drive(leg, odom, lambda pose: steering(pose, start, direction))


def shutdown():
    cmd_vel.publish(Twist())
    rospy.sleep(1)


if __name__ == '__main__':
    rospy.init_node('out_and_back')
    rospy.on_shutdown(shutdown)
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
    odom = PoseListener('odom_combined', None, 0.2, 1.0, 5)     # frames; highest speeds, m/s and rad/s; timeout, s
    with Drive(cmd_vel, timed=False):
        drive_out_and_back(odom)
