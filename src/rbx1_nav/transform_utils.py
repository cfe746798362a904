"""Two functions that the driving scripts of ROS By Example import from a module of this name."""
from __future__ import annotations

from math import atan2, pi, remainder
from typing import Any


def quat_to_angle(quat: Any) -> float:
    """Return the heading (rad, from -pi to pi) of a quaternion with x, y, z and w, such as a geometry_msgs/Quaternion:
    the third of its roll, pitch and yaw angles. The quaternion need not have the length 1."""
    x, y, z, w = quat.x, quat.y, quat.z, quat.w
    return atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z)


def normalize_angle(angle: float) -> float:
    """Return the equivalent angle between -pi and pi, rad."""
    return remainder(angle, 2 * pi)
