#!/usr/bin/python3
"""The ways in which rospy tutorials drive a robot, each as a script that never exits by itself: idioms.py NAME."""
from rbx1_nav.driving import Drive

import sys
import threading
import time

import rospy
from geometry_msgs.msg import Twist


def forward():
    command = Twist()
    command.linear.x = 0.2
    return command


def rate(cmd_vel):
    r = rospy.Rate(20)
    for _ in range(100000):
        cmd_vel.publish(forward())
        r.sleep()


def sleep(cmd_vel):
    while True:
        cmd_vel.publish(forward())
        rospy.sleep(0.05)


def timer(cmd_vel):
    rospy.Timer(rospy.Duration(0.05), lambda _: cmd_vel.publish(forward()))
    rospy.spin()


def time_sleep(cmd_vel):
    while not rospy.is_shutdown():
        cmd_vel.publish(forward())
        time.sleep(0.05)


def threads(cmd_vel):
    def drive():
        while not rospy.is_shutdown():
            cmd_vel.publish(forward())
            rospy.sleep(0.05)
    for _ in range(2):
        threading.Thread(target=drive).start()
    while not rospy.is_shutdown():
        time.sleep(0.1)


def is_shutdown(cmd_vel):
    r = rospy.Rate(20)
    while not rospy.is_shutdown():
        cmd_vel.publish(forward())
        r.sleep()


def wait_for_message(cmd_vel):
    while not rospy.is_shutdown():
        cmd_vel.publish(forward())
        rospy.wait_for_message('/odom', rospy.AnyMsg)


def callback(cmd_vel):
    rospy.Subscriber('/odom', rospy.AnyMsg, lambda _: cmd_vel.publish(forward()))
    rospy.spin()


def second_publisher(_):
    again = rospy.Publisher('cmd_vel', Twist, queue_size=1)
    r = rospy.Rate(20)
    while not rospy.is_shutdown():
        again.publish(forward())
        r.sleep()


def swallowed_exception(cmd_vel):
    r = rospy.Rate(20)
    while True:
        try:
            cmd_vel.publish(forward())
            r.sleep()
        except Exception:
            pass


def full_speed(cmd_vel):
    while True:
        cmd_vel.publish(forward())


def published_once(cmd_vel):
    cmd_vel.publish(forward())
    while True:
        time.sleep(1)


def main():
    name = sys.argv[1]

    def shutdown():
        print('shutdown() called', flush=True)
        cmd_vel.publish(Twist())
        rospy.sleep(1)
    rospy.init_node(name)
    rospy.on_shutdown(shutdown)
    cmd_vel = rospy.Publisher('cmd_vel', Twist, queue_size=5)
    with Drive(cmd_vel):
        globals()[name](cmd_vel)


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
