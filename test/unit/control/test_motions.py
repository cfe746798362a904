"""The exercise as ticks."""
from math import inf, pi

import pytest

from rbx1_nav.control.motions import out_and_back, ticks


def test_the_tutorials_numbers():
    motions = out_and_back(0.2, 1.0, 1.0, pi, 50)
    assert [m.ticks for m in motions] == [250, 157, 250, 157]
    assert [(m.linear, m.angular) for m in motions] == [(0.2, 0.0), (0.0, 1.0)] * 2


def test_the_turn_is_right_for_every_speed():
    assert out_and_back(0.2, 1.0, 0.5, pi, 50)[1].ticks == 314


@pytest.mark.parametrize('goal, speed, rate, expected', [(0.3, 0.1, 50, 150), (1.0, 0.3, 50, 166), (0.1, 0.5, 5, 1)])
def test_cut_to_a_whole_number_without_losing_one_to_rounding(goal, speed, rate, expected):
    assert ticks(goal, speed, rate) == expected


@pytest.mark.parametrize('goal, speed', [(1e-9, 1.0), (1e300, 1e-300), (1.0, 1e-9), (inf, 1.0)])
def test_no_motion_without_end_or_without_a_tick(goal, speed):
    with pytest.raises(ValueError, match='expected between 1 tick and a day'):
        ticks(goal, speed, 50)
