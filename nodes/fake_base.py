#!/usr/bin/env python3
"""Simulates a differential-drive base, as a replacement for an ArbotiX base; cmd_vel in, odom out.

usage: fake_base.py [_parameter:=value ...] [topic:=new_topic ...]      usually started by fake_turtlebot.launch
"""
import rbx1_nav.ros.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import threading

import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from diagnostic_updater import Updater
from nav_msgs.msg import Odometry
from std_msgs.msg import Empty
from std_srvs.srv import Empty as EmptyService, EmptyResponse

from rbx1_nav.config import ConfigError
from rbx1_nav.robot.description import read_robot
from rbx1_nav.robot.joints import JointGroup
from rbx1_nav.ros import messages
from rbx1_nav.ros.base.commands import VelocityCommands, subscribe_joints
from rbx1_nav.ros.base.parameters import FAKE_BASE as PARAMETERS
from rbx1_nav.ros.base.publisher import BasePublisher
from rbx1_nav.ros.base.simulated_clock import read_clock
from rbx1_nav.ros.network.no_delay import NoDelay
from rbx1_nav.ros.node import life
from rbx1_nav.ros.node.params import param, stored_params
from rbx1_nav.schedule import Schedule
from rbx1_nav.simulation.base import make_base
from rbx1_nav.simulation.wheels import IdealWheels


class FakeBase:
    """Connects a SimulatedBase with ROS."""

    def __init__(self, robot, base, clock, floor):
        """robot: a Robot; base: a SimulatedBase; clock: see ros/base/clocks.py; floor: the names of its surface and
        seed."""
        self.robot = robot
        self.base = base
        self.clock = clock
        self.floor = floor
        self.lock = threading.Lock()
        self.last_stamp = None
        self.joints = JointGroup(robot.joints)
        self.joint_schedule = Schedule(10)
        self.diagnostics_schedule = Schedule(1)

        self.publisher = BasePublisher(robot, clock.publish, self.greet)
        self.truth_pub = rospy.Publisher('ground_truth', Odometry, NoDelay(), queue_size=10)
        self.reset_pub = rospy.Publisher('reset_odometry', Empty, queue_size=1)
        self.diagnostics = Updater()
        self.diagnostics.setHardwareID('none')
        self.diagnostics.add(robot.name, self.diagnose)
        rospy.Service('~reset', EmptyService, self.on_reset)
        subscribe_joints(robot.joints, self.lock)
        self.commands = VelocityCommands(base, base.gate, clock, self.lock)
        self.commands.subscribe()

    def step(self):
        """Publish the current state of the base."""
        with self.lock:
            now, base = self.clock.now(), self.base
            stamp = self.clock.stamp(now)
            if stamp == self.last_stamp:
                return
            self.last_stamp = stamp
            timed_out = base.advance(now)
            pose, velocity, uncertainty = base.odometry.pose, base.velocity, base.wheels.uncertainty
            true_pose, true_velocity = base.wheels.truth.pose, base.true_velocity
            reading, travel = base.read_gyro(), (base.left, base.right)
            joints_due = self.joint_schedule.due(now)
            if joints_due:
                self.joints.advance(now)
        # in this order, so that a node that receives odometry finds the other messages of this time
        if joints_due:
            self.publisher.publish_joints(stamp, travel, velocity)
        self.publisher.publish_transform(stamp, pose)
        if reading:
            self.publisher.publish_imu(stamp, reading)
        if self.truth_pub.get_num_connections():
            self.clock.publish(self.truth_pub, messages.odometry(stamp, self.robot, true_pose, true_velocity,
                                                                 IdealWheels.uncertainty))
        self.publisher.publish_odometry(stamp, pose, velocity, uncertainty)
        if timed_out:
            self.commands.log_timeout()
        if self.diagnostics_schedule.due(now):
            self.diagnostics.force_update()

    def greet(self, topic, publish):
        """Send the current state to a new subscriber of odom or tf: while a simulated clock waits for a node that is
        starting, no other message follows."""
        if not self.clock.inbox or not self.last_stamp or topic == '/tf' and not self.robot.publish_tf:
            return
        with self.lock:
            base, stamp = self.base, self.last_stamp
            pose, velocity, uncertainty = base.odometry.pose, base.velocity, base.wheels.uncertainty
        publish(self.publisher.transform(stamp, pose) if topic == '/tf' else
                messages.odometry(stamp, self.robot, pose, velocity, uncertainty))

    def on_reset(self, _):
        """Put the robot back at the origin, at rest."""
        with self.lock:
            self.base.advance(self.clock.now())
            self.base.reset()
        self.reset_pub.publish()
        driver = self.commands.driver()
        if driver:
            rospy.logwarn('Reset while %s is driving: this run is not valid. Reset again when it has finished', driver)
        else:
            rospy.loginfo('Reset: %s is back at the origin of %s', self.robot.base_frame_id, self.robot.odom_frame_id)
        return EmptyResponse()

    def diagnose(self, status):
        """Fill in the DiagnosticStatus of the controller."""
        status.summary(DiagnosticStatus.OK, 'Stationary' if self.base.at_rest else 'Moving')
        self.commands.diagnose(status)
        self.clock.diagnose(status)
        for key, value in zip(('Surface', 'Seed'), self.floor):
            status.add(key, value)
        return status


def main():
    """Read the configuration and run; return the exit status."""
    life.init_node('arbotix', __doc__, PARAMETERS, check=read_robot)
    try:
        robot = read_robot(stored_params())
        clock = read_clock(robot.rate)
    except ConfigError as error:
        rospy.logfatal('%s/%s', rospy.get_name(), error)
        return 1
    surface, seed = param('surface'), param('seed')
    if robot.hardware:
        rospy.loginfo('Ignoring %d parameters that apply only to hardware', len(robot.hardware))
    if robot.unknown:
        rospy.logwarn('Ignoring unknown parameters: %s', ', '.join(robot.unknown))
    rospy.loginfo('Surface: %s', f'{surface.name}; seed:={seed} repeats this run' if surface else 'ideal')
    base = FakeBase(robot, make_base(robot, surface, seed), clock, (surface.name if surface else 'ideal', seed))
    rospy.loginfo('Ready: %s is at the origin of %s', robot.base_frame_id, robot.odom_frame_id)
    base.clock.run(base.step)
    return 0


if __name__ == '__main__':
    life.run(main)
