#!/usr/bin/python3
"""Drive a square, timed: four sides of 1 m, and a quarter turn to the left after each.

Ticks are whole numbers. Wait only with r.sleep() and drive.rest(): rospy's own sleep functions ignore Ctrl-C here.
"""
from rbx1_nav.ros.driving.script import TimedDrive, exit_status, init_node

import time

import rospy
from geometry_msgs.msg import Twist


def shutdown():
    cmd_vel.publish(Twist())
    time.sleep(1)


with exit_status():
    init_node('square', __doc__)
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
    with TimedDrive(cmd_vel, 50, shutdown) as drive:    # 50 commands per second
        for side in range(4):
            # Fill this in: drive forward, stop and rest; turn left, stop and rest.
            pass
