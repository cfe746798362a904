"""The arithmetic of the benchmark, on data with known results."""
import math

import pytest

import figures

EXACT = 1e-12  # far above the rounding of a few operations on numbers near 1


def standing(times, v=0.0, x=0.0):
    """Odometry records at these times, all with identical speed and position."""
    return [(t, t, x, 0.0, 0.0, v, 0.0) for t in times]


def test_a_half_circle_ends_a_diameter_to_the_left():
    pose = figures.integrate([(0, 1.0, 1.0)], math.pi, 0)
    assert pose == pytest.approx((0, 2, math.pi), abs=EXACT)


def test_a_command_ends_with_the_timeout():
    assert figures.integrate([(0, 0.2, 0), (5, 0, 0)], 9, 1.0)[0] == pytest.approx(0.2, abs=EXACT)
    assert figures.integrate([(0, 0.2, 0), (5, 0, 0)], 9, 0)[0] == pytest.approx(1.0, abs=EXACT)


def test_the_angle_of_a_deviation_is_at_most_pi():
    assert figures.deviation((3, 4, math.pi - 0.1), (0, 0, -math.pi + 0.1)) == pytest.approx((5, 0.2), abs=EXACT)


def test_a_relative_pose_is_in_the_frame_of_the_start():
    assert figures.relative((1, 3, math.pi), (1, 1, math.pi / 2)) == pytest.approx((2, 0, math.pi / 2), abs=EXACT)


def test_periods_follow_moving_commands_and_are_no_pauses():
    commands = [(0, 1, 0), (0.02, 1, 0), (0.05, 0, 0), (0.06, 0, 0), (1.06, 0, 1), (2.06, 0, 1)]
    assert figures.command_periods(commands) == pytest.approx([0.02, 0.03], abs=EXACT)


def test_the_latency_ends_with_the_first_message_that_shows_the_command():
    odometry = standing([0.0, 0.1]) + standing([0.2, 0.3], v=0.1) + standing([0.4, 0.5])
    assert figures.shown_after([(0.05, 0.1), (0.35, 0.0)], odometry) == pytest.approx([0.15, 0.05], abs=EXACT)


def test_a_command_on_the_line_is_shown_by_its_speed():
    texts = ['0.1 9100000000', '0.2 8c00', '0.32 9100c80000', '0.4 9100000000']
    odometry = figures.line_speeds(texts, 0.0)
    assert [record[5] for record in odometry] == [0, 0.1, 0]
    assert figures.shown_after([(0.3, 0.1), (0.35, 0.0)], odometry) == pytest.approx([0.02, 0.05], abs=EXACT)


def test_cpu_time_is_counted_within_the_interval():
    samples = [(0, 5.0), (1, 6.0), (2, 6.1), (3, 6.2), (4, 9.0)]
    assert figures.usage(samples, 0.5, 3.5) == pytest.approx(0.1, abs=EXACT)


def test_a_run_is_measured_from_the_pose_at_its_start():
    commands = [(1.0, 0.2, 0), (1.02, 0.2, 0), (1.04, 0, 0)]
    odometry = standing([0.9, 0.99], x=7.0) + standing([1.01, 1.03], x=7.004) + standing([1.05, 2.0], x=7.009)
    row, periods = figures.run_figures(commands, odometry, [], 1.0, None)
    assert (row['forward'], row['turning'], row['zero'], row['total']) == (2, 0, 1, 3)
    assert row['distance_m'] == pytest.approx(0.009, abs=EXACT)
    assert row['deviation_m'] == pytest.approx(0.001, abs=EXACT)
    assert periods == pytest.approx([0.02, 0.02], abs=EXACT)
