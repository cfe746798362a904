"""The benchmark's arithmetic, each figure on data whose answer is known."""
import math

import pytest

import figures

EXACT = 1e-12  # some ten roundings of numbers near 1


def standing(times, v=0.0, x=0.0):
    """Odometry records at these times, with that speed and place."""
    return [(t, t, x, 0.0, 0.0, v, 0.0) for t in times]


def test_half_circle_ends_a_diameter_to_the_left():
    pose = figures.integrate([(0, 1.0, 1.0)], math.pi, 0)
    assert pose == pytest.approx((0, 2, math.pi), abs=EXACT)


def test_nearly_straight_arc_meets_the_straight_one():
    assert figures.arc((0, 0, 0), 1, 1e-9, 1) == pytest.approx((1, 5e-10, 1e-9), abs=EXACT)


def test_command_ends_with_the_timeout():
    assert figures.integrate([(0, 0.2, 0), (5, 0, 0)], 9, 1.0)[0] == pytest.approx(0.2, abs=EXACT)
    assert figures.integrate([(0, 0.2, 0), (5, 0, 0)], 9, 0)[0] == pytest.approx(1.0, abs=EXACT)


def test_deviation_takes_the_short_way_round():
    assert figures.deviation((3, 4, math.pi - 0.1), (0, 0, -math.pi + 0.1)) == pytest.approx((5, 0.2), abs=EXACT)


def test_relative_pose_is_seen_from_the_start():
    assert figures.relative((1, 3, math.pi), (1, 1, math.pi / 2)) == pytest.approx((2, 0, math.pi / 2), abs=EXACT)


def test_percentiles_are_values_that_occurred():
    values = list(range(100, 0, -1))
    assert [figures.percentile(values, p) for p in (0, 1, 50, 99, 100)] == [1, 1, 50, 99, 100]


def test_periods_count_what_follows_a_moving_command_and_no_rest():
    commands = [(0, 1, 0), (0.02, 1, 0), (0.05, 0, 0), (0.06, 0, 0), (1.06, 0, 1), (2.06, 0, 1)]
    assert figures.command_periods(commands) == pytest.approx([0.02, 0.03], abs=EXACT)


def test_latency_ends_with_the_first_message_that_shows_the_command():
    odometry = standing([0.0, 0.1]) + standing([0.2, 0.3], v=0.1) + standing([0.4, 0.5])
    assert figures.shown_after([(0.05, 0.1), (0.35, 0.0)], odometry) == pytest.approx([0.15, 0.05], abs=EXACT)


def test_latency_of_a_base_without_speed_in_its_odometry():
    odometry = standing([0.0, 0.1]) + standing([0.2], x=0.01)
    assert figures.shown_after([(0.05, 0.1)], odometry) == pytest.approx([0.15], abs=EXACT)


def test_command_that_is_never_shown():
    assert figures.shown_after([(0.05, 0.1)], standing([0.0, 0.1, 0.2])) == [None]


def test_cpu_is_counted_within_the_interval():
    samples = [(0, 5.0), (1, 6.0), (2, 6.1), (3, 6.2), (4, 9.0)]
    assert figures.usage(samples, 0.5, 3.5) == pytest.approx(0.1, abs=EXACT)


def test_run_is_measured_from_where_the_robot_stood():
    commands = [(1.0, 0.2, 0), (1.02, 0.2, 0), (1.04, 0, 0)]
    odometry = standing([0.9, 0.99], x=7.0) + standing([1.01, 1.03], x=7.004) + standing([1.05, 2.0], x=7.009)
    row, periods, _ = figures.run_figures(commands, odometry, [], 1.0, None)
    assert (row['forward'], row['turning'], row['zero'], row['total']) == (2, 0, 1, 3)
    assert row['distance_m'] == pytest.approx(0.009, abs=EXACT)
    assert row['deviation_m'] == pytest.approx(0.001, abs=EXACT)
    assert periods == pytest.approx([0.02, 0.02], abs=EXACT)
