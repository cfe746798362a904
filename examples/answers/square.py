#!/usr/bin/python3
"""Drive a square, timed: four sides of 1 m, and a quarter turn to the left after each."""
from rbx1_nav.driving import Drive

import rospy
from geometry_msgs.msg import Twist

# m/s, rad/s, ticks of 20 ms: 1 m takes 5 s, and a quarter turn pi / 2 s, which is 78.5 ticks
MOTIONS = (0.2, 0.0, 250), (0.0, 1.0, 78)


def shutdown():
    cmd_vel.publish(Twist())
    rospy.sleep(1)


rospy.init_node('square')
rospy.on_shutdown(shutdown)
cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
with Drive(cmd_vel):
    for side in range(4):
        for linear_speed, angular_speed, ticks in MOTIONS:
            move_cmd = Twist()
            move_cmd.linear.x = linear_speed
            move_cmd.angular.z = angular_speed
            r = rospy.Rate(50)
            for tick in range(ticks):
                cmd_vel.publish(move_cmd)
                r.sleep()
            cmd_vel.publish(Twist())
            rospy.sleep(1)
