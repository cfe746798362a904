"""A robot hangs in a turn, and answers late what it was asked meanwhile: no travel is lost, or counted twice."""
from math import sqrt
import random

import numpy
import pytest

from rbx1_nav.base.units import SECOND, wrap_angle

from driven_create import NO_ERRORS, started

SIGMA = 3
ROUNDING = 0.02     # rad: a Create counts whole degrees


@pytest.mark.parametrize('seed', range(30))
@pytest.mark.parametrize('robot_type, params', [
    ('create', {}), ('create', {'angle_fractions': 'kept'}), ('create2', {})])
def test_a_turn_during_a_hang_is_counted(robot_type, params, seed):
    choose = random.Random(seed)
    driven = started(robot_type, 1.2, seed=seed, **NO_ERRORS, **params)
    motion = choose.uniform(-0.2, 0.2), choose.choice((-1, 1)) * choose.uniform(0.3, 1.5)
    driven.drive(*motion, choose.uniform(1, 2))
    driven.run(0.002 * choose.randrange(17))        # the robot may be about to reply
    driven.hang(choose.choice((0.1, 0.3, 0.6, 1.0, 1.5, 1.5, 2.0, 2.5)))
    driven.drive(*motion, choose.choice((0.1, 1.5)))    # the sender gives up, or does not notice
    driven.run(max(0, driven.hangs_until - driven.now) / SECOND + 1.5)
    error = numpy.array(driven.pose) - driven.truth
    sigma = sqrt(driven.driver.motion.odometry.covariance[2][2])
    assert abs(wrap_angle(error[2])) < SIGMA * sigma + ROUNDING
    assert driven.speeds == (0, 0) and driven.driver.contact.answers
