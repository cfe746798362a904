"""The wheel travel from commands or odometry matches the simulated wheels."""
import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import Pose, arc
from rbx1_nav.extras.fitting.recording import Commands, Track
from rbx1_nav.extras.fitting.run import STEP, commanded_travel, grid, reported_travel
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.wheels import Wheels
from sample_surface import RUN, SURFACE

WIDTH = 0.26
commands = st.lists(st.tuples(st.floats(-0.5, 0.5), st.floats(-2, 2), st.floats(0.01, 1)), min_size=1, max_size=20)


def series(parts, start=0.0):
    """Return (Commands for a sequence of (linear, angular, duration) and a final 0, time of the final 0 in s)."""
    times = start + numpy.append(0.0, numpy.cumsum([duration for _, _, duration in parts]))
    linear, angular = ([*values, 0.0] for values in list(zip(*parts))[:2])
    return Commands(times, numpy.array(linear), numpy.array(angular)), times[-1]


@given(commands, st.sampled_from([0.0, 0.07, 0.6]), st.floats(0, 2))
def test_the_travel_of_commands_is_that_of_the_simulated_wheels(parts, delay, start):
    surface = SURFACE._replace(delay=delay)
    given_commands, end = series(parts, start)
    times = grid(start, end + 2.0)
    steps = commanded_travel(surface, WIDTH, given_commands, times)
    wheels = Wheels(WIDTH, Floor(surface, RUN), 0.02)
    pieces = [*parts, (0.0, 0.0, 3.0)]
    straight, turn = [], []
    for length in numpy.diff(times):
        before = wheels.left.total, wheels.right.total
        while length > 0:
            linear, angular, left = pieces[0]
            part = min(length, left)
            wheels.travel(linear, angular, part)
            length -= part
            pieces[0] = linear, angular, left - part
            if left - part <= 0:
                pieces.pop(0)
        left, right = wheels.left.total - before[0], wheels.right.total - before[1]
        straight.append((left + right) / 2)
        turn.append((right - left) / WIDTH)
    assert steps.straight == pytest.approx(numpy.array(straight), abs=1e-9)
    assert steps.turn == pytest.approx(numpy.array(turn), abs=1e-9)


@given(commands, st.floats(0.1, 1), st.floats(0, 1))
def test_commands_before_the_first_step_count(parts, delay, missing):
    surface = SURFACE._replace(delay=delay)
    given_commands, end = series(parts)
    times = grid(0.0, end + 3.0)
    whole = commanded_travel(surface, WIDTH, given_commands, times)
    skipped = int(missing * len(parts))
    part = commanded_travel(surface, WIDTH, given_commands, times[skipped:])
    assert part.straight == pytest.approx(whole.straight[skipped:], abs=1e-12)
    assert part.turn == pytest.approx(whole.turn[skipped:], abs=1e-12)


# less than a full turn per step, because the arc of a full turn has no chord
@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-3, 3)), min_size=1, max_size=30),
       st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-10, 10)))
def test_the_travel_of_odometry_inverts_its_arcs(arcs, start):
    poses = [Pose(*start)]
    for distance, angle in arcs:
        poses.append(arc(poses[-1], distance, angle))
    times = grid(0.0, STEP * (len(arcs) + 0.5))
    steps = reported_travel(Track(times, *numpy.transpose(poses)), times)
    assert numpy.stack([steps.straight, steps.turn], axis=1) == pytest.approx(numpy.array(arcs), abs=1e-9)
