"""The reported motion: corrected pose, mean velocity, wheel travel, standstill and variances."""
import pytest

from rbx1_nav.base.covariances import Travel
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.create_parameters import read_settings
from rbx1_nav.extras.create.odometry import NOWHERE, MotionReport
from rbx1_nav.extras.create.protocol import CREATE

ROUNDING = 0.002, 0.03      # m, rad
MEASURED = 1e-6             # variance of a good measurement: 1 mm/s, 1 mrad/s


def make_motion(**params):
    return MotionReport(read_settings(params)[0], CREATE, ROUNDING)


def moved(travel=Travel(0.1, 0.2, 0.0, 0.0), duration=0.5, **params):
    """Return (a MotionReport with a travel since its first State, the next State)."""
    motion = make_motion(**params)
    motion.add(0, NOWHERE)
    motion.state(None)
    motion.add(round(duration * SECOND), travel)
    return motion, motion.state(None)


def test_the_velocity_is_the_mean_since_the_last_state():
    motion = make_motion()
    motion.add(SECOND, NOWHERE)
    assert motion.state(None).velocity == (0, 0)
    motion.add(SECOND * 5 // 4, Travel(0.1, 0.2, 0, 0))
    motion.add(SECOND * 3 // 2, Travel(0.2, -0.5, 0, 0))
    state = motion.state(None)
    assert state.time == SECOND * 3 // 2 and state.velocity == pytest.approx((0.6, -0.6))
    motion.add(SECOND * 7 // 4, Travel(-0.1, 0, 0, 0))
    assert motion.state(None).velocity == pytest.approx((-0.4, 0))


def test_the_variances_of_the_velocities():
    """1 sigma after 1 m or 1 rad grows with the square root; a velocity is the difference of two rounded positions."""
    travel = Travel(0.1, -0.2, 0.003, 0.005)
    _, state = moved(travel, odom_linear_error=0.05, odom_angular_error=0.09, odom_heading_error=0.07)
    linear = 0.003 + 0.05 ** 2 * 0.1 + 2 * 0.002 ** 2
    angular = 0.005 + 0.09 ** 2 * 0.2 + 0.07 ** 2 * 0.1 + 2 * 0.03 ** 2
    assert state.variances == pytest.approx((linear / 0.25 + MEASURED, angular / 0.25 + MEASURED))


def test_the_scale_corrections_apply_to_the_pose_and_not_to_the_wheels():
    motion, state = moved(Travel(0.1, 0.2, 0.003, 0.005), odom_linear_scale_correction=2.0,
                          odom_angular_scale_correction=0.5)
    assert state.pose.yaw == pytest.approx(0.1) and state.velocity == pytest.approx((0.4, 0.2))
    # half of the track is 0.13 m
    assert state.travel == pytest.approx((0.1 - 0.2 * 0.13, 0.1 + 0.2 * 0.13))
    assert motion.add(SECOND, Travel(0.1, 0.2, 0.003, 0.005)) == pytest.approx((0.2, 0.1, 0.012, 0.00125))
    assert motion.state(None).travel == pytest.approx((2 * (0.1 - 0.2 * 0.13), 2 * (0.1 + 0.2 * 0.13)))


def test_while_it_is_commanded_to_move_the_velocity_of_a_robot_without_travel_is_uncertain():
    motion = make_motion()
    motion.add(0, NOWHERE)
    motion.state(None)
    motion.command(SECOND // 2)
    motion.add(SECOND // 2, NOWHERE)
    # the rounding of two positions in half a second
    assert motion.state(None).variances == pytest.approx((2 * 0.002 ** 2 * 4 + MEASURED, 2 * 0.03 ** 2 * 4 + MEASURED))


def test_the_variance_of_the_heading_of_create_node():
    motion, state = moved(moving_yaw_variance=1000.0)
    assert state.covariance[2][2] == state.variances[1] == 1000
    assert state.variances[0] < 1 and state.covariance[0][0] < 1
    # at rest, and for the odometry itself, it is the calculated variance
    motion.add(3 * SECOND, NOWHERE)
    state = motion.state(None, unread_variance=0.5)
    assert 0.5 < state.covariance[2][2] < 1 and state.variances[1] < 1
    assert moved()[1].covariance[2][2] < 1
