"""The inputs of the filter: odometry and gyro readings, and the checks that find invalid messages and jumps."""
from __future__ import annotations

from math import hypot
from typing import NamedTuple

from rbx1_nav.base.covariances import MIN_VARIANCE
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND, wrap_angle
from rbx1_nav.filter.priors import Bounds

MAX_NUMBER = 1e6        # m or rad/s: above this, sums lose small terms
MAX_VARIANCE = 1 / MIN_VARIANCE
NUMBER = f'a number of at most {MAX_NUMBER:g}'
VARIANCE = f'a variance above 0, from {MIN_VARIANCE:g} to {MAX_VARIANCE:g}'
POSE_FIELDS = 'pose.pose.position.x', 'pose.pose.position.y', 'pose.pose.orientation'
JUMP_TOLERANCE = 0.02   # m and rad that are allowed in addition


class Odom(NamedTuple):
    """Wheel odometry."""

    stamp: int                  # ns
    pose: Pose                  # in the odometry frame
    linear_variance: float = 0.0    # variance of the linear speed, m^2/s^2; 0 or less, or not finite: not known
    angular_variance: float = 0.0   # variance of the angular speed, rad^2/s^2; the same


class Imu(NamedTuple):
    """A reading of a gyro."""

    stamp: int          # ns
    rate: float         # angular velocity, rad/s
    variance: float     # rad^2/s^2
    is_mean: bool = False   # whether it is the mean since the previous reading, however long ago


class RejectedMessage(ValueError):
    """Raised for a message that must not reach the filter.

    The text names the field, the value and what is expected.
    """


def check(field: str, value: object, good: object, expected: str) -> None:
    """Raise RejectedMessage if a value is not good."""
    if not good:
        raise RejectedMessage(f'{field}: {value}: expected {expected}')


def check_number(field: str, value: float) -> None:
    """Raise RejectedMessage if a value is not finite, or above MAX_NUMBER."""
    if not abs(value) <= MAX_NUMBER:
        check(field, value, False, NUMBER)


def check_variance(field: str, value: float) -> None:
    """Raise RejectedMessage if a variance is not between MIN_VARIANCE and MAX_VARIANCE."""
    if not MIN_VARIANCE <= value <= MAX_VARIANCE:
        check(field, value, False, VARIANCE)


def check_odom(odom: Odom) -> None:
    """Raise RejectedMessage if an Odom cannot be used."""
    x, y, yaw = odom.pose
    if not (abs(x) <= MAX_NUMBER and abs(y) <= MAX_NUMBER and abs(yaw) <= MAX_NUMBER):
        for field, value in zip(POSE_FIELDS, odom.pose):
            check_number(field, value)


def check_imu(imu: Imu) -> None:
    """Raise RejectedMessage if an Imu cannot be used."""
    check_number('angular_velocity.z', imu.rate)
    check_variance('angular_velocity_covariance[8]', imu.variance)


def format_pose(odom: Odom) -> str:
    x, y, yaw = odom.pose
    return f'({x:.3f} m, {y:.3f} m, {yaw:.3f} rad)'


def distance(one: Odom, other: Odom) -> float:
    """Return the distance between two Odoms, m."""
    return hypot(other.pose.x - one.pose.x, other.pose.y - one.pose.y)


def has_jumped(before: Odom, odom: Odom, limits: Bounds) -> bool:
    """Return whether no robot within its Bounds can have moved from one Odom to another in the time between them."""
    elapsed, (x, y, yaw), (last_x, last_y, last_yaw) = (odom.stamp - before.stamp) / SECOND, odom.pose, before.pose
    return (hypot(x - last_x, y - last_y) > limits.max_speed * elapsed + JUMP_TOLERANCE
            or abs(wrap_angle(yaw - last_yaw)) > limits.max_turn_rate * elapsed + JUMP_TOLERANCE)
