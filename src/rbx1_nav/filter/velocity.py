"""The velocity of the robot: what wheels and gyro measured in the last step."""
from __future__ import annotations

from typing import NamedTuple

from rbx1_nav.base.covariances import MEASURED
from rbx1_nav.base.surfaces import CELL_TRAVELLED, CELL_TURNED
from rbx1_nav.filter.filter import Filter
from rbx1_nav.filter.gyro_readings import Measurement
from rbx1_nav.filter.input_checks import Odom
from rbx1_nav.filter.pose_errors import BIAS, CARRY_SPEED, SLIP


class Motion(NamedTuple):
    """What the sensors measured in a step."""

    duration: float     # s
    forward: float      # m, in the robot's frame halfway through the turn
    left: float         # m
    wheels: float       # rad: the turn that the wheels report
    gyro: Measurement | None    # the turn of the gyro, with its bias; None if it was not used
    carried: bool       # whether the robot was moved with its wheels at rest


class Velocity(NamedTuple):
    """A velocity in the robot's frame, and its variances: m/s, rad/s."""

    forward: float
    left: float
    turn: float
    forward_variance: float
    left_variance: float
    turn_variance: float


def _of_floor(noise: float, speed: float, duration: float, cell: float) -> float:
    """Return the variance of a speed due to the noise of a floor, which is constant within a cell and averages out over
    several cells."""
    return noise ** 2 * speed ** 2 / max(cell, abs(speed) * duration)


def velocity(motion: Motion, odom: Odom, ekf: Filter, doubted: bool) -> Velocity:
    """Return the Velocity in a Motion that ends at an Odom.

    The displacement is that of the odometry, reduced by the slip of the assumed floor. The turn is the gyro's, less its
    bias. doubted: whether wheels and gyro contradict each other, so that either may be wrong.
    """
    prior, duration = ekf.prior, motion.duration
    share = (1 - prior.slip_straight) / duration
    forward, left, wheels = motion.forward * share, motion.left * share, motion.wheels / duration
    forward_variance = left_variance = CARRY_SPEED ** 2     # the wheels of a robot that is carried do not measure
    if not motion.carried:
        slip = prior.slip_straight_spread ** 2
        floor = _of_floor(prior.distance_noise, forward, duration, CELL_TRAVELLED)
        forward_variance = MEASURED + max(odom.linear_variance, floor) + slip * forward ** 2
        left_variance = MEASURED + slip * left ** 2     # wheels do not roll sideways
    by_wheels = wheels * (1 - ekf.error[SLIP])
    if motion.gyro:
        turn = motion.gyro[0] / duration - ekf.bias
        variance = motion.gyro[1] / duration ** 2 + ekf.sigma(BIAS) ** 2 + (ekf.scale_error * turn) ** 2
        if doubted:
            variance += (by_wheels - turn) ** 2
    else:
        turn = by_wheels
        floor = (_of_floor(prior.heading_noise_turning, wheels, duration, CELL_TURNED)
                 + _of_floor(prior.heading_noise_straight, forward, duration, CELL_TRAVELLED))
        variance = max(odom.angular_variance, floor) + (ekf.sigma(SLIP) * wheels) ** 2
    return Velocity(forward, left, turn, forward_variance, left_variance, MEASURED + variance)
