"""Drives until the robot's pose has reached a goal, for odometry-based scripts."""
from __future__ import annotations

from math import degrees, hypot
from typing import Callable, Iterator, Optional

import rospy
from geometry_msgs.msg import Twist
from tqdm import tqdm

from rbx1_nav.control.legs import TRIAL_REST, Leg
from rbx1_nav.robot.kinematics import Pose
from rbx1_nav.ros.driving.script import Drive
from rbx1_nav.ros.driving.pose_listener import LostTransform, PoseListener
from rbx1_nav.units import wrap_angle


class PoseDrive(Drive):
    """Drives until the pose shows that the robot has arrived."""

    start: Pose

    def __init__(self, cmd_vel: rospy.Publisher, rate: float, stop: Callable[[], None], poses: PoseListener,
                 transform_timeout: Optional[float] = None) -> None:
        """transform_timeout: time for which the stopped robot waits for a missing pose, s; None: a missing pose is an
        error."""
        super().__init__(cmd_vel, rate, stop)
        self.poses = poses
        self.transform_timeout = transform_timeout

    def begin(self) -> None:
        super().begin()
        self.start = self.poses.wait(self.wait_timeout)

    def speeds(self, leg: Leg) -> Iterator[float]:
        """Yield the speed for each tick, m/s or rad/s, until the robot has arrived, and show the progress.

        A leg stops twice: just before its goal, to measure the stopping distance, and at its goal. Raises StuckError.
        """
        rospy.loginfo('%s: %.2f %s', leg.name, leg.goal, leg.unit)
        with tqdm(total=leg.goal, desc=leg.name, unit=leg.unit, disable=None,
                  bar_format='{desc:9}: |{bar}| {n:.2f} of {total:.2f} {unit}') as bar:
            yield from self._speeds(leg, bar)
            self.cmd_vel.publish(Twist())
            self.rest(TRIAL_REST)
            yield from self._speeds(leg, bar)

    def drive(self, leg: Leg) -> None:
        """Drive a leg to its goal and come to rest; leg.done() and leg.last are then valid for the stationary
        robot."""
        command, rate = Twist(), self.Rate()
        for speed in self.speeds(leg):
            command.linear.x, command.angular.z = leg.velocity(speed)
            self.cmd_vel.publish(command)
            rate.sleep()
        self.cmd_vel.publish(Twist())
        self.rest(1)
        leg.next_speed(self._pose())

    def rest(self, seconds: float) -> None:
        super().rest(seconds)
        self.poses.forget_velocity()

    def _speeds(self, leg: Leg, bar: tqdm) -> Iterator[float]:
        self.restart_rate()
        speed = leg.next_speed(self._pose())
        while speed:
            yield speed
            speed = leg.next_speed(self._pose())
            bar.update(max(0, min(leg.done(), leg.goal) - bar.n))

    def _pose(self) -> Pose:
        """Return the robot's pose. If it is missing, stop the robot and wait for a new one."""
        try:
            return self.poses.pose()
        except LostTransform as error:
            if self.transform_timeout is None:
                raise rospy.ROSException(f'The base no longer reports odometry ({error}): expected a base that is '
                                         'connected to its robot; see /diagnostics') from None
            self.cmd_vel.publish(Twist())
            rospy.logwarn('%s: stopping the robot until there is a new one', error)
            return self.poses.wait(self.transform_timeout, self.listeners.check)


class OdomDrive(PoseDrive):
    """A PoseDrive that reports the distance between the start pose and the end pose."""

    def begin(self) -> None:
        super().begin()
        rospy.loginfo('Measuring the pose of %s in the frame %s', self.poses.base_frame, self.poses.odom_frame)

    def finish(self) -> None:
        self.listeners.check_delivery()
        start, end = self.start, self.poses.wait(self.transform_timeout or self.wait_timeout)
        rospy.loginfo('Done: measured in %s, the robot is %.3f m from its start and %.1f degrees off its initial '
                      'heading', self.poses.odom_frame, hypot(end.x - start.x, end.y - start.y),
                      degrees(abs(wrap_angle(end.yaw - start.yaw))))
