#!/usr/bin/env python3
"""Emulates an iRobot Create on a pseudo-terminal, which a driver opens as its serial port.

usage: fake_create.py [_parameter:=value ...] [topic:=new_topic ...]    usually started by fake_turtlebot_create.launch

Events and faults of the robot:
    services ~pull_cable, ~silence, ~drop_wheel, ~cliff, ~bump, ~dock, ~charger, ~charging_fault (SetBool),
    ~power_cycle (Trigger);
    topics ~charge, ~battery_temperature, ~battery_voltage, ~switches, ~cliffs, ~buttons, ~corruption and ~gyro_stuck
    (Float64), which set these parameters
It publishes the true pose on /ground_truth, and each command that it receives, with its time, on /line.
A pseudo-terminal has no RTS and DTR lines: a driver that requires them gets an error.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

from threading import Lock
import time

import rospy
from nav_msgs.msg import Odometry
from std_msgs.msg import String

from rbx1_nav.base import messages
from rbx1_nav.base.clocks import as_ros_time
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.emulator.emulator import EmulatedCreate
from rbx1_nav.extras.create.emulator.fault_services import PARAMETERS, RobotFaults, make_robot
from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal
from rbx1_nav.node import life
from rbx1_nav.node.private_parameters import param
from rbx1_nav.simulation.wheels import IdealWheels

TRUTH_RATE = 50     # Hz
CLIENT_TIMEOUT = 0.7    # s: half of the time that a node has to exit
FRAMES = 'odom', 'base_footprint'


class FakeCreate:
    """Connects an EmulatedCreate with a pseudo-terminal and with ROS."""

    def __init__(self, robot: EmulatedCreate, terminal: PseudoTerminal) -> None:
        self.robot = robot
        self.terminal = terminal
        self.truth_schedule = Schedule(TRUTH_RATE)
        self.truth_pub = rospy.Publisher('ground_truth', Odometry, queue_size=10)
        self.line_pub = rospy.Publisher('line', String, queue_size=1000)
        robot.on_command = self.publish_command
        self.lock = Lock()          # held while the robot or the terminal is used
        self.faults = RobotFaults(robot, terminal, self.lock)

    def run(self) -> None:
        """Run until shutdown is requested."""
        while not life.end_requested.is_set():
            with self.lock:
                self.step()
            self.terminal.wait(max(0.0, (self.robot.next_time - time.monotonic_ns()) / SECOND))
        # a driver that exits at the same time stops the robot first; without the robot it would report a disconnection
        deadline = time.monotonic() + CLIENT_TIMEOUT
        while self.terminal.has_client() and time.monotonic() < deadline:
            with self.lock:
                self.step()
            life.sleep(0.005)
        self.terminal.unplug()

    def step(self) -> None:
        """Advance the robot to the current time."""
        robot, terminal, now = self.robot, self.terminal, time.monotonic_ns()
        self.set_host_baud()
        data = robot.advance(now)
        terminal.write(data)
        data = terminal.read()
        self.set_host_baud()        # the client has set it before it sent the data
        now = time.monotonic_ns()   # not before the data was sent
        robot.receive(data, now)
        if self.truth_schedule.due(now) and self.truth_pub.get_num_connections():
            self.publish_truth(now)

    def set_host_baud(self) -> None:
        """Set the host's baud rate on the line to the rate that the client has set."""
        self.robot.line.host_baud = self.terminal.baud or self.robot.line.host_baud

    def publish_truth(self, now: int) -> None:
        """Publish the true pose of the robot."""
        wheels = self.robot.body.wheels
        self.truth_pub.publish(messages.odometry(as_ros_time(now, time.monotonic_ns), FRAMES, wheels.truth.pose,
                                                 wheels.true_velocity(*self.robot.body.velocity),
                                                 IdealWheels.uncertainty))

    def publish_command(self, now: int, data: bytes) -> None:
        """Publish a command that arrived: its time in seconds of ROS time, and its bytes in hexadecimal."""
        if self.line_pub.get_num_connections():
            stamp = as_ros_time(now, time.monotonic_ns)
            self.line_pub.publish(f'{stamp.to_sec():.6f} {data.hex()}')


def main() -> int:
    """Read the parameters and run; return the exit status."""
    life.init_node('fake_create', __doc__, PARAMETERS)
    terminal = PseudoTerminal(param('link') or None)
    robot = make_robot(time.monotonic_ns())
    node = FakeCreate(robot, terminal)
    node.faults.serve()
    # after its topics exist: rospy can miss a publisher that registers at the moment when it subscribes
    rospy.loginfo('Emulated %s: serial port %s%s; seed:=%d recreates this robot', robot.model.name, terminal.device,
                  f', linked as {terminal.link}' if terminal.link else '', param('seed'))
    node.run()
    return 0


if __name__ == '__main__':
    life.run(main)
