#!/usr/bin/env python3
"""Republishes the combined pose as odometry on /odom_ekf, which RViz draws as arrows.

usage: odom_ekf.py [topic:=new_topic ...]      usually started by odom_ekf.launch; it has no parameters

/odom and /odom_ekf both start at the robot's initial pose, so /odom_ekf uses the frames of odom: RViz shows both.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from math import inf
import time

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry

from rbx1_nav.base import messages
from rbx1_nav.node import life
from rbx1_nav.node.rospy_connections import NoDelay

MESSAGE_WARN_TIME = 5    # s of wall time without a message before a warning


class OdomEkf:
    """Republishes each pose."""

    def __init__(self) -> None:
        self.frames: tuple[str, str] | None = None      # (frame_id, child_frame_id) of the wheel odometry
        self.received = False       # whether there was a pose
        self.publisher = rospy.Publisher('odom_ekf', Odometry, NoDelay(), queue_size=10)
        rospy.Subscriber('odom', Odometry, self.on_odom)
        rospy.Subscriber('odom_combined', PoseWithCovarianceStamped, self.on_pose)

    def on_odom(self, odom: Odometry) -> None:
        """Take the names of the frames from the wheel odometry."""
        self.frames = odom.header.frame_id.lstrip('/'), odom.child_frame_id.lstrip('/')

    def on_pose(self, pose: PoseWithCovarianceStamped) -> None:
        """Republish a combined pose. The velocity is unknown."""
        if self.frames and not life.end_requested.is_set():     # topics are closed during shutdown
            odometry = Odometry(pose=pose.pose)
            odometry.header.stamp = pose.header.stamp
            odometry.header.frame_id, odometry.child_frame_id = self.frames
            odometry.twist.covariance = messages.diagonal(*[messages.UNKNOWN] * 6)
            self.publisher.publish(odometry)
        self.received = True

    def run(self) -> None:
        """Run until shutdown is requested; warn once if there is nothing to republish."""
        deadline = time.monotonic() + MESSAGE_WARN_TIME
        while not (self.frames and self.received):
            if life.end_requested.is_set():
                return
            if time.monotonic() > deadline:
                deadline = inf      # one warning is enough
                # the filter needs odometry too: without a base, neither topic has messages
                topic, source = ('odom_combined', 'filter') if self.frames else ('odom', 'base')
                rospy.logwarn('No message on %s for %d s: expected a running %s; %s starts as soon as there is one',
                              rospy.resolve_name(topic), MESSAGE_WARN_TIME, source, self.publisher.resolved_name)
            life.sleep(1)
        rospy.loginfo('Publishing %s', self.publisher.resolved_name)
        life.end_requested.wait()


def main() -> int:
    """Run the node; return the exit status."""
    life.init_node('odom_ekf', __doc__)
    OdomEkf().run()
    return 0


if __name__ == '__main__':
    life.run(main)
