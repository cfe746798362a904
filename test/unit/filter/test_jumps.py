"""Odometry has jumped if no robot within the limits moves that far, plus 0.02 m and 0.02 rad."""
from math import pi

import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import Odom, has_jumped
from rbx1_nav.filter.priors import Bounds


def odom(time, x=0.0, y=0.0, yaw=0.0):
    """Return an Odom at a time (s)."""
    return Odom(round(time * SECOND), Pose(x, y, yaw))


@pytest.mark.parametrize('limits, speed, turn_rate', [
    (Bounds(), 6.0, 6.0), (Bounds(max_speed=2.0), 2.0, 6.0), (Bounds(max_turn_rate=0.5), 6.0, 0.5)])
@pytest.mark.parametrize('elapsed', [0.02, 0.3])
def test_the_limits_and_the_time_decide(limits, speed, turn_rate, elapsed):
    before = odom(5.0, 1.0, 2.0, 0.3)
    for beyond in -1e-6, 1e-6:
        far, turn = speed * elapsed + 0.02 + beyond, turn_rate * elapsed + 0.02 + beyond
        jumped = beyond > 0
        assert has_jumped(before, odom(5.0 + elapsed, 1.0 - 0.6 * far, 2.0 + 0.8 * far, 0.3), limits) == jumped
        assert has_jumped(before, odom(5.0 + elapsed, 1.0, 2.0, 0.3 - turn), limits) == jumped
        assert has_jumped(before, odom(5.0 + elapsed, 1.0, 2.0, 0.3 + turn), limits) == jumped


def test_a_whole_turn_of_the_yaw_is_no_jump():
    assert not has_jumped(odom(0.0, yaw=pi), odom(0.02, yaw=-pi), Bounds())
    assert not has_jumped(odom(0.0, yaw=0.0), odom(0.02, yaw=4 * pi), Bounds())
