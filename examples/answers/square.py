#!/usr/bin/python3
"""Drive a square, timed: four sides of 1 m, and a quarter turn to the left after each.

Ticks are whole numbers. Wait only with r.sleep() and drive.rest(): rospy's own sleep functions ignore Ctrl-C here.
"""
from rbx1_nav.ros.driving.script import TimedDrive, exit_status, init_node

import time

import rospy
from geometry_msgs.msg import Twist

# name, m/s, rad/s, ticks of 20 ms: 1 m takes 5 s, and a quarter turn pi / 2 s, which is 78.5 ticks
MOTIONS = ('forward', 0.2, 0.0, 250), ('turn left', 0.0, 1.0, 78)


def shutdown():
    cmd_vel.publish(Twist())
    time.sleep(1)


with exit_status():
    init_node('square', __doc__)
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
    with TimedDrive(cmd_vel, 50, shutdown) as drive:    # 50 commands per second
        for side in range(4):
            for name, linear_speed, angular_speed, ticks in MOTIONS:
                move_cmd = Twist()
                move_cmd.linear.x = linear_speed
                move_cmd.angular.z = angular_speed
                r = drive.Rate()
                for _ in drive.progress(name, ticks, move_cmd):
                    cmd_vel.publish(move_cmd)
                    r.sleep()
                cmd_vel.publish(Twist())
                drive.rest(1)
