#!/usr/bin/env python3
"""Estimates the robot's pose from wheel odometry and a gyro, and replaces robot_pose_ekf in a launch file.

usage: ekf.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by odom_ekf.launch
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from functools import partial
import threading
import time
from types import SimpleNamespace
from typing import Any, Callable

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from std_msgs.msg import Empty

from rbx1_nav.base.schedule import Schedule
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.conversions import frames_of, from_odometry, from_set_pose
from rbx1_nav.filter.ekf_parameters import PARAMETERS, load_parameters, make_filter, read_parameters
from rbx1_nav.filter.estimate_publisher import EstimatePublisher
from rbx1_nav.filter.filter_status import Diagnostics, LimitedLog
from rbx1_nav.filter.imu_input import FrameTree, ImuInput
from rbx1_nav.filter.input_checks import RejectedMessage, check
from rbx1_nav.filter.one_sender import OneSender
from rbx1_nav.node import life


class Ekf:
    """Connects a CombinedOdometry with ROS."""

    def __init__(self, parameters: SimpleNamespace) -> None:
        self.parameters = parameters
        self.lock = threading.Lock()
        self.combined: CombinedOdometry | None = None       # for the current publisher of odometry
        self.log = LimitedLog()
        self.warn = partial(self.log.add, rospy.logwarn)
        self.sender = OneSender('odom', parameters.sensor_timeout, self.warn, self.restart)
        self.imu_sender = OneSender('imu_data', parameters.sensor_timeout, self.warn)
        self.frames: tuple[str, str] | None = None          # frames of its odometry and of the robot
        self.tree = FrameTree()
        self.publisher = EstimatePublisher(parameters, self.tree, partial(self.log.add, rospy.loginfo))
        self.imu = ImuInput('imu_data', self.tree, partial(self.log.add, rospy.loginfo))
        self.diagnostics = Diagnostics((self.sender, self.imu_sender)[:1 + parameters.imu_used],
                                       parameters.sensor_timeout, self.lock,
                                       lambda: (self.combined, self.publisher.published))
        # a message may arrive before these are assigned
        self.odom_sub: rospy.Subscriber | None = None
        self.imu_sub: rospy.Subscriber | None = None

    def subscribe(self) -> None:
        """Receive messages from now on."""
        self.tree.listen(True)
        self.odom_sub = rospy.Subscriber('odom', Odometry, self.on_odom, queue_size=None, tcp_nodelay=True)
        if self.parameters.imu_used:
            self.imu_sub = rospy.Subscriber('imu_data', Imu, self.on_imu, queue_size=None, tcp_nodelay=True)
        rospy.Subscriber('reset_odometry', Empty, self.on_reset)
        rospy.Subscriber('set_pose', PoseWithCovarianceStamped, self.on_set_pose)

    def on_odom(self, message: Odometry) -> None:
        """Process an odometry message."""
        with self.lock:
            if self.sender.accepts(message._connection_header, self.odom_sub):
                self.process('odom', self.add_odom, message)

    def on_imu(self, message: Imu) -> None:
        """Process an IMU message."""
        with self.lock:
            if self.imu_sender.accepts(message._connection_header, self.imu_sub):
                self.process('imu_data', self.add_imu, message)

    def on_reset(self, _: Empty) -> None:
        """Restart the filter because the base was reset."""
        with self.lock:
            if self.combined:
                self.log.add(rospy.loginfo, 'Odometry was reset: restarting the filter at the odometry pose')
                self.combined.reset(rospy.Time.now().to_nsec())

    def on_set_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Set the pose of the robot."""
        with self.lock:
            self.process('set_pose', self.place, message)

    def place(self, combined: CombinedOdometry | None, now: int, message: PoseWithCovarianceStamped) -> None:
        """Pass a pose to the filter, with the time of the last odometry, whose clock may differ from this node's."""
        check('odom', None, combined, 'a message before this one')
        if combined:
            combined.set_pose(combined.arrivals.last_stamp['odom'] or now,
                              *from_set_pose(message, self.parameters.output_frame))

    def add_imu(self, combined: CombinedOdometry, now: int, message: Imu) -> None:
        """Pass an Imu to the filter."""
        if self.frames:
            self.imu.read(message, self.frames[1], partial(combined.add_imu, now))

    def add_odom(self, combined: CombinedOdometry, now: int, message: Odometry) -> None:
        """Pass an Odometry to the filter."""
        frames = frames_of(message, self.parameters)
        combined.add_odom(now, from_odometry(message))
        self.frames = frames

    def restart(self, sender: str) -> None:
        """Restart with the odometry of another node, which may belong to another robot."""
        if self.combined:
            self.warn('odom comes from another node: restarting')
            self.publisher.restart()
        self.combined = make_filter(self.parameters, sender, self.log.add, self.warn)

    # Any: rospy has no types
    def process(self, topic: str, add: Callable[[Any, int, Any], None], message: Any) -> None:
        """Pass a message to the filter, and publish the result."""
        now = rospy.Time.now()
        if not now:     # simulated time has not started
            return
        try:
            add(self.combined, now.to_nsec(), message)
        except RejectedMessage as error:
            self.diagnostics.rejected[topic] += 1
            self.log.add(rospy.logerr, f'{rospy.resolve_name(topic)}: {error}; rejected')
            return
        if self.combined and self.frames:
            self.diagnostics.received[topic] = now
            if self.combined.estimate and not life.end_requested.is_set():      # topics are closed during shutdown
                self.publisher.update(self.combined, *self.frames)

    def run(self) -> None:
        """Run until shutdown is requested."""
        self.subscribe()
        schedule = Schedule(1 / self.parameters.diagnostic_period)
        while not life.end_requested.is_set():
            if schedule.due(time.monotonic_ns()):   # wall time: diagnostics are needed even if /clock has stopped
                self.diagnostics.update()
            self.tree.listen(not (self.publisher.settled and self.imu.settled))
            life.sleep(0.05)


def main() -> int:
    """Read the parameters and run; return the exit status."""
    life.init_node('robot_pose_ekf', __doc__, PARAMETERS, check=read_parameters)
    Ekf(load_parameters()).run()
    return 0


if __name__ == '__main__':
    life.run(main)
