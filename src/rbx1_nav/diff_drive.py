"""Differential-drive kinematics: how wheel travel becomes a pose.

Metres, radians, seconds; x forward, y left, counter-clockwise positive (REP 103).
"""
from collections import namedtuple
from math import cos, sin

Pose = namedtuple('Pose', 'x y yaw')
Pose.__doc__ = 'A pose in the odom frame: x and y in m, yaw in rad, not wrapped (a full turn left is 2 pi).'

ORIGIN = Pose(0.0, 0.0, 0.0)


def arc(pose, distance, angle):
    """The pose after a circular arc of length `distance` (m) through `angle` (rad).

    Exact for any pair: the chord of an arc is distance * sin(angle/2) / (angle/2), and it points half the angle
    further than the first heading (plane geometry; the same closed form as Siegwart, Nourbakhsh and Scaramuzza,
    Introduction to Autonomous Mobile Robots, 2nd ed., section 5.2.4, without its straight-line approximation).
    """
    half = angle / 2
    # below 1e-4 rad the next term of the series is under the resolution of a float
    chord = distance * (sin(half) / half if abs(half) > 1e-4 else 1 - half * half / 6)
    return Pose(pose.x + chord * cos(pose.yaw + half), pose.y + chord * sin(pose.yaw + half), pose.yaw + angle)


class IdealWheels:
    """Wheels that do at once, and exactly, what they are told: no inertia, no slip."""

    def __init__(self, base_width):
        """base_width: distance between the wheels, m."""
        self.base_width = base_width

    def travel(self, linear, angular, duration):
        """(left, right) travel in m while `linear` (m/s) and `angular` (rad/s) are in force for `duration` (s)."""
        difference = angular * self.base_width / 2
        return (linear - difference) * duration, (linear + difference) * duration


class Odometry:
    """Integrates the travel of two wheels to a pose."""

    def __init__(self, base_width):
        """base_width: distance between the wheels, m."""
        self.base_width = base_width
        self.pose = ORIGIN

    def update(self, left, right):
        """Add a travel (m) of both wheels, each at its own constant speed meanwhile."""
        self.pose = arc(self.pose, (left + right) / 2, (right - left) / self.base_width)
