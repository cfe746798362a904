"""Readings of a robot's sensors, simulated or real, and their uncertainties: a gyro, and odometry with a covariance."""
from __future__ import annotations

from math import ceil, cos, sin
from typing import NamedTuple

from rbx1_nav.base.kinematics import Odometry, Pose
from rbx1_nav.base.units import Covariance

MEASURED = 1e-6         # variance of a good measurement, m^2 or rad^2 (or per s^2): 1 mm, 1 mrad
MIN_VARIANCE = 1e-12    # smallest variance that a sensor may report, same units: 1 um, 1 urad
HELD = 0.3      # m: path over which a rounded heading stays constant while the robot drives straight ahead
STEP = 0.1, 0.2     # m, rad: longest step that may be linearized about its middle


class Uncertainty(NamedTuple):
    """Variances of a pose and of the speeds."""

    position: float     # variance of x and y, m^2
    yaw: float          # variance of the yaw, rad^2
    linear: float       # variance of the linear speed, m^2/s^2
    angular: float      # variance of the angular speed, rad^2/s^2


class Reading(NamedTuple):
    """A reading of a gyro."""

    rate: float             # angular velocity with bias and scale error, rad/s
    rate_variance: float    # variance of the noise of the rate, rad^2/s^2
    yaw: float              # the heading integrated from calibrated readings, rad, not wrapped
    yaw_variance: float     # rad^2


class Travel(NamedTuple):
    """An arc that a robot's sensors have measured, with the variances of its length and angle excluding rounding and
    slip."""

    distance: float             # m
    angle: float                # rad
    distance_variance: float    # m^2
    angle_variance: float       # rad^2


class OdometryErrors(NamedTuple):
    """Errors of the wheels' travel on the floor, 1 sigma, which grow with the square root of the travel."""

    linear: float   # m after 1 m
    angular: float  # rad after a turn of 1 rad
    heading: float  # rad after 1 m

    def variances(self, distance: float, angle: float) -> tuple[float, float]:
        """Return the variances of the length (m^2) and the angle (rad^2) of a travel (m, rad) in either direction."""
        linear, angular, heading = self
        distance = abs(distance)
        return linear ** 2 * distance, angular ** 2 * abs(angle) + heading ** 2 * distance


class UncertainOdometry:
    """A pose with its 3x3 covariance (x, y in m, yaw in rad), propagated to first order along the path.

    Each step adds independent errors of its length and its angle. Their variances grow with the travel (Siegwart,
    Nourbakhsh and Scaramuzza, Introduction to Autonomous Mobile Robots, 2nd ed., section 5.2.4).
    """

    def __init__(self, width: float, errors: OdometryErrors, rounding: tuple[float, float]) -> None:
        """width: distance between the wheels, m; rounding: 1 sigma (m, rad) of a position and a
        heading that are counted in whole units."""
        self.odometry = Odometry(width)
        self.errors = errors
        self.rounding = rounding[0] ** 2, rounding[1] ** 2      # m^2, rad^2
        # the covariance without rounding errors, which do not accumulate: the next count compensates for them
        self.xx = self.xy = self.yy = self.x_yaw = self.y_yaw = self.yaw_yaw = 0.0

    @property
    def pose(self) -> Pose:
        return self.odometry.pose

    @property
    def covariance(self) -> Covariance:
        """The covariance of x, y (m^2) and yaw (rad^2)."""
        position, yaw = self.rounding
        return ((self.xx + position, self.xy, self.x_yaw),
                (self.xy, self.yy + position, self.y_yaw),
                (self.x_yaw, self.y_yaw, self.yaw_yaw + yaw))

    def _variances(self, travel: Travel) -> tuple[float, float, float]:
        """Return the variances of the length, the sideways displacement (m^2) and the angle (rad^2).

        Sideways: the heading is counted in whole units, and its rounding error is constant until the next unit. So this
        error adds up over the path to that unit. Over a longer step, it is the mean of two rounding errors.
        """
        distance, angle = abs(travel.distance), abs(travel.angle)
        length, turn = self.errors.variances(distance, angle)
        turn += travel.angle_variance
        unit = (12 * self.rounding[1]) ** 0.5
        path = HELD if angle * HELD <= unit * distance else unit * distance / angle
        return travel.distance_variance + length, self.rounding[1] * distance * max(path, distance / 2), turn

    def move(self, travel: Travel) -> None:
        """Add a Travel. It is long if the robot has not answered for a while."""
        distance, angle, (along, aside, turn) = travel.distance, travel.angle, self._variances(travel)
        if not (distance or angle or along or turn):
            return
        steps = ceil(max(abs(distance) / STEP[0], abs(angle) / STEP[1])) or 1
        for number in range(steps):
            self._add_errors(self.odometry.yaw + angle * (number + 0.5) / steps, distance / steps, angle / steps,
                             along / steps, aside / steps, turn / steps)
        self.odometry.move(distance, angle)

    def _add_errors(self, middle: float, distance: float, angle: float, along: float, aside: float, turn: float
                    ) -> None:
        """Add the errors of a step. middle: heading (rad) in its middle; along, aside, turn: see _variances()."""
        # the chord of an arc is shorter than the arc by about distance * angle^2 / 24
        along += (distance * angle / 12) ** 2 * (2 * self.rounding[1] + turn)
        c, s = cos(middle), sin(middle)
        # J C J' + K V K', with the Jacobians of the new pose with respect to the old pose and to the travel. This is
        # written out because numpy needs six times as long for matrices this small, and this runs at each reading
        x, y = -distance * s, distance * c
        self.xx += (2 * self.x_yaw + x * self.yaw_yaw) * x + along * c * c + aside * s * s + turn * x * x / 4
        self.xy += (self.y_yaw * x + self.x_yaw * y + self.yaw_yaw * x * y
                    + (along - aside) * c * s + turn * x * y / 4)
        self.yy += (2 * self.y_yaw + y * self.yaw_yaw) * y + along * s * s + aside * c * c + turn * y * y / 4
        self.x_yaw += (self.yaw_yaw + turn / 2) * x
        self.y_yaw += (self.yaw_yaw + turn / 2) * y
        self.yaw_yaw += turn
