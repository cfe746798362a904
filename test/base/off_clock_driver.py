#!/usr/bin/python3
"""A driver that is not on the clock: when it sends depends on wall time. It is named like its kind.

    off_clock_driver.py KIND

KIND: wall_rate          time.sleep() between two commands
      wall_thread        each command is sent by a threading.Timer
      wait_for_message   a loop of rospy.wait_for_message()
      keys               a command for each line of the input
      two_commands       for comparison, on the clock: two commands at a time, of which the second one counts
      last_command       for comparison, on the clock: a node that exits just after a command
"""
import os
import sys
import threading
import time

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry

COUNT = 5       # moving commands of the kinds on wall time: the smallest number after which they must be named
PERIOD = 0.1    # s of wall time between them
SPEED = 0.1     # m/s


def twist(speed):
    """Return a Twist, m/s."""
    message = Twist()
    message.linear.x = speed
    return message


def wall_rate(publisher):
    """Sleep on wall time."""
    for _ in range(COUNT):
        publisher.publish(twist(SPEED))
        time.sleep(PERIOD)


def wall_thread(publisher):
    """Send in a chain of threads."""
    done = threading.Event()

    def send(left):
        publisher.publish(twist(SPEED))
        if left > 1:
            threading.Timer(PERIOD, send, [left - 1]).start()
        else:
            done.set()
    send(COUNT)
    done.wait()


def wait_for_message(publisher):
    """Send after an odometry message, which is received by polling on wall time."""
    for _ in range(COUNT):
        rospy.wait_for_message('/odom', Odometry)
        publisher.publish(twist(SPEED))


def keys(publisher):
    """Send a speed for each line."""
    print('waits for a key', flush=True)
    for line in sys.stdin:
        publisher.publish(twist(float(line)))


def two_commands(publisher):
    """Send two speeds at a time, for 1 s."""
    clock = rospy.Rate(20)
    for _ in range(20):
        publisher.publish(twist(SPEED / 2))
        publisher.publish(twist(SPEED))
        clock.sleep()


def last_command(publisher):
    """Send a speed for 1 s, and exit without a stop."""
    clock = rospy.Rate(20)
    for _ in range(20):
        clock.sleep()
        publisher.publish(twist(SPEED))
    os._exit(0)


def main(kind):
    """Drive, and stop."""
    rospy.init_node(kind)
    publisher = rospy.Publisher('/cmd_vel', Twist, queue_size=10)
    while publisher.get_num_connections() == 0:
        rospy.sleep(0.1)
    rospy.sleep(1)
    globals()[kind](publisher)
    publisher.publish(Twist())
    rospy.sleep(0.2)    # lets the stop be sent


if __name__ == '__main__':
    main(*[arg for arg in sys.argv[1:] if ':=' not in arg])
