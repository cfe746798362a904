#!/usr/bin/python3
"""The ways in which a Drive block and its script end without a signal: leaving.py NAME."""
from rbx1_nav.driving import Drive

import multiprocessing
import sys
import threading
import time

import rospy
from geometry_msgs.msg import Twist


def forward():
    command = Twist()
    command.linear.x = 0.2
    return command


def keep_driving(cmd_vel):
    while not rospy.is_shutdown():
        cmd_vel.publish(forward())
        rospy.sleep(0.01)


def exit_beside_a_timer(cmd_vel):
    rospy.Timer(rospy.Duration(0.01), lambda _: cmd_vel.publish(forward()))
    rospy.sleep(0.5)
    sys.exit(2)


def exit_beside_a_thread(cmd_vel):
    threading.Thread(target=keep_driving, args=(cmd_vel,)).start()
    rospy.sleep(0.5)
    sys.exit(2)


def error_beside_a_thread(cmd_vel):
    threading.Thread(target=keep_driving, args=(cmd_vel,)).start()
    rospy.sleep(0.5)
    raise RuntimeError('a mistake')


def error_in_a_thread(cmd_vel):
    threading.Thread(target=float, args=('a mistake',)).start()
    cmd_vel.publish(forward())
    rospy.sleep(0.5)


def hidden_error(cmd_vel):
    cmd_vel.publish(forward())
    raise RuntimeError('a mistake')


def child_process(cmd_vel):
    multiprocessing.Process(target=time.sleep, args=(1000,), daemon=True).start()
    cmd_vel.publish(forward())
    rospy.sleep(0.5)


def main():
    name = sys.argv[1]
    rospy.init_node(name)
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
    try:
        with Drive(cmd_vel, timed=False):
            globals()[name](cmd_vel)
    except RuntimeError:
        if name != 'hidden_error':
            raise


if __name__ == '__main__':
    main()
