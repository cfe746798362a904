"""The figures of true and assumed floors, on data with known results."""
import math

import numpy
import pytest

import floors

GOOD = dict(heading=0.5, port_heading=0.5, position=0.005, port_position=0.01, best_position=0.002,
            nees=3.0)


def test_errors_are_summed_up_over_the_ticks():
    follower = floors.Follower()
    follower.compare((0.0, 0.0, math.pi - 0.1), (3.0, 4.0, -math.pi + 0.1))     # 0.2 rad, 5 m
    follower.compare((1.0, 0.0, 0.1), (0.0, 0.0, 0.0))
    values = floors.figures([(follower.errors(numpy.diag([4.0, 1.0, 0.01])), follower.errors(), follower.errors())])
    assert values['heading'] == pytest.approx(math.degrees(math.sqrt((0.04 + 0.01) / 2)))
    assert values['position'] == values['port_position'] == pytest.approx(math.sqrt((25 + 1) / 2))
    assert values['nees'] == pytest.approx(1 / 4 + 0.01 / 0.01)


def test_long_runs_count_more_for_the_errors_and_not_for_the_consistency():
    short, long, port = floors.Errors(10, 90.0, 0.0, 2.0), floors.Errors(30, 30.0, 0.0, 4.0), numpy.ones(4)
    values = floors.figures([(short, port, port), (long, port, port)])
    assert values['heading'] == pytest.approx(math.sqrt(3.0)) and values['nees'] == pytest.approx(3.0)


def test_consistency_uses_the_correlations():
    covariance = numpy.array([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 1.0]])
    assert floors.consistency((1.0, 1.0, 2 * math.pi), (0.0, 0.0, 0.0), covariance) == pytest.approx(2 / 3)
    assert floors.consistency((1.0, -1.0, 0.0), (0.0, 0.0, 0.0), covariance) == pytest.approx(2.0)


def test_a_covariance_that_is_none_is_not_consistent():
    assert floors.consistency((1.0, 0.0, 0.0), (0.0, 0.0, 0.0), numpy.diag([1.0, 1.0, -1e-9])) == math.inf


def test_with_a_known_heading_only_the_distance_can_be_wrong():
    best = floors.KnownHeading(0.1)
    for step in range(101):     # the robot drives 1 m north; its odometry reports 1.2 m northeast
        along = step / 100 * 1.2 * math.sqrt(0.5)
        best.update((along, along, math.pi / 4), (2.0, step / 100, math.pi / 2))
    assert best.pose == pytest.approx((2.0, 1.2 * 0.9, math.pi / 2))


@pytest.mark.parametrize('true, assumed, bad, missed', [
    ('carpet', 'carpet', {}, []),
    ('carpet', 'carpet', {'position': 0.0081}, ['position']),
    ('carpet', 'unknown', {'position': 0.0129}, []),
    ('carpet', 'unknown', {'position': 0.0131}, ['position']),
    ('carpet', 'tiles', {'position': 0.0429}, []),
    ('carpet', 'tiles', {'position': 0.0431}, ['position']),
    ('carpet', 'tiles', {'heading': 0.64, 'nees': 9.9}, []),
    ('carpet', 'tiles', {'heading': 0.66, 'nees': 10.1}, ['heading', 'nees']),
    ('carpet', 'tiles', {'nees': 0.1}, []),
    ('carpet', 'unknown', {'nees': 0.6}, ['nees']),
    ('carpet', 'carpet', {'nees': math.inf}, ['nees']),
    ('ideal', 'ideal', {'nees': 0.0, 'heading': 0.09, 'position': 0.0019}, []),
    ('ideal', 'ideal', {'heading': 0.11, 'position': 0.0021}, ['heading', 'position']),
    ('ideal', 'unknown', {'nees': 0.0}, [])])
def test_limits(true, assumed, bad, missed):
    values = dict(GOOD, heading=0.05, position=0.001) if true == 'ideal' else GOOD
    values = {**values, **bad}
    assert floors.misses(values, floors.limits(true, assumed, values, 0.03)) == missed


def test_the_table_shows_what_misses():
    rows = [dict(GOOD, true='carpet', assumed='tiles', method=method, misses=['nees'] * (method == 'ekf'))
            for method in ('timed', 'ekf')]
    assert list(floors.markdown(rows))[2:] == [
        '| carpet | tiles | 0.50, 0.50 | 0.50, 0.50 | 0.50, 0.50 | 1.00, 1.00 | 0.20, 0.20 | 3.0, **3.0** |']
