#!/usr/bin/env python3
"""Prints where the robot is: in truth, by odometry, and by the estimate from wheels and gyro.

usage: pose.py [topic:=new_topic ...]      it has no parameters

The start is the origin of the odometry's frame. Only a simulated base publishes /ground_truth, and only
odom_ekf.launch /odom_ekf.
"""
import rbx1_nav.ros.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

from math import degrees, hypot
import time

import rospy
from nav_msgs.msg import Odometry

from rbx1_nav.ros import messages, node

TOPICS = ('ground_truth', 'odom', 'odom_ekf')
TIMEOUT = 5.0       # s of wall time for the first message of a topic that has a publisher


def number(value, width, digits):
    """A number as text, with a plain 0 instead of -0."""
    return '%*.*f' % (width, digits, round(value, digits) + 0.0)


def receive(topics):
    """The latest Odometry of each topic that has one, as a dictionary."""
    latest = {}
    published = {name for name, _ in rospy.get_published_topics()}
    wanted = [topic for topic in topics if rospy.resolve_name(topic) in published]
    for topic in wanted:
        rospy.Subscriber(topic, Odometry, lambda message, topic=topic: latest.__setitem__(topic, message))
    deadline = time.monotonic() + TIMEOUT
    while len(latest) < len(wanted) and time.monotonic() < deadline and not node.end_requested.is_set():
        node.sleep(0.02)
    return latest


def main():
    """Print a table. Returns the exit status."""
    node.init_node('pose', __doc__)
    latest = receive(TOPICS)
    if not latest:
        rospy.logerr('No message on %s: expected a running base', ', '.join(map(rospy.resolve_name, TOPICS)))
        return 1
    print('%-14s %8s %8s %18s %19s' % ('', 'x (m)', 'y (m)', 'heading (degrees)', 'from the start (m)'))
    for topic in TOPICS:
        name = rospy.resolve_name(topic)
        if topic in latest:
            pose = latest[topic].pose.pose
            x, y = pose.position.x, pose.position.y
            print('%-14s %s %s %s %s' % (name, number(x, 8, 3), number(y, 8, 3),
                                         number(degrees(messages.yaw_of(pose.orientation)), 18, 1),
                                         number(hypot(x, y), 19, 3)))
        else:
            print('%-14s not published' % name)
    return 0


if __name__ == '__main__':
    node.run(main)
