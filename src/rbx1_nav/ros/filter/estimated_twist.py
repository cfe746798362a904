"""Calculates the robot's velocity from two consecutive estimates."""
from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

from rbx1_nav.estimation.arrivals import IMU
from rbx1_nav.estimation.combined_odometry import DROPOUT_SPEED, CombinedOdometry, Estimate
from rbx1_nav.estimation.filter import BIAS, SCALE, SLIP_STRAIGHT, SLIP_TURNING
from rbx1_nav.robot.readings import MEASURED
from rbx1_nav.simulation.floor_noise import CELL_TRAVELLED, CELL_TURNED
from rbx1_nav.units import SECOND, wrap_angle


class EstimatedTwist(NamedTuple):
    """Mean velocities in the robot's frame and their variances."""

    forward: float              # m/s
    left: float                 # m/s
    turn: float                 # rad/s
    forward_variance: float     # m^2/s^2
    left_variance: float        # m^2/s^2
    turn_variance: float        # rad^2/s^2


def _of_floor(noise: float, speed: float, elapsed: float, cell: float) -> float:
    """Return the variance of a speed due to the noise of a floor, which is constant within a cell and averages out over
    several cells."""
    return noise ** 2 * speed ** 2 / max(cell, speed * elapsed)


def estimate_twist(combined: CombinedOdometry, before: Estimate) -> EstimatedTwist | None:
    """Return the EstimatedTwist from the Estimate `before` to the latest one; None if their stamps are equal.

    The displacement comes from the odometry, reduced by the slip of the assumed floor, and the turn comes from the
    filter. During an odometry dropout the displacement is unknown: it is set to 0, with the uncertainty that the filter
    assumes for a dropout. The uncertainty is the same while the robot is carried, because its wheels do not measure its
    motion.
    """
    last, ekf = combined.estimate, combined.filter
    assert last is not None and ekf is not None     # because there is a `before`
    elapsed = (last.stamp - before.stamp) / SECOND
    if elapsed <= 0:
        return None
    prior = ekf.prior
    turn = wrap_angle(last.pose.yaw - before.pose.yaw) / elapsed
    travel_time = (last.odom.stamp - before.odom.stamp) / SECOND
    forward = left = by_wheels = 0.0
    forward_variance = left_variance = DROPOUT_SPEED ** 2
    if travel_time > 0:
        start, end = before.odom.pose, last.odom.pose
        turned = wrap_angle(end.yaw - start.yaw)
        c, s = cos(start.yaw + turned / 2), sin(start.yaw + turned / 2)
        share = (1 - prior.slip_straight) / travel_time
        dx, dy = end.x - start.x, end.y - start.y
        forward, left = (dx * c + dy * s) * share, (dy * c - dx * s) * share
        by_wheels = turned / travel_time
        if combined.case != 'carried':
            slip = ekf.sigma(SLIP_STRAIGHT) ** 2
            floor = _of_floor(prior.distance_noise, abs(forward), travel_time, CELL_TRAVELLED)
            forward_variance = MEASURED + max(last.odom.linear_variance, floor) + slip * forward ** 2
            left_variance = MEASURED + slip * left ** 2      # wheels do not roll sideways

    imu = combined.readings.last if combined.gyro_used and not combined.timed_out[IMU] else None
    if imu:
        step = last.stamp - before.stamp
        # the noise averages out over the readings of the step
        averaged = imu.variance * min(1.0, (combined.readings.period or step) / step)
        turn_variance = averaged + ekf.sigma(BIAS) ** 2 + (ekf.sigma(SCALE) * turn) ** 2
        if combined.case == 'contradiction':    # either wheels or gyro are wrong
            turn_variance += (by_wheels * (1 - prior.slip_turning) - turn) ** 2
    else:
        floor = (_of_floor(prior.heading_noise_turning, abs(by_wheels), elapsed, CELL_TURNED)
                 + _of_floor(prior.heading_noise_straight, abs(forward), elapsed, CELL_TRAVELLED))
        turn_variance = max(last.odom.angular_variance, floor) + (ekf.sigma(SLIP_TURNING) * turn) ** 2
    return EstimatedTwist(forward, left, turn, forward_variance, left_variance, MEASURED + turn_variance)
