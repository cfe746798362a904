#!/usr/bin/python3
"""Drive by keyboard: arrow keys, or i (forward), the comma (back), j (left) and l (right). Any other key stops.

The robot keeps moving until the next key. Ctrl-C stops the robot and exits.
"""
from rbx1_nav.ros.driving.script import TimedDrive, exit_status, init_node

import os
import select
import termios
import time
import tty

import rospy
from geometry_msgs.msg import Twist

# last byte of each key: m/s, rad/s. The arrow keys send three bytes, the last of which is A, B, C or D
FORWARD, BACK, LEFT, RIGHT = (0.2, 0.0), (-0.2, 0.0), (0.0, 1.0), (0.0, -1.0)
SPEEDS = {b'A': FORWARD, b'i': FORWARD, b'B': BACK, b',': BACK, b'D': LEFT, b'j': LEFT, b'C': RIGHT, b'l': RIGHT}


def shutdown():
    cmd_vel.publish(Twist())
    termios.tcsetattr(0, termios.TCSANOW, terminal)     # 0: the terminal
    time.sleep(1)


with exit_status():
    init_node('keyboard', __doc__)
    cmd_vel = rospy.Publisher('/cmd_vel', Twist, queue_size=5)
    terminal = termios.tcgetattr(0)
    with TimedDrive(cmd_vel, 20, shutdown) as drive:    # 20 commands per second
        tty.setcbreak(0)        # pass on each key at once
        print(__doc__)
        move_cmd, r = Twist(), drive.Rate()
        while True:
            if select.select([0], [], [], 0)[0]:        # a key was pressed
                move_cmd.linear.x, move_cmd.angular.z = SPEEDS.get(os.read(0, 100)[-1:], (0.0, 0.0))
            cmd_vel.publish(move_cmd)
            r.sleep()
