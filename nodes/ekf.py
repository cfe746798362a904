#!/usr/bin/env python3
"""Combines wheel odometry and a gyro, and takes the place of robot_pose_ekf in a launch file.

usage: ekf.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by odom_ekf.launch

Parameters:
    ~freq               of odom_combined and its transform, Hz (default: 30)
    ~sensor_timeout     a sensor that is silent for longer is not used until it recovers, s (default: 1)
    ~publish_tf         whether to publish the transform (default: true)
    ~imu_used           whether to use the gyro (default: true)
    ~odom_used          only true is accepted
    ~vo_used, ~gps_used, ~debug, ~self_diagnose   accepted: a line says that they have no effect
    ~output_frame       frame of the combined pose (default: odom_combined)
    ~base_footprint_frame   of the robot (default: child_frame_id of odom, or base_footprint if that is empty)
    ~tf_prefix          of both names, unless they begin with a slash (default: none)
    ~surface            the floor that the filter starts with: a name or path as for the base, unknown, or auto: that
                        of the simulated base, and unknown for any other (default: auto)
    ~diagnostic_period  of /diagnostics, s (default: 1)
"""
import rbx1_nav.ros.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

from functools import partial
import threading
import time

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from std_msgs.msg import Empty

from rbx1_nav.estimation.combined_odometry import MAX_AGE, MAX_LEAD, CombinedOdometry
from rbx1_nav.estimation.inputs import RejectedMessage
from rbx1_nav.ros import messages, node
from rbx1_nav.ros.estimate_publisher import EstimatePublisher
from rbx1_nav.ros.filter_parameters import find_prior, load_parameters, read_parameters
from rbx1_nav.ros.frame_tree import FrameTree
from rbx1_nav.ros.imu_input import ImuInput
from rbx1_nav.ros.limited_log import LimitedLog
from rbx1_nav.ros.one_sender import OneSender
from rbx1_nav.ros.sensor_status import SensorStatus, make_diagnostics
from rbx1_nav.schedule import Schedule
from rbx1_nav.units import SECOND


class Ekf:
    """Connects a CombinedOdometry with ROS."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.lock = threading.Lock()
        self.combined = None        # CombinedOdometry of the present publisher of odometry
        self.log = LimitedLog()
        self.warn = partial(self.log.add, rospy.logwarn)
        self.sender = OneSender('odom', parameters['sensor_timeout'], self.warn, self.restart)
        self.frames = None          # of its odometry, and of the robot
        self.sensors = {name: SensorStatus(parameters['sensor_timeout'])
                        for name in ('odom', 'imu_data')[:1 + parameters['imu_used']]}
        self.tree = FrameTree()
        self.publisher = EstimatePublisher(parameters, self.tree, partial(self.log.add, rospy.loginfo))
        self.imu = ImuInput('imu_data', self.tree, partial(self.log.add, rospy.loginfo))
        self.diagnostics = make_diagnostics(self.sensors, self.diagnose)
        self.tree.listen(True)
        self.odom_sub = None    # a message may arrive before the next line is done
        self.odom_sub = rospy.Subscriber('odom', Odometry, self.on_odom, queue_size=None, tcp_nodelay=True)
        if parameters['imu_used']:
            rospy.Subscriber('imu_data', Imu, self.on_imu, queue_size=None, tcp_nodelay=True)
        rospy.Subscriber('reset_odometry', Empty, self.on_reset)

    def on_odom(self, message):
        """Odometry arrives."""
        with self.lock:
            connections = self.odom_sub.impl.connections if self.odom_sub else []
            if self.sender.accepts(message._connection_header, connections, rospy.Time.now()):
                self.process('odom', self.add_odom, message)

    def on_imu(self, message):
        """A reading of the gyro arrives."""
        with self.lock:
            if self.frames:
                self.process('imu_data', lambda now, imu: self.imu.read(
                    imu, self.frames[1], partial(self.combined.add_imu, now)), message)

    def on_reset(self, _):
        """The base was reset."""
        with self.lock:
            if self.combined:
                self.log.add(rospy.loginfo, 'reset_odometry: restarting at the pose of the odometry')
                self.combined.reset(rospy.Time.now().to_nsec())

    def add_odom(self, now, message):
        """Pass an Odometry to the filter."""
        frames = messages.frames_of(message, self.parameters)
        self.combined.add_odom(now, *messages.from_odometry(message))
        self.frames = frames

    def restart(self, sender):
        """Start with the odometry of another node: it may be another robot."""
        if self.combined:
            self.warn('odom comes from another node: restarting')
            self.publisher.restart()
        prior = find_prior(self.parameters['surface'], sender, self.log.add)
        self.combined = CombinedOdometry(prior, round(SECOND * self.parameters['sensor_timeout']),
                                         self.parameters['imu_used'], self.warn, time.monotonic_ns,
                                         MAX_LEAD if rospy.rostime.is_wallclock() else MAX_AGE)

    def process(self, sensor, add, message):
        """Pass a message to the filter, and publish the result."""
        now = rospy.Time.now()
        if not now:     # simulated time that has not begun
            return
        try:
            add(now.to_nsec(), message)
        except RejectedMessage as error:
            self.sensors[sensor].rejected += 1
            self.log.add(rospy.logerr, '%s: %s; rejected' % (rospy.resolve_name(sensor), error))
            return
        self.sensors[sensor].received = now
        if self.combined.estimate and not node.end_requested.is_set():      # topics are closed at the end
            self.publisher.update(self.combined.estimate, *self.frames)

    def diagnose(self, sensor, status):
        """Fill in the DiagnosticStatus of a sensor."""
        with self.lock:
            timed_out = self.combined is not None and self.combined.timed_out[sensor]
            contradicts = self.combined is not None and self.combined.contradicts
            self.sensors[sensor].diagnose(status, timed_out, contradicts)
        return status

    def run(self):
        """Until the node is to end."""
        schedule = Schedule(1 / self.parameters['diagnostic_period'])
        while not node.end_requested.is_set():
            if schedule.due(time.monotonic_ns()):   # wall time: a clock that stands still is worth a diagnosis too
                self.diagnostics.force_update()
            self.log.flush(time.monotonic())
            self.tree.listen(not (self.publisher.settled and self.imu.settled))
            node.sleep(0.05)


def main():
    """Read the parameters, and run. Returns the exit status."""
    node.init_node('robot_pose_ekf', __doc__, check=read_parameters)
    Ekf(load_parameters()).run()
    return 0


if __name__ == '__main__':
    node.run(main)
