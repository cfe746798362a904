"""Robots that lose fractions of a degree, and a calibration that shows whether they do."""
from math import degrees, pi, trunc

import pytest

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.create.angle_fractions import AUTO, KEPT, LOST, MEASURED, TEST, Fractions

from driven_create import SURFACES, started

LOSES = pytest.mark.parametrize('loses', [False, True])


@LOSES
@pytest.mark.parametrize('rate', [0.3, -1.0])
@pytest.mark.parametrize('surface', ['ideal', 'low_ply_carpet'])
@pytest.mark.parametrize('is_known', [False, True])
def test_a_turn_is_reported_whatever_the_robot_does_with_fractions(is_known, surface, rate, loses):
    driven = started('create', surface=load_surface(surface, SURFACES), drops_fractions=loses,
                     angle_fractions=(LOST if loses else KEPT) if is_known else AUTO)
    before = driven.pose.yaw, driven.body.angle.total
    driven.drive(0, rate, 2 * pi / abs(rate))
    driven.command_zero()
    driven.run(2)
    # unless it is known, 1 % and 2 degrees: a quarter of a degree in 45 to 58, and the last readings
    assert degrees(driven.pose.yaw - before[0]) == pytest.approx(driven.body.angle.total - before[1], rel=0.01, abs=2)


def calibrated(surface, loses):
    """Return (a robot whose kind is tested, its Fractions)."""
    driven = started('create', surface=load_surface(surface, SURFACES), drops_fractions=loses, angle_fractions=TEST)
    return driven, driven.driver.counter.fractions


@LOSES
@pytest.mark.parametrize('surface, rate', [
    ('ideal', 0.2), ('ideal', -0.25), ('ideal', 0.3), ('low_ply_carpet', 0.25), ('low_ply_carpet', -0.3)])
def test_one_turn_shows_what_the_robot_does_with_fractions(surface, rate, loses):
    """On carpet, the robot turns by half of what was commanded."""
    driven, fractions = calibrated(surface, loses)
    driven.drive(0, rate, 2.5 / abs(rate))
    assert fractions.known == TEST
    driven.drive(0, rate, (2 * pi - 2.5) / abs(rate))
    assert fractions.known == MEASURED + (LOST if loses else KEPT)
    driven.run(2)
    # the turn ends by the odometry
    assert driven.pose.yaw == pytest.approx(driven.truth.yaw, rel=0.05) or surface != 'ideal'


@LOSES
@pytest.mark.parametrize('surface, rate', [('ideal', 0.6), ('low_ply_carpet', 0.15)])
def test_a_fast_turn_and_one_that_the_robot_hardly_follows_show_nothing(surface, rate, loses):
    driven, fractions = calibrated(surface, loses)
    driven.drive(0, rate, 9 / rate)
    assert fractions.known == TEST


def turn(kind, loses, degrees_per_second=41.3, seconds=30.0, period=1 / 32):
    """Return (turn reported, true turn, number of readings) of a steady turn; angles in degrees."""
    fractions, true, read, total, readings = Fractions(kind), 0.0, 0.0, 0.0, 0
    for number in range(round((seconds + 2) / period)):
        step = degrees_per_second * period if number * period < seconds else 0.0
        true += step
        angle = None
        if fractions.is_due(step, period):
            readings += 1
            angle = trunc(true - read)
            read = true if loses else read + angle
        total += fractions.update(step, period, angle).angle
    return total, true, readings


@pytest.mark.parametrize('kind, loses, fewest, most', [
    (KEPT, False, 1024, 1024), (LOST, True, 65, 95), (AUTO, False, 20, 32), (AUTO, True, 20, 32)])
def test_how_often_the_angle_is_read(kind, loses, fewest, most):
    total, true, readings = turn(kind, loses)
    assert total == pytest.approx(true, rel=0.006, abs=1)
    assert fewest <= readings <= most


@pytest.mark.parametrize('angle, turned', [(20, 16.5), (10, 16.5)])
def test_whether_a_query_arrived_follows_from_the_next_reading(angle, turned):
    """The query after 10 degrees may not have arrived. The robot then reports 20 degrees, otherwise 10."""
    fractions = Fractions(LOST)
    fractions.update(4.0, 0.4, None)
    fractions.lose(6.0)
    assert fractions.update(16.0, 1.6, angle).angle == pytest.approx(turned)


def test_a_correction_is_no_jump():
    """The heading is corrected by up to 120 degrees/s."""
    fractions = Fractions(LOST)
    fractions.update(20.0, 0.5, None)
    assert [(fractions.update(0.0, 0.05, angle).angle, fractions.unread) for angle in (9, None, None)] == [
        (-6, 4.5), (-4.5, 0), (0, 0)]
