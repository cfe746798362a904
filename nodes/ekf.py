#!/usr/bin/env python3
"""Combines wheel odometry and a gyro; stands in for robot_pose_ekf in a launch file.

odom and imu_data in, odom_combined and its transform out: the README lists topics and parameters.
"""
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu
from std_msgs.msg import Empty
from tf2_msgs.msg import TFMessage

from rbx1_nav import messages, node, resources
from rbx1_nav.base import SECOND
from rbx1_nav.config import ConfigError, Section
from rbx1_nav.diff_drive import between
from rbx1_nav.ekf import CombinedOdometry, RefusedMessage, check, priors
from rbx1_nav.schedule import Schedule
from rbx1_nav.surface import load_surface

SENSORS = ('odom', 'imu_data')
CARPET = 'low_ply_carpet'
CONTRADICTIONS = 5      # steps between two diagnoses: now and then a wheel may slip


def read_parameters():
    """The private parameters as a dictionary, robot_pose_ekf's among them. Raises ConfigError."""
    section = Section(rospy.get_param(rospy.get_name(), {}), '')
    values = dict(
        freq=section.number('freq', 10.0, high=1000.0, expected='a rate above 0 and up to 1000 in Hz'),
        sensor_timeout=section.number('sensor_timeout', 1.0, high=1e6, expected='a time above 0 in s'),
        publish_tf=section.flag('publish_tf', True),
        imu_used=section.flag('imu_used', True),
        output_frame=section.frame('output_frame', 'odom'))
    # what robot_pose_ekf can, and this filter cannot
    if not section.flag('odom_used', True):
        raise ConfigError('odom_used: False: expected true, nothing else tells how far the robot went')
    if section.flag('vo_used', False):
        raise ConfigError('vo_used: True: expected false, this filter knows no visual odometry')
    surface = section.get('surface', '')
    if surface:
        load_surface(surface, resources.surfaces())
    values['surface'] = surface
    if section.unknown():
        rospy.logwarn('Unknown, without effect: %s', ', '.join(section.unknown()))
    return values


class Ekf:
    """The core's CombinedOdometry, with ROS around it."""

    def __init__(self, parameters):
        self.parameters = parameters
        self.lock = threading.Lock()
        self.combined = None        # of the present sender of odometry
        self.sender = None          # the header of its connection
        self.frames = None          # (frame_id, child_frame_id) of its odometry
        self.schedule = Schedule(parameters['freq'])
        self.heard = dict.fromkeys(SENSORS)     # rospy.Time of the last message
        self.refused = dict.fromkeys(SENSORS, 0)
        self.outliers = {}      # by sensor, at its last diagnosis

        self.pose_pub = rospy.Publisher('odom_combined', PoseWithCovarianceStamped, queue_size=10)
        self.tf_pub = rospy.Publisher('/tf', TFMessage, queue_size=100, tcp_nodelay=True)
        self.diagnostics = Updater()
        self.diagnostics.setHardwareID('none')
        for sensor in SENSORS[:1 + parameters['imu_used']]:
            self.diagnostics.add(sensor, lambda status, sensor=sensor: self.diagnose(sensor, status))
        self.odom_sub = None    # there may be odometry before the next line is done
        self.odom_sub = rospy.Subscriber('odom', Odometry, self.on_odom, queue_size=None, tcp_nodelay=True)
        if parameters['imu_used']:
            rospy.Subscriber('imu_data', Imu, self.on_imu, queue_size=None, tcp_nodelay=True)
        rospy.Subscriber('reset_odometry', Empty, self.on_reset)

    def on_odom(self, message):
        """The wheels' odometry arrives."""
        with self.lock:
            if message._connection_header is not self.sender:
                self.meet(message._connection_header)
            self.take('odom', self.add_odom, message)

    def on_imu(self, message):
        """The gyro's reading arrives."""
        with self.lock:
            if self.combined:
                self.take('imu_data', self.add_imu, message)

    def add_odom(self, now, message):
        """Hand an Odometry to the filter."""
        frames = message.header.frame_id.lstrip('/'), message.child_frame_id.lstrip('/')
        for field, frame in zip(('header.frame_id', 'child_frame_id'), frames):
            check(field, repr(frame), frame, 'the name of a frame')
        check('child_frame_id', repr(frames[1]), frames[1] != self.parameters['output_frame'],
              'a frame other than output_frame')
        self.combined.add_odom(now, *messages.from_odometry(message))
        self.frames = frames

    def add_imu(self, now, message):
        """Hand an Imu to the filter."""
        self.combined.add_imu(now, messages.from_imu(message))

    def on_reset(self, _):
        """Somebody put the robot elsewhere."""
        with self.lock:
            if self.combined:
                self.combined.restart('reset_odometry')

    def meet(self, sender):
        """Somebody new sends odometry: where the one before is gone, with another robot, as far as anyone can tell."""
        connections = self.odom_sub.impl.connections if self.odom_sub else []
        if self.sender is None or not any(connection.header is self.sender for connection in connections):
            if self.sender is not None:
                rospy.logwarn('odom comes from another sender: starting again')
            self.combined = CombinedOdometry(priors(self.surface(sender['callerid'])),
                                             round(SECOND * self.parameters['sensor_timeout']),
                                             self.parameters['imu_used'], rospy.logwarn)
            self.sender = sender

    def surface(self, base):
        """The Surface that says how far wheels and gyro of a node are to be trusted."""
        # a simulated base has a parameter that says what it stands on; a real one stands on carpet, as the tutorial's
        name = self.parameters['surface']
        try:
            name = name or rospy.get_param(base + '/surface', CARPET)
            surface = load_surface(name, resources.surfaces())
        except (ConfigError, OSError) as error:     # or no answer from the master
            rospy.logwarn('%s/%s; %s instead', base, error, CARPET)
            name, surface = CARPET, load_surface(CARPET, resources.surfaces())
        rospy.loginfo('Wheels and gyro are taken to be as on %s', name)
        return surface

    def take(self, sensor, add, message):
        """Hand a message to the filter, and publish what comes of it."""
        now = rospy.Time.now()
        if not now:     # simulated time that has not begun
            return
        try:
            add(now.to_nsec(), message)
        except RefusedMessage as error:
            self.refused[sensor] += 1
            rospy.logerr_throttle_identical(1, '%s: %s; refused' % (rospy.resolve_name(sensor), error))
            return
        self.heard[sensor] = now
        estimate = self.combined.estimate
        if estimate and self.schedule.due(estimate.stamp):
            self.publish(estimate)

    def publish(self, estimate):
        """Say where the robot is."""
        stamp = rospy.Time(0, estimate.stamp)
        frame = self.parameters['output_frame']
        self.pose_pub.publish(messages.planar_pose(stamp, frame, estimate.pose, estimate.covariance))
        if self.parameters['publish_tf']:
            odom_frame, base_frame = self.frames
            # a frame has one parent: where the base frame has its own, odom, that one gets ours
            child, pose = ((base_frame, estimate.pose) if frame == odom_frame
                           else (odom_frame, between(estimate.pose, estimate.odom.pose)))
            self.tf_pub.publish([messages.transform(stamp, frame, child, pose)])

    def diagnose(self, sensor, status):
        """Fill in the DiagnosticStatus of a sensor."""
        with self.lock:
            heard, refused = self.heard[sensor], self.refused[sensor]
            left_out = self.combined is not None and self.combined.silent[sensor]
            outliers = self.combined.filter.outliers if self.combined and self.combined.filter else 0
            contradicts = outliers - self.outliers.get(sensor, 0) > CONTRADICTIONS
            self.outliers[sensor] = outliers
        age = None if heard is None else (rospy.Time.now() - heard).to_sec()
        # less than 0: the clock went back since
        if left_out or age is None or not -1 <= age <= self.parameters['sensor_timeout']:
            status.summary(DiagnosticStatus.WARN, 'No message yet' if age is None else 'Silent, left out')
        elif contradicts:
            status.summary(DiagnosticStatus.WARN, 'Wheels and gyro contradict each other')
        else:
            status.summary(DiagnosticStatus.OK, 'Used')
        status.add('Age of the last message (s)', 'never' if age is None else '%.3f' % age)
        status.add('Refused messages', refused)
        status.add('Steps in which wheels and gyro contradicted each other', outliers)
        return status

    def run(self):
        """Until the node is told to end."""
        schedule = Schedule(1)
        while not node.end_requested.is_set():
            if schedule.due(time.monotonic_ns()):   # a clock that stands still is worth a diagnosis too
                self.diagnostics.force_update()
            node.sleep(0.05)


def main():
    """Read the parameters, and run. Returns the exit status."""
    node.init_node('robot_pose_ekf')
    try:
        parameters = read_parameters()
    except ConfigError as error:
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        return 1
    Ekf(parameters).run()
    return 0


if __name__ == '__main__':
    node.run(main)
