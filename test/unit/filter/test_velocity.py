"""The velocity is what odometry and gyro measured in the last step, with a matching uncertainty."""
import pytest

from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.filter.filter import Filter
from rbx1_nav.filter.input_checks import Odom
from rbx1_nav.filter.pose_errors import BIAS, SLIP
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from rbx1_nav.filter.velocity import Motion, velocity
from sample_priors import IDEAL
from sample_robot import Robot

FLOOR = UNKNOWN_FLOOR._replace(slip_straight=0.1, slip_straight_spread=0.07, slip_turning=0.2, distance_noise=0.3,
                               heading_noise_turning=0.4, heading_noise_straight=0.5, gyro_scale_error=0.03)
GOOD = 1e-6     # (m/s)^2 or (rad/s)^2: what a good sensor measures
# variances of the slip forward, of the bias and scale error of the gyro, and of the slip of the wheels in a turn
SLIPPED, GYRO, WHEELS = (0.07 * 0.225) ** 2, 0.02 ** 2 + (0.03 * 0.5) ** 2, (0.6 * 0.4) ** 2


def measure(time=2.0, doubted=False, reported=(0.0, 0.0), gyro=True, carried=False):
    """Return the Velocity of a robot whose odometry moves at 0.25 m/s forward, -0.1 m/s to the left and turns at 0.4
    rad/s for a time (s), while the gyro turns at 0.5 rad/s and a bias of 0.25 rad/s, with a noise of 0.01 rad^2/s^2."""
    ekf = Filter(FLOOR, ORIGIN)
    ekf.bias = ekf.error[BIAS] = 0.25
    ekf.P[BIAS][BIAS], ekf.P[SLIP][SLIP] = 0.02 ** 2, 0.6 ** 2
    turn = (0.75 * time, 0.01 * time ** 2) if gyro else None
    return velocity(Motion(time, 0.25 * time, -0.1 * time, 0.4 * time, turn, carried), Odom(0, ORIGIN, *reported), ekf,
                    doubted)


@pytest.mark.parametrize('options, forward, turn', [
    (dict(time=2.0), 0.3 ** 2 * 0.225 / 2 + SLIPPED, 0.01 + GYRO),
    # within a cell of 0.1 m, the noise of the floor is constant
    (dict(time=0.1), 0.3 ** 2 * 0.225 ** 2 / 0.1 + SLIPPED, 0.01 + GYRO),
    (dict(reported=(0.6, 9.0)), 0.6 + SLIPPED, 0.01 + GYRO),
    (dict(carried=True), 0.25 - GOOD, 0.01 + GYRO),
    # the wheels turn at 0.4 rad/s less 20 % of slip
    (dict(doubted=True), 0.3 ** 2 * 0.225 / 2 + SLIPPED, 0.01 + GYRO + (0.32 - 0.5) ** 2),
    # without the gyro: noise of the floor and slip, and within cells of 0.25 rad and 0.1 m
    (dict(gyro=False), 0.3 ** 2 * 0.225 / 2 + SLIPPED, 0.4 ** 2 * 0.4 / 2 + 0.5 ** 2 * 0.225 / 2 + WHEELS),
    (dict(time=0.1, gyro=False), 0.3 ** 2 * 0.225 ** 2 / 0.1 + SLIPPED,
     0.4 ** 2 * 0.4 ** 2 / 0.25 + 0.5 ** 2 * 0.225 ** 2 / 0.1 + WHEELS),
    (dict(gyro=False, reported=(0.6, 0.7)), 0.6 + SLIPPED, 0.7 + WHEELS)])
def test_the_displacement_is_reduced_by_the_slip_and_the_variances_cover_all_errors(options, forward, turn):
    found = measure(**options)
    assert found[:3] == pytest.approx((0.9 * 0.25, -0.9 * 0.1, 0.5 if options.get('gyro', True) else 0.32))
    left = forward if options.get('carried') else (0.07 * 0.09) ** 2
    assert found[3:] == pytest.approx((GOOD + forward, GOOD + left, GOOD + turn))


def test_the_velocity_of_a_robot_is_what_it_does_now():
    robot = Robot(IDEAL)
    robot.send(1)
    assert robot.combined.velocity is None      # nothing is measured before the first step
    for linear, angular in (0.0, 0.0), (0.2, 0.5), (-0.1, 0.0), (0.0, 0.0):
        robot.send(60, linear, angular)
        assert robot.combined.velocity[:3] == pytest.approx((linear, 0.0, angular), abs=1e-6)   # arc and chord
    robot.combined.restart()
    assert robot.combined.velocity is None


def test_a_gyro_that_fails_is_not_used_for_the_turn_either():
    robot = Robot(UNKNOWN_FLOOR)
    robot.send(60)
    for sign in 1, -1:
        robot.send(100, 0.0, sign * 0.5, bias=-sign)    # it turns the other way
    assert robot.combined.filter.gyro_left and robot.combined.velocity.turn == pytest.approx(-0.5)
