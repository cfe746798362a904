"""Extracts the turn rate for the filter from an IMU with any mounting, and also from an orientation alone.

The robot is on a floor, so it turns about its vertical axis only.
"""
from __future__ import annotations

from math import atan2, sqrt
from typing import Callable, NamedTuple, Sequence, Tuple

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import Imu, check, check_number, check_variance

UPRIGHT = (0.0, 0.0, 1.0)
DEFAULT_VARIANCE = 0.00017 ** 2     # for an IMU that gives none: robot_pose_ekf, OdomEstimationNode::imuCallback
MIN_SHARE = 1e-3    # share of the rate that an axis must measure to be used: 3.14 in a URDF file is not pi

Vector = Tuple[float, float, float]
Quaternion = Tuple[float, float, float, float]  # x, y, z, w, of length 1


class ImuData(NamedTuple):
    """The data of an Imu message."""

    stamp: int                          # ns
    rates: Sequence[float] | None       # angular velocity by axis, rad/s; None if the message has none
    rate_variances: Sequence[float]     # variance of each rate, rad^2/s^2
    orientation: Quaternion | None      # None if the message has none
    yaw_variance: float                 # variance of the orientation's yaw, rad^2


def multiply(one: Quaternion, other: Quaternion) -> Quaternion:
    ax, ay, az, aw = one
    bx, by, bz, bw = other
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def inverse(rotation: Quaternion) -> Quaternion:
    x, y, z, w = rotation
    return -x, -y, -z, w


def vertical_axis(mounting: Quaternion) -> Vector:
    """Return the vertical axis of the robot in the frame of an IMU.

    mounting: rotation of the IMU in the robot's frame.
    """
    x, y, z, w = mounting
    return 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)     # last row of the rotation matrix


def turn_about(axis: Vector, before: Quaternion, after: Quaternion) -> float:
    """Return the part of the turn from one orientation to another that is about an axis of the turned frame, rad."""
    x, y, z, w = multiply(inverse(before), after)
    sine = sqrt(x * x + y * y + z * z)
    angle = 2 * atan2(sine, abs(w))
    return sum(a * b for a, b in zip(axis, (x, y, z))) * (angle / sine if w >= 0 else -angle / sine) if sine else 0.0


class GyroInput:
    """Converts the ImuData of one IMU to Imus."""

    def __init__(self, note: Callable[[str], None] = lambda text: None) -> None:
        """note(text): called once for each note to the user."""
        self.note = note
        self.noted: set[str] = set()
        self.last: ImuData | None = None    # the last that was accepted
        self.has_rates = False      # whether the IMU has ever measured an angular velocity

    def read(self, data: ImuData, vertical: Vector = UPRIGHT) -> Imu:
        """Return the Imu of an ImuData. vertical: see vertical_axis(). Raises RejectedMessage.

        Without an angular velocity (or if it and its variances are all 0), the rate is the change of the orientation
        since the last accepted ImuData, with the variance of the orientation per square second, as in robot_pose_ekf.
        """
        rates, orientation = data.rates, data.orientation
        check('angular_velocity_covariance[0]', -1, rates or orientation, 'an angular velocity or an orientation')
        check('angular_velocity_covariance[0]', -1, rates or not self.has_rates, 'an angular velocity, as before')
        if orientation and (rates is None or not (self.has_rates or any(rates) or any(data.rate_variances))):
            return self._from_orientation(data, orientation, vertical)
        assert rates is not None    # or there would be an orientation
        return self._from_rates(data, rates, vertical)

    def accepted(self, data: ImuData) -> None:
        """Store the ImuData of an Imu that the filter has accepted; call this for each of them."""
        self.last = data
        self.has_rates = self.has_rates or bool(data.rates and any(data.rates))

    def _from_rates(self, data: ImuData, rates: Sequence[float], vertical: Vector) -> Imu:
        axes = [axis for axis in range(3) if abs(vertical[axis]) >= MIN_SHARE]
        for axis in axes:
            check_number(f"angular_velocity.{'xyz'[axis]}", rates[axis])
            if data.rate_variances[axis] != 0:
                check_variance(f'angular_velocity_covariance[{4 * axis}]', data.rate_variances[axis])
        # an axis without a variance is used only if no other axis has a variance
        variances = {axis: data.rate_variances[axis] for axis in axes if data.rate_variances[axis]}
        if not variances:
            self._note('no angular velocity covariance: assuming 0.00017 rad/s')
            variances = dict.fromkeys(axes, DEFAULT_VARIANCE)
        # each axis measures its share of the rate; the rate is the mean of the axes, weighted by inverse variance
        least = min(variances.values())
        total = sum(vertical[axis] ** 2 * least / variance for axis, variance in variances.items())
        rate = sum(vertical[axis] * least / variance * rates[axis] for axis, variance in variances.items()) / total
        return Imu(data.stamp, rate, least / total)

    def _from_orientation(self, data: ImuData, orientation: Quaternion, vertical: Vector) -> Imu:
        variance = data.yaw_variance
        if variance == 0:
            self._note('no orientation covariance: assuming 0.00017 rad')
            variance = DEFAULT_VARIANCE
        check_variance('orientation_covariance[8]', variance)
        last, rate = self.last, 0.0     # the filter does not use the first reading
        if last and last.orientation and data.stamp > last.stamp:
            rate = turn_about(vertical, last.orientation, orientation) / ((data.stamp - last.stamp) / SECOND)
        if rate:
            self._note('no angular velocity: using the change in orientation instead')
        return Imu(data.stamp, rate, variance, is_mean=True)

    def _note(self, text: str) -> None:
        if text not in self.noted:
            self.noted.add(text)
            self.note(text)
