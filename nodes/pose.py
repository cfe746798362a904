#!/usr/bin/env python3
"""Prints the robot's true pose, its odometry pose, and the pose estimated from wheels and gyro.

usage: pose.py [topic:=new_topic ...]      it has no parameters

The start is the origin of the odom frame. A simulated base is there after launch and after each reset. Only a
simulated base publishes /ground_truth, and only odom_ekf.launch starts a publisher of /odom_ekf.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from math import degrees, hypot
import time
from typing import Mapping

import rospy
from nav_msgs.msg import Odometry

from rbx1_nav.base import messages
from rbx1_nav.base.units import rounded
from rbx1_nav.node import life

TOPICS = {'ground_truth': 'truth', 'odom': 'odometry', 'odom_ekf': 'estimate'}
TIMEOUT = 5.0       # s of wall time to wait for a base, and for a message on each topic that is published


def receive() -> dict[str, Odometry | None]:
    """Return the latest Odometry by topic: None without a message; topics without a publisher are absent."""
    latest: dict[str, Odometry | None] = {}
    subscribers = {}
    deadline = time.monotonic() + TIMEOUT
    while time.monotonic() < deadline and not life.end_requested.is_set():
        published = {name for name, _ in rospy.get_published_topics()}
        for topic in TOPICS:
            if rospy.resolve_name(topic) in published and topic not in subscribers:
                latest[topic] = None
                subscribers[topic] = rospy.Subscriber(topic, Odometry, lambda message, topic=topic:
                                                      latest.__setitem__(topic, message))
        if latest and all(latest.values()):
            break
        life.sleep(0.05)
    return latest


def width() -> int:
    """Return the width of the column of topics."""
    return max(len(rospy.resolve_name(topic)) for topic in TOPICS) + 1


def row(topic: str, latest: Mapping[str, Odometry | None]) -> str:
    """Return one line of the table."""
    text = f'{TOPICS[topic]:9} {rospy.resolve_name(topic):{width()}}'
    if topic not in latest:
        return f'{text} not published'
    message = latest[topic]
    if message is None:
        return f'{text} no message for {TIMEOUT:g} s'
    pose = message.pose.pose
    x, y, yaw = pose.position.x, pose.position.y, messages.yaw_of(pose.orientation)
    return f'{text} {rounded(x, 3):7.3f} {rounded(y, 3):7.3f} {rounded(degrees(yaw), 1):19.1f} {hypot(x, y):20.3f}'


def main() -> int:
    """Print a table; return the exit status."""
    life.init_node('pose', __doc__, requires_master=True)
    latest = receive()
    if not any(latest.values()):
        others = sorted(name[:-len('/odom')] for name, _ in rospy.get_published_topics() if name.endswith('/odom')
                        and name != rospy.resolve_name('odom'))
        rospy.logerr('No message on %s for %g s: expected a running base%s',
                     ', '.join(map(rospy.resolve_name, TOPICS)), TIMEOUT,
                     f". Bases exist in other namespaces: {', '.join(others)}. To see one, set "
                     f'ROS_NAMESPACE={others[0]}' if others else '')
        return 1
    print(f"{'':{10 + width()}} {'x (m)':>7} {'y (m)':>7} {'heading (degrees)':>19} {'from the start (m)':>20}")
    for topic in TOPICS:
        print(row(topic, latest))
    return 0


if __name__ == '__main__':
    life.run(main)
