#!/usr/bin/env python3
"""The base of a TurtleBot: drives an iRobot Create or Create 2 over a serial port. cmd_vel in, odom out.

usage: turtlebot_node.py [_parameter:=value ...] [topic:=new_topic ...]  started by turtlebot_minimal_create.launch

Parameters, with the names of create_node's:
    ~port                           the serial port (default: /dev/ttyUSB0)
    ~robot_type                     create or create2 (default: create)
    ~update_rate                    of sensors and odometry, Hz (default: 30)
    ~operation_mode                 2: safe; 3: full, without the robot's cliff and wheel-drop stop; 1: passive, the
                                    robot is not driven (default: 2)
    ~cmd_vel_timeout                a command of this age stops the robot, s (default: 0.6)
    ~stop_motors_on_bump            whether a bump stops forward motion (default: true)
    ~min_abs_yaw_vel                slower turns are commanded at this speed, rad/s (default: 0)
    ~max_abs_yaw_vel                faster turns are limited to this speed, rad/s; 0: no limit (default: 0)
    ~has_gyro                       whether there is a gyro at the analog input (default: true; create2: false)
    ~gyro_measurement_range         of the gyro's chip, degrees/s (default: 150)
    ~gyro_scale_correction          factor for the gyro's angular velocity (default: 1.35)
    ~odom_linear_scale_correction   factor for the distance that the robot reports (default: 1)
    ~odom_angular_scale_correction  factor for the angle (default: 1)
    ~odom_linear_error              error of the distance, 1 sigma, m after 1 m (default: 0.05)
    ~odom_angular_error             error of the angle, 1 sigma, rad after 1 rad (default: 0.09)
    ~odom_heading_error             error of the heading, 1 sigma, rad after 1 m (default: 0.07)
    ~odom_frame, ~base_frame        frames (default: odom, base_footprint)
    ~publish_tf                     whether to publish the transform to the base frame (default: true)
    ~drive_mode, ~diagnostic_period accepted: twist, and any number; /diagnostics has 1 Hz
"""
import rbx1_nav.ros.early_interrupt     # Ctrl-C ends the node quietly even while the rest is loaded

import threading

import rospy
from diagnostic_updater import Updater

from rbx1_nav.config import ConfigError
from rbx1_nav.control.gate import CommandGate
from rbx1_nav.create.driver import Driver
from rbx1_nav.create.link import Link
from rbx1_nav.create.parameters import read_settings
from rbx1_nav.model.wheels import Uncertainty
from rbx1_nav.ros import node
from rbx1_nav.ros.base_publisher import BasePublisher
from rbx1_nav.ros.clocks import HardwareClock
from rbx1_nav.ros.commands import VelocityCommands
from rbx1_nav.ros.create_status import CreateStatus
from rbx1_nav.schedule import Schedule

RETRY = 0.05        # s between two attempts to open the line


class TurtlebotNode:
    """Connects a Driver with its line and with ROS."""

    def __init__(self, settings, robot):
        """settings: Settings; robot: a Robot."""
        gate = CommandGate(robot.limits, robot.timeout)
        self.clock = HardwareClock(settings.update_rate)
        self.lock = threading.Lock()
        self.driver = Driver(settings, gate, rospy.loginfo, rospy.logwarn)
        self.link = Link(settings, rospy.logwarn)
        self.joint_schedule = Schedule(10)
        self.diagnostics_schedule = Schedule(1)
        self.publisher = BasePublisher(robot)
        self.commands = VelocityCommands(self.driver, gate, self.clock, self.lock)
        self.diagnostics = Updater()
        CreateStatus(self.diagnostics, robot.name, self.driver, self.link, self.commands)

    def run(self):
        """Drive the robot until the node is to end."""
        while not node.end_requested.is_set():
            try:
                self.step()
            except OSError as error:
                rospy.logerr('The line to the robot is lost (%s). The robot goes on with its last command: stop it'
                             ' by hand',
                             error)
                self.disconnect()
            if self.diagnostics_schedule.due(self.clock.now()):
                self.diagnostics.force_update()
        with self.lock:
            self.driver.leave(self.clock.now())

    def step(self):
        """Process what has arrived, or try to open the line. Raises OSError if it is lost."""
        if not self.link.port:
            if not self.link.open(self.clock.now()):
                node.sleep(RETRY)
                return
            with self.lock:
                self.driver.attach(self.clock.now(), self.link.write)
            rospy.loginfo('Serial port: %s', self.link.path)
        if not self.link.is_guarded(self.clock.now()):
            rospy.logwarn('The guardian process is gone: starting another')
            with self.lock:
                self.driver.stop(self.clock.now())
            self.disconnect()
            return
        data = self.link.read(self.driver.until_tick(self.clock.now()), self.driver.awaited)
        with self.lock:
            now = self.clock.now()
            self.driver.receive(now, data)
            timed_out = self.driver.tick(now)
            state = self.driver.state()
        if timed_out and self.driver.answers:       # otherwise nobody knows whether it stopped
            self.commands.log_timeout()
        if state:
            self.publish(now, state)
        if self.driver.error:
            raise self.driver.error

    def publish(self, now, state):
        """Publish a State."""
        stamp = self.clock.stamp() - rospy.Duration(0, self.clock.now() - state.time)
        self.publisher.publish_odometry(stamp, state.pose, state.velocity, Uncertainty(0.0, 0.0, *state.variances),
                                        state.covariance)
        if state.gyro:
            self.publisher.publish_imu(stamp, state.gyro)
        if self.joint_schedule.due(now):
            self.publisher.publish_joints(stamp, state.travel, state.velocity)

    def disconnect(self):
        """Give up the line. Another one will be opened."""
        with self.lock:
            self.driver.detach(self.clock.now())
        self.link.close()


def main():
    """Read the parameters, and run. Returns the exit status."""
    node.init_node('turtlebot_node', __doc__, check=read_settings)
    if not rospy.rostime.is_wallclock():
        rospy.logfatal('/use_sim_time: true: expected false, a robot on a serial line runs in real time')
        return 1
    try:
        settings, robot = read_settings(rospy.get_param(rospy.get_name(), {}))
    except ConfigError as error:
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        return 1
    TurtlebotNode(settings, robot).run()
    return 0


if __name__ == '__main__':
    node.run(main)
