#!/usr/bin/python3
"""Drive a square, timed: four sides of 1 m, and a quarter turn to the left after each."""
from rbx1_nav.driving import Drive

import rospy
from geometry_msgs.msg import Twist


def shutdown():
    cmd_vel.publish(Twist())
    rospy.sleep(1)


rospy.init_node('square')
rospy.on_shutdown(shutdown)
cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
with Drive(cmd_vel):
    for side in range(4):
        # Fill this in: drive forward, stop and rest; turn left, stop and rest. How many ticks is a quarter turn?
        pass
