#!/usr/bin/python3
"""Drive forward. At a bump, back up and turn away from it. Ctrl-C stops the robot."""
from rbx1_nav.driving import Drive

import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import Bool


def shutdown():
    cmd_vel.publish(Twist())
    rospy.sleep(0.5)


def bump(message, side):
    bumped[side] = message.data


def drive(linear, angular, seconds):
    move_cmd = Twist()
    move_cmd.linear.x, move_cmd.angular.z = linear, angular
    r = rospy.Rate(20)
    for tick in range(int(seconds * 20)):
        cmd_vel.publish(move_cmd)
        r.sleep()


rospy.init_node('turn_at_bump')
cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
rospy.on_shutdown(shutdown)
bumped = {'left': False, 'right': False}
for side in bumped:
    rospy.Subscriber('bumper/' + side, Bool, bump, side)
with Drive(cmd_vel, timed=False):
    while not rospy.is_shutdown():
        if any(bumped.values()):
            angular = -1.0 if bumped['left'] else 1.0   # to the right if the bump is on the left
            drive(-0.1, 0.0, 1.5)
            drive(0.0, angular, 1.5)
        else:
            drive(0.1, 0.0, 0.05)   # one tick
