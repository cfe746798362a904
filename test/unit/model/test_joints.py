"""A joint stays within its limits and its speed."""
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.model.joints import Joint


@given(st.lists(st.tuples(st.floats(-10, 10), st.floats(0, 2)), max_size=20))
def test_limits_and_speed(moves):
    joint = Joint('pan', -1.0, 2.0, 0.5)
    for goal, duration in moves:
        before = joint.position
        joint.command(goal)
        joint.advance(duration)
        assert -1.0 <= joint.position <= 2.0
        assert abs(joint.position - before) <= 0.5 * duration + 1e-12
        assert abs(joint.velocity) <= 0.5 + 1e-9


def test_it_arrives_and_stays():
    joint = Joint('pan', -1.0, 2.0, 0.5)
    joint.command(0.3)
    for _ in range(7):
        joint.advance(0.1)
    assert joint.position == 0.3 and joint.velocity == 0.0


@pytest.mark.parametrize('goal', [nan, inf])
def test_what_is_not_finite_is_refused(goal):
    joint = Joint('pan', -1.0, 2.0, 0.5)
    with pytest.raises(ValueError):
        joint.command(goal)
    joint.advance(1.0)
    assert joint.position == 0.0


def test_it_starts_within_its_limits():
    assert Joint('lift', 0.5, 2.0, 0.5).position == 0.5
