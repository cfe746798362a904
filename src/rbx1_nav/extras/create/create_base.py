"""Connects the Driver of a Create with its serial line and with ROS."""
from __future__ import annotations

import threading
import time
from typing import Callable

from diagnostic_updater import Updater
import rospy

from rbx1_nav.base.clocks import HardwareClock
from rbx1_nav.base.command_gate import CommandGate
from rbx1_nav.base.command_subscriber import VelocityCommands
from rbx1_nav.base.covariances import Uncertainty
from rbx1_nav.base.publisher import BasePublisher
from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.extras.create.create_parameters import Settings
from rbx1_nav.extras.create.create_status import CreateStatus
from rbx1_nav.extras.create.create_topics import CreateTopics
from rbx1_nav.extras.create.driver import Driver
from rbx1_nav.extras.create.odometry import State
from rbx1_nav.extras.create.protocol import MAX_SPEED
from rbx1_nav.extras.create.serial_port import Link
from rbx1_nav.node import life

WAIT = 0.05         # s to sleep while the line is not open
LEAVE_TIME = 0.6    # s in which the robot must confirm that it has stopped


class CreateBase:
    """Drives a robot until shutdown is requested."""

    def __init__(self, settings: Settings, robot: Robot) -> None:
        gate = CommandGate(robot.limits, robot.timeout)
        self.clock = HardwareClock(settings.update_rate)
        self.lock = threading.Lock()
        self.driver = Driver(settings, gate, rospy.loginfo, rospy.logwarn, rospy.logerr)
        self.link = Link(settings, rospy.logwarn)
        self.open_schedule = Schedule(5)
        self.joint_schedule = Schedule(10)
        self.diagnostics_schedule = Schedule(1)
        self.publisher = BasePublisher(robot)
        self.commands = VelocityCommands(self.driver, gate, self.clock, self.lock, wheel_limit=MAX_SPEED / 1000)
        self.topics = CreateTopics(self.driver, robot, self.clock, self.lock)
        self.diagnostics = CreateStatus(Updater(), self.driver, self.link, self.commands)

    def run(self) -> bool:
        """Drive the robot until shutdown is requested; return whether it is known to be stationary afterwards."""
        while not life.end_requested.is_set():
            self.guarded(self.step)
            if self.diagnostics_schedule.due(self.clock.now()):
                self.diagnostics.update()
        return self.leave()

    def guarded(self, step: Callable[[], object]) -> None:
        """Do a step, and close the line if it is disconnected."""
        try:
            step()
        except OSError as error:
            rospy.logerr('Lost the serial connection (%s). The robot keeps executing its last command: stop it by hand',
                         error)
            self.disconnect()

    def step(self) -> None:
        """Process the received data, or try to open the line. Raises OSError if the line is disconnected."""
        if not self.link.port:
            now = self.clock.now()
            if not (self.open_schedule.due(now) and self.link.open(now)):
                life.sleep(WAIT)
                return
            rospy.loginfo('Serial port: %s', self.link.path)
            with self.lock:
                self.driver.attach(self.clock.now(), self.link)
        if not self.link.is_guarded(self.clock.now()):
            rospy.logwarn('The guardian process died: starting a new one')
            with self.lock:
                self.driver.stop(self.clock.now(), 'the guardian process died')
            self.disconnect()
            return
        timed_out, state = self.exchange()
        # a robot that does not answer may not have stopped
        if timed_out and self.driver.contact.answers:
            self.commands.log_timeout()
        if state:
            self.publish(self.clock.now(), state)
        if self.driver.is_ready:
            self.commands.subscribe()
            self.topics.subscribe()

    def exchange(self) -> tuple[bool, State | None]:
        """Receive data and advance the driver; return whether the command has timed out, and the State to publish.
        Raises OSError."""
        data = self.link.read(self.driver.until_tick(self.clock.now()), self.driver.missing)
        with self.lock:
            now = self.clock.now()
            self.driver.receive(now, data)
            timed_out = self.driver.tick(now)
            self.commands.bursts.ran = now
            state = self.driver.state()
        if self.driver.sender.error:
            raise self.driver.sender.error
        return timed_out, state

    def publish(self, now: int, state: State) -> None:
        width = self.driver.model.wheel_separation
        if self.publisher.robot.base_width != width:    # a different robot than expected has answered
            self.publisher.robot = self.publisher.robot._replace(base_width=width)
        stamp = self.clock.stamp(state.time)
        self.publisher.publish_transform(stamp, state.pose)
        linear, angular = state.variances
        self.publisher.publish_odometry(stamp, state.pose, state.velocity, Uncertainty(
            position=0.0, yaw=0.0, linear=linear, angular=angular), state.covariance)
        if state.gyro:
            self.publisher.publish_imu(stamp, state.gyro)
        if self.joint_schedule.due(now):
            self.publisher.publish_joints(stamp, state.travel, state.velocity)
        if self.driver.reading:
            self.topics.publish(now, stamp, self.driver.reading)

    def disconnect(self) -> None:
        """Close the line; the next step opens it again."""
        with self.lock:
            self.driver.detach()
        self.link.close()

    def leave(self) -> bool:
        """Stop the robot for good; return whether it has confirmed the stop, or cannot move."""
        def stop() -> None:
            with self.lock:
                self.driver.leave(self.clock.now())
        self.guarded(stop)
        deadline = time.monotonic() + LEAVE_TIME
        while not self.driver.left and self.link.port and time.monotonic() < deadline:
            self.guarded(self.exchange)
        if not self.driver.left:
            rospy.logerr('The robot has not confirmed that it stopped. If it is still moving, stop it by hand')
        return self.driver.left
