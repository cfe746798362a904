"""A joint stays within its limits and its maximum speed."""
from math import inf, nan

import pytest

from rbx1_nav.base.robot_parameters import Joint


def test_a_joint_reports_the_speed_at_which_it_moves():
    joint = Joint('pan', -1.0, 2.0, 0.5)
    assert joint.velocity == 0.0
    joint.command(0.3)
    joint.advance(0.4)
    assert joint.position == pytest.approx(0.2) and joint.velocity == pytest.approx(0.5)
    joint.command(-5.0)
    joint.advance(4.0)      # 1.2 rad to the lower limit in 4 s
    assert joint.position == -1.0 and joint.velocity == pytest.approx(-0.3)
    joint.command(5.0)
    joint.advance(0.0)
    assert joint.position == -1.0 and joint.velocity == 0.0
    joint.advance(10.0)
    assert joint.position == 2.0 and joint.velocity == pytest.approx(0.3)


def test_a_joint_stops_exactly_at_its_goal():
    joint = Joint('pan', -1.0, 2.0, 0.59)
    for goal in 0.59, 0.15:     # 0.59 + (0.15 - 0.59) is not 0.15
        joint.command(goal)
        joint.advance(1.0)
        assert joint.position == goal


@pytest.mark.parametrize('goal', [nan, inf])
def test_a_goal_that_is_not_finite_is_rejected(goal):
    joint = Joint('pan', -1.0, 2.0, 0.5)
    with pytest.raises(ValueError, match=f'^{goal}: expected a finite angle in rad'):
        joint.command(goal)
    joint.advance(1.0)
    assert joint.position == 0.0
