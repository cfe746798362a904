"""Delayed commands reach the motors completely, whatever the steps."""
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.motors import Delay
from rbx1_nav.simulation.wheels import Wheels
from sample_surface import RUN, SURFACE

WIDTH = 0.26
DELAY = 0.23    # s, not a multiple of a tick
LATE = SURFACE._replace(delay=DELAY)
speeds = st.sampled_from([-1.0, 0.0, 0.2, 0.7])
inputs = st.lists(st.tuples(speeds, speeds, st.floats(0, 1)), min_size=1, max_size=30)


def command_at(parts, time):
    """Return the command in force at a time, or None within 1 ns of a change.

    parts: successive (linear, angular, duration).
    """
    ends = list(accumulate(duration for _, _, duration in parts))
    if any(abs(time - end) < 1e-9 for end in ends):
        return None
    return next((part[:2] for part, end in zip(parts, ends) if time < end), None)


def middles(parts):
    """Return a time in the middle of each part."""
    ends = list(accumulate(duration for _, _, duration in parts))
    return [end - duration / 2 for (_, _, duration), end in zip(parts, ends) if duration > 1e-8]


@given(st.floats(1e-3, 2), inputs)
def test_what_is_passed_on_is_what_came_in_a_delay_earlier(delay, commands):
    line = Delay(delay)
    passed = []
    for command in commands:
        parts = list(line.over(*command))
        assert sum(duration for _, _, duration in parts) == pytest.approx(command[2], abs=1e-12)
        assert all(duration >= 0 for _, _, duration in parts)
        passed += parts
    late = [(0.0, 0.0, delay), *commands]
    for time in middles(passed):
        assert command_at(late, time) in (command_at(passed, time), None)
    for time in middles(late):
        assert command_at(passed, time) in (command_at(late, time), None)


def test_wheels_start_and_stop_a_delay_later_and_travel_as_far():
    late, punctual = Wheels(WIDTH, Floor(LATE, RUN), 0.02), Wheels(WIDTH, Floor(SURFACE, RUN), 0.02)
    late.travel(0.2, 0.0, DELAY)
    assert late.truth.pose.x == 0 and not late.at_rest
    late.travel(0.2, 0.0, 2.0 - DELAY)
    late.travel(0.0, 0.0, DELAY)
    punctual.travel(0.2, 0.0, 0.01)
    assert not punctual.at_rest     # before the first tick of the encoders
    punctual.travel(0.2, 0.0, 1.99)
    assert late.truth.pose == pytest.approx(punctual.truth.pose, abs=1e-12)
    for wheels in (late, punctual):
        wheels.travel(0.0, 0.0, 5.0)
    assert late.truth.pose == pytest.approx(punctual.truth.pose, abs=1e-12)
    assert late.truth.pose.x > 0.3
