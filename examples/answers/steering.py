#!/usr/bin/python3
"""Drive out and back with odometry and gyro, and steer on the legs, so that the robot stays on the line to its goal."""
from rbx1_nav.ros.driving.script import exit_status, init_node

from math import cos, pi, remainder, sin
import time

import rospy
from geometry_msgs.msg import Twist

from rbx1_nav.control.legs import Straight, Turn
from rbx1_nav.ros.driving.pose_drive import OdomDrive
from rbx1_nav.ros.driving.pose_listener import PoseListener

OFFSET_GAIN = 10.0      # rad/s for each meter beside the line
HEADING_GAIN = 3.0      # rad/s for each radian between the heading and the direction of the line


def steering(pose, start, direction):
    """Return the turning speed (rad/s) that leads to the line through the pose `start` in a direction (rad)."""
    to_the_left = (pose.y - start.y) * cos(direction) - (pose.x - start.x) * sin(direction)
    return -OFFSET_GAIN * to_the_left - HEADING_GAIN * remainder(pose.yaw - direction, 2 * pi)


def drive_out_and_back(cmd_vel, drive):
    for direction in drive.start.yaw, drive.start.yaw + pi:
        forward, turn_left = Straight('forward', 1.0, 0.2, 0.05, 50), Turn('turn left', pi, 1.0, 0.2, 50)
        move_cmd, r = Twist(), drive.Rate()
        for speed in drive.speeds(forward):
            move_cmd.linear.x = speed
            move_cmd.angular.z = steering(forward.last, drive.start, direction)
            cmd_vel.publish(move_cmd)
            r.sleep()
        cmd_vel.publish(Twist())
        drive.rest(1)
        move_cmd, r = Twist(), drive.Rate()
        for speed in drive.speeds(turn_left):
            move_cmd.angular.z = speed
            cmd_vel.publish(move_cmd)
            r.sleep()
        cmd_vel.publish(Twist())
        drive.rest(1)


def shutdown():
    cmd_vel.publish(Twist())
    time.sleep(1)


if __name__ == '__main__':
    with exit_status():
        init_node('out_and_back', __doc__)
        cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
        poses = PoseListener('odom_combined', None, 0.2, 1.0)       # frames; highest speeds, m/s and rad/s
        with OdomDrive(cmd_vel, 50, shutdown, poses, 5) as drive:   # 50 commands per second
            drive_out_and_back(cmd_vel, drive)
