#!/usr/bin/python3
"""Drive with the arrow keys. The robot keeps moving until the next key. Any other key stops it; Ctrl-C exits."""
from rbx1_nav.driving import Drive

from contextlib import suppress
import os
import re
import select
import sys
import termios
import tty

import rospy
from geometry_msgs.msg import Twist

# m/s and rad/s for the arrow keys up, down, left and right
SPEEDS = {b'\x1b[A': (0.2, 0.0), b'\x1b[B': (-0.2, 0.0), b'\x1b[D': (0.0, 1.0), b'\x1b[C': (0.0, -1.0)}


def shutdown():
    cmd_vel.publish(Twist())
    with suppress(termios.error):   # the terminal is closed
        termios.tcsetattr(0, termios.TCSADRAIN, settings)
    rospy.sleep(0.5)


if not os.isatty(0):
    sys.exit('keyboard.py: expected a terminal as standard input')
settings = termios.tcgetattr(0)
rospy.init_node('keyboard')
cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
rospy.on_shutdown(shutdown)
with Drive(cmd_vel, timed=False):
    tty.setcbreak(0)    # read() returns each key at once
    print(__doc__)
    move_cmd, r = Twist(), rospy.Rate(20)
    while not rospy.is_shutdown():
        typed = os.read(0, 100) if select.select([0], [], [], 0)[0] else b''
        for key in re.findall(rb'\x1b\[.|.', typed, re.DOTALL):
            move_cmd.linear.x, move_cmd.angular.z = SPEEDS.get(key, (0.0, 0.0))
        cmd_vel.publish(move_cmd)
        r.sleep()
