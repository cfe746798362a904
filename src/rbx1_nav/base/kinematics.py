"""Differential-drive kinematics: integrates wheel travel into a pose.

Meters, radians, seconds; x forward, y left, counter-clockwise positive (REP 103).
"""
from __future__ import annotations

from math import cos, sin
from typing import NamedTuple


SMALL = 1e-4    # rad: below it, the next term of the series of a sine is below the resolution of a float


class Pose(NamedTuple):
    """A pose in the odom frame."""

    x: float    # m
    y: float    # m
    yaw: float  # rad, not wrapped (a full turn left is 2 pi)


ORIGIN = Pose(0.0, 0.0, 0.0)


def relative_frame(pose: Pose, other: Pose) -> Pose:
    """Return the Pose of the frame of `other` in the frame of `pose`, where both are poses of the same robot."""
    yaw = pose.yaw - other.yaw
    return Pose(pose.x - other.x * cos(yaw) + other.y * sin(yaw), pose.y - other.x * sin(yaw) - other.y * cos(yaw), yaw)


class Odometry:
    """Integrates the travel of two wheels into a pose in the odom frame."""

    def __init__(self, base_width: float, pose: Pose = ORIGIN) -> None:
        """base_width: distance between the wheels, m; pose: the first one."""
        self.base_width = base_width
        self.pose = pose

    @property
    def pose(self) -> Pose:
        """The current pose."""
        return Pose(self.x, self.y, self.yaw)

    @pose.setter
    def pose(self, pose: Pose) -> None:
        self.x, self.y, self.yaw = pose     # plain numbers: at most steps nobody needs a Pose

    def update(self, left: float, right: float) -> None:
        """Add the travel (m) of both wheels, each driven at a constant speed."""
        self.move((left + right) / 2, (right - left) / self.base_width)

    def move(self, distance: float, angle: float) -> None:
        """Add a circular arc of length `distance` (m) through `angle` (rad).

        Exact for any pair: the chord of an arc is distance * sin(angle/2) / (angle/2), and its direction is the initial
        heading plus half the angle (plane geometry; the closed form of Siegwart, Nourbakhsh and Scaramuzza,
        Introduction to Autonomous Mobile Robots, 2nd ed., section 5.2.4, without its straight-line approximation).
        """
        half = angle / 2
        chord = distance * (sin(half) / half if abs(half) > SMALL else 1 - half * half / 6)
        direction = self.yaw + half
        self.x += chord * cos(direction)
        self.y += chord * sin(direction)
        self.yaw += angle


def arc(pose: Pose, distance: float, angle: float) -> Pose:
    """Return the pose after a circular arc of length `distance` (m) through `angle` (rad)."""
    odometry = Odometry(1.0, pose)      # of any width
    odometry.move(distance, angle)
    return odometry.pose
