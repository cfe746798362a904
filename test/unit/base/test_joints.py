"""A joint stays within its limits and its maximum speed."""
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.description import Joint, JointGroup
from rbx1_nav.base.units import SECOND


@given(st.lists(st.tuples(st.floats(-10, 10), st.floats(0, 2)), max_size=20))
def test_a_joint_stays_within_its_limits_and_its_speed(moves):
    joint = Joint('pan', -1.0, 2.0, 0.5)
    for goal, duration in moves:
        before = joint.position
        joint.command(goal)
        joint.advance(duration)
        assert -1.0 <= joint.position <= 2.0
        assert abs(joint.position - before) <= 0.5 * duration + 1e-12
        assert abs(joint.velocity) <= 0.5 + 1e-9


def test_a_joint_reports_the_speed_at_which_it_moves():
    joint = Joint('pan', -1.0, 2.0, 0.5)
    assert joint.velocity == 0.0
    joint.command(0.3)
    joint.advance(0.4)
    assert joint.position == pytest.approx(0.2) and joint.velocity == pytest.approx(0.5)
    joint.command(-5.0)
    joint.advance(4.0)      # 1.2 rad to the lower limit in 4 s
    assert joint.position == -1.0 and joint.velocity == pytest.approx(-0.3)


@pytest.mark.parametrize('goal', [nan, inf])
def test_a_goal_that_is_not_finite_is_rejected(goal):
    joint = Joint('pan', -1.0, 2.0, 0.5)
    with pytest.raises(ValueError, match=f'^{goal}: expected a finite angle in rad'):
        joint.command(goal)
    joint.advance(1.0)
    assert joint.position == 0.0


def make_group():
    """Return a group of two joints that move to 1 rad at different speeds."""
    joints = [Joint('pan', -2.0, 2.0, 0.5), Joint('tilt', -2.0, 2.0, 0.25)]
    for joint in joints:
        joint.command(1.0)
    return JointGroup(joints)


def positions(group):
    return [joint.position for joint in group.joints]


def test_a_group_moves_its_joints_by_the_elapsed_time():
    group = make_group()
    group.advance(1000 * SECOND)    # the first call has no previous time
    assert positions(group) == [0.0, 0.0]
    group.advance(1001 * SECOND)
    assert positions(group) == [0.5, 0.25]
    group.advance(1002 * SECOND)
    assert positions(group) == [1.0, 0.5]


def test_a_clock_that_jumps_back_moves_no_joint():
    group = make_group()
    group.advance(1000 * SECOND)
    group.advance(1001 * SECOND)
    group.advance(5 * SECOND)
    assert positions(group) == [0.5, 0.25] and [joint.velocity for joint in group.joints] == [0.0, 0.0]
    # from there on the group follows the new time
    group.advance(6 * SECOND)
    assert positions(group) == [1.0, 0.5]
