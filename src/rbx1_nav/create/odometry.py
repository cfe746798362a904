"""Odometry that knows how uncertain it is."""
from math import cos, sin

import numpy

from rbx1_nav.model.kinematics import Odometry


class UncertainOdometry:
    """A pose with its 3x3 covariance (x, y in m, yaw in rad), propagated to first order along the path.

    Each step adds independent errors of its length and angle, whose variances grow with the travel: Siegwart,
    Nourbakhsh and Scaramuzza, Introduction to Autonomous Mobile Robots, 2nd ed., section 5.2.4.
    """

    def __init__(self, width, linear_error, angular_error, rounding):
        """width: between the wheels, m; linear_error: 1 sigma of the length after 1 m; angular_error: 1 sigma of the
        angle (rad) after 1 rad; rounding: see travel.py."""
        self.odometry = Odometry(width)
        self.linear_error = linear_error
        self.angular_error = angular_error
        self.rounding = numpy.diag([rounding[0] ** 2, rounding[0] ** 2, rounding[1] ** 2])
        self.sum = numpy.zeros((3, 3))      # without rounding, which does not add up: the next count makes up for it

    @property
    def pose(self):
        """The Pose."""
        return self.odometry.pose

    @property
    def covariance(self):
        """Of x, y (m^2) and yaw (rad^2)."""
        return self.sum + self.rounding

    def variances(self, travel):
        """Variances of length (m^2) and angle (rad^2) of a Travel."""
        return (travel.distance_variance + self.linear_error ** 2 * abs(travel.distance),
                travel.angle_variance + self.angular_error ** 2 * abs(travel.angle))

    def move(self, travel):
        """Add a Travel."""
        distance, angle = travel.distance, travel.angle
        variances = self.variances(travel)
        if not (distance or angle or any(variances)):
            return
        middle = self.pose.yaw + angle / 2
        c, s = cos(middle), sin(middle)
        by_pose = numpy.array([[1.0, 0.0, -distance * s], [0.0, 1.0, distance * c], [0.0, 0.0, 1.0]])
        by_travel = numpy.array([[c, -distance / 2 * s], [s, distance / 2 * c], [0.0, 1.0]])
        self.sum = by_pose @ self.sum @ by_pose.T + (by_travel * variances) @ by_travel.T
        self.odometry.move(distance, angle)
