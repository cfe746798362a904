"""The courses of the robot's own programs, as functions of time: speed, radius and duration."""
from math import pi, sqrt

import pytest

from rbx1_nav.create.emulator.programs import cover, figure_eight, search, spiral, spot

FORWARD, LEFT = (200, 32767), (200, 1)      # mm/s, radius of the Drive command


def test_a_spiral_widens_by_150_mm_per_turn_from_150_mm():
    assert spiral(0) == (200, 150)
    time, heading, step = 0.0, 0.0, 0.01
    while heading < 2 * pi:     # the heading changes by distance / radius
        heading += 200 * step / spiral(time)[1]
        time += step
    # the numerical integration is off by a step
    assert spiral(time)[1] - 150 == pytest.approx(150, abs=1)


def test_spot_cleaning_spirals_outward_for_24_s_and_inward_for_24_s():
    assert [spot(time)[1] for time in (0, 10, 24)] == [spiral(time)[1] for time in (0, 10, 24)]
    assert spot(30) == spot(18) and spot(47.9) == pytest.approx(spot(0.1)) and spot(48) is None
    assert spot(24)[1] == pytest.approx(sqrt(150 ** 2 + 150 * 200 * 24 / pi))


def test_cleaning_a_room():
    assert cover(23.9) == spiral(23.9)
    # straight legs of 4.5 s, with turns of 1.5 s
    for start in 24.0, 30.0, 3000.0:
        assert cover(start) == cover(start + 4.4) == FORWARD and cover(start + 4.5) == cover(start + 5.9) == LEFT


def test_the_search_for_the_dock():
    assert [search(time) for time in (0, 4.4, 4.5, 5.9, 6.0, 10.4, 10.5)] == [
        FORWARD, FORWARD, LEFT, LEFT, FORWARD, FORWARD, LEFT]
    # more than 90 degrees: 0.2 m/s at 0.13 m
    assert 1.5 * 0.2 / 0.13 > pi / 2


def test_a_figure_of_eight_of_two_circles():
    circle = 2 * pi * 300 / 200     # s
    assert figure_eight(0) == figure_eight(circle - 0.01) == figure_eight(2 * circle + 0.01) == (200, 300)
    assert figure_eight(circle + 0.01) == figure_eight(2 * circle - 0.01) == (200, -300)
