"""The robot's motion as the base reports it: pose, velocity and wheel travel, with uncertainties."""
from __future__ import annotations

from typing import NamedTuple

from rbx1_nav.arrays import Array
from rbx1_nav.create.driver.parameters import Settings
from rbx1_nav.create.driver.travel import NOWHERE, Travel
from rbx1_nav.create.protocol import Model
from rbx1_nav.robot.kinematics import Pose
from rbx1_nav.robot.odometry import UncertainOdometry
from rbx1_nav.robot.readings import MEASURED, Reading
from rbx1_nav.units import SECOND

STANDSTILL = SECOND // 2    # ns without travel or a command to move, after which the robot is stationary


class State(NamedTuple):
    """A report of the robot's motion."""

    time: int                       # ns, time of the last reading
    pose: Pose
    covariance: Array               # 3x3
    velocity: tuple[float, float]   # m/s and rad/s, the mean since the last State
    variances: tuple[float, float]  # of both velocities
    travel: tuple[float, float]     # m, left and right wheel
    gyro: Reading | None


class MotionReport:
    """Accumulates Travel. Times are in ns."""

    def __init__(self, settings: Settings, model: Model, rounding: tuple[float, float]) -> None:
        """rounding: see travel.py."""
        self.width = model.wheel_separation
        self.corrections = settings.odom_linear_scale_correction, settings.odom_angular_scale_correction
        self.rounding = rounding
        self.moving_yaw_variance = settings.moving_yaw_variance
        self.odometry = UncertainOdometry(self.width, settings.errors, rounding)
        self.left = self.right = 0.0    # m, total travel of the wheels as the robot counts it
        self.time: int | None = None        # time of the last Travel
        self.moved_time: int | None = None  # time of the last nonzero travel or command to move
        self.reported: int | None = None    # time of the last State
        self.since = NOWHERE                # Travel since the last State

    def command(self, now: int) -> None:
        """Note that the wheels were commanded to move."""
        self.moved_time = now

    def add(self, time: int, travel: Travel) -> Travel:
        """Add a Travel that finished at `time`. Returns the corrected Travel."""
        linear, angular = self.corrections
        corrected = Travel(travel.distance * linear, travel.angle * angular,
                           travel.distance_variance * linear ** 2, travel.angle_variance * angular ** 2)
        self.odometry.move(corrected)
        self.since = Travel(*(sum(parts) for parts in zip(self.since, corrected)))
        difference = travel.angle * self.width / 2
        self.left += travel.distance - difference
        self.right += travel.distance + difference
        self.time = time
        if travel.distance or travel.angle or self.moved_time is None:
            self.moved_time = time
        return corrected

    @property
    def stands(self) -> bool:
        """Whether the robot has neither moved nor been commanded to move for STANDSTILL."""
        return self.time is not None and self.moved_time is not None and self.time - self.moved_time >= STANDSTILL

    def state(self, gyro: Reading | None, unread_variance: float = 0.0) -> State:
        """Return the State, with the gyro's last Reading or None. unread_variance: see CounterTravel. Call it after
        add()."""
        assert self.time is not None
        elapsed = (self.time - self.reported) / SECOND if self.reported is not None else 0.0
        velocity, variances = (0.0, 0.0), (MEASURED, MEASURED)
        if elapsed > 0 and (any(self.since) or not self.stands):
            velocity = self.since.distance / elapsed, self.since.angle / elapsed
            # the error is the difference of two rounding errors
            errors = self.odometry.errors.variances(self.since)
            linear, angular = ((variance + error + 2 * rounding ** 2) / elapsed ** 2 + MEASURED
                               for variance, error, rounding in zip(self.since[2:], errors, self.rounding))
            variances = linear, angular
        covariance = self.odometry.covariance
        covariance[2, 2] += unread_variance
        if self.moving_yaw_variance and any(velocity):
            covariance[2, 2] = self.moving_yaw_variance
            variances = variances[0], self.moving_yaw_variance
        self.reported, self.since = self.time, NOWHERE
        return State(self.time, self.odometry.pose, covariance, velocity, variances, (self.left, self.right), gyro)
