"""Detects odometry that has jumped farther than a robot can move in the time between two messages."""
from __future__ import annotations

from math import hypot

from rbx1_nav.estimation.inputs import Odom
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.units import SECOND, wrap_angle

JUMP_TOLERANCE = 0.02   # m and rad that are allowed in addition


def format_pose(odom: Odom) -> str:
    """Return the pose of an Odom as text."""
    x, y, yaw = odom.pose
    return f'({x:.3f} m, {y:.3f} m, {yaw:.3f} rad)'


def distance(one: Odom, other: Odom) -> float:
    """Return the distance between two Odoms, m."""
    return hypot(other.pose.x - one.pose.x, other.pose.y - one.pose.y)


def has_jumped(before: Odom, odom: Odom, limits: Limits) -> bool:
    """Return whether no robot within its Limits can have moved from one Odom to another in the time between them."""
    elapsed = (odom.stamp - before.stamp) / SECOND
    return (distance(before, odom) > limits.max_speed * elapsed + JUMP_TOLERANCE
            or abs(wrap_angle(odom.pose.yaw - before.pose.yaw)) > limits.max_turn_rate * elapsed + JUMP_TOLERANCE)
