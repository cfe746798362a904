"""The covariance of the odometry is propagated as in the textbook."""
from math import cos, sin
from typing import NamedTuple

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.covariances import HELD, OdometryErrors, UncertainOdometry

ERRORS = OdometryErrors(0.05, 0.09, 0.07)
ROUNDING = 0.001, 0.005     # m, rad


class Travel(NamedTuple):
    distance: float
    angle: float
    distance_variance: float = 0.0
    angle_variance: float = 0.0


# a heading that is counted in whole units also stays the same over several short steps: small angles
travels = st.lists(st.builds(Travel, st.floats(-0.1, 0.1), st.floats(-0.2, 0.2) | st.floats(-0.01, 0.01),
                             st.floats(0, 1e-3), st.floats(0, 1e-3)), min_size=1, max_size=5)


def aside(travel):
    """Return the variance of the sideways displacement, as in the docstring of _variances()."""
    distance, angle = abs(travel.distance), abs(travel.angle)
    unit = 12 ** 0.5 * ROUNDING[1]      # the unit whose rounding has the standard deviation ROUNDING
    path = min(HELD, unit * distance / angle) if angle else HELD
    return ROUNDING[1] ** 2 * distance * max(path, distance / 2)


@given(travels)
def test_each_step_propagates_the_covariance_to_first_order(steps):
    odometry = UncertainOdometry(0.26, ERRORS, ROUNDING)
    expected = numpy.zeros((3, 3))
    for travel in steps:
        middle = odometry.pose.yaw + travel.angle / 2
        c, s = cos(middle), sin(middle)
        by_pose = numpy.array([[1, 0, -travel.distance * s], [0, 1, travel.distance * c], [0, 0, 1]])
        by_travel = numpy.array([[c, -s, -travel.distance * s / 2], [s, c, travel.distance * c / 2], [0, 0, 1]])
        turn = (travel.angle_variance + ERRORS.angular ** 2 * abs(travel.angle)
                + ERRORS.heading ** 2 * abs(travel.distance))
        chord = (travel.distance * travel.angle / 12) ** 2 * (2 * ROUNDING[1] ** 2 + turn)
        length = travel.distance_variance + ERRORS.linear ** 2 * abs(travel.distance) + chord
        expected = (by_pose @ expected @ by_pose.T
                    + by_travel @ numpy.diag([length, aside(travel), turn]) @ by_travel.T)
        odometry.move(travel)
    rounding = numpy.diag([ROUNDING[0] ** 2, ROUNDING[0] ** 2, ROUNDING[1] ** 2])
    numpy.testing.assert_allclose(odometry.covariance, expected + rounding, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize('distance, angle', [(3, 0), (-1, 0.3), (2, -5), (0.2, 12), (0, 6)])
def test_a_long_travel_is_as_uncertain_as_many_short_ones(distance, angle):
    long, short = (UncertainOdometry(0.26, ERRORS, (0.0, 0.0)) for _ in range(2))
    long.move(Travel(distance, angle, 0.01, 0.02))
    for _ in range(1000):
        short.move(Travel(distance / 1000, angle / 1000, 1e-5, 2e-5))
    # 2 %: a step of 10 cm or 0.2 rad is linearized about its middle
    assert numpy.array(long.covariance) == pytest.approx(numpy.array(short.covariance), rel=0.02, abs=1e-5)
    assert long.pose == pytest.approx(short.pose)


def test_a_robot_at_rest_is_as_certain_as_its_counts():
    odometry = UncertainOdometry(0.26, ERRORS, ROUNDING)
    odometry.move(Travel(0.0, 0.0))
    assert odometry.covariance == pytest.approx(numpy.diag([1e-6, 1e-6, 2.5e-5]))


def test_a_travel_that_was_not_read_makes_a_robot_at_rest_uncertain():
    odometry = UncertainOdometry(0.26, ERRORS, ROUNDING)
    odometry.move(Travel(0.0, 0.0, 0.01, 0.02))
    assert odometry.covariance == pytest.approx(numpy.diag([0.01 + 1e-6, 1e-6, 0.02 + 2.5e-5]))


def test_driving_straight_a_rounded_heading_moves_the_robot_aside_by_up_to_30_cm_of_its_error():
    odometry = UncertainOdometry(0.26, OdometryErrors(0.0, 0.0, 0.0), ROUNDING)
    for _ in range(100):
        odometry.move(Travel(0.01, 0.0))
    # 1 m at an error of 0.005 rad that is another one after each 0.3 m, and the rounding of the counts
    assert odometry.covariance[1][1] == pytest.approx(0.005 ** 2 * 1.0 * 0.3 + 1e-6)
    assert odometry.covariance[0][0] == pytest.approx(1e-6) and odometry.pose.x == pytest.approx(1.0)
