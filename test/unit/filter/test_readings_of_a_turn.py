"""Gyro readings are integrated into a turn, and long intervals and lost readings make the turn uncertain."""
from math import inf

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.gyro_readings import MIN_DENSITY, NOISE_FACTOR, Readings
from rbx1_nav.filter.input_checks import Imu
from rbx1_nav.filter.priors import Bounds

START = 100 * SECOND
NOISE = 1e-4        # rad^2/s^2, of each reading


def ns(time):
    """Return the stamp of a time (s)."""
    return START + round(time * SECOND)


class Gyro:
    """Readings in which a test stores what a gyro reports, as the combined odometry does."""

    def __init__(self, limits=Bounds(), rate=0.0):
        self.readings = Readings(limits)
        self.readings.last = Imu(START, rate, NOISE)

    def report(self, *reports, is_mean=False):
        """Store readings: (time in s, rate in rad/s)."""
        for time, rate in reports:
            imu = Imu(ns(time), rate, NOISE, is_mean)
            self.readings.add(imu)
            self.readings.last = imu
        return self

    def turn(self, start, end, max_rate=inf):
        """Return the angle and the variance of the turn between two times (s)."""
        return self.readings.turn(ns(start), ns(end), max_rate)


def steady(interval, count=5, **options):
    """Return a Gyro that has reported 0 rad/s at a usual interval (s), and the time of its last reading."""
    gyro = Gyro(**options).report(*((interval * (number + 1), 0.0) for number in range(count)))
    gyro.readings.waiting.clear()
    return gyro, interval * count


def test_a_reading_is_the_rate_since_the_one_before():
    gyro = Gyro(rate=9.0).report((0.02, 0.5), (0.04, -1.0), (0.06, 2.0))
    # the noise of the readings is independent: the variances of the three turns add up
    assert gyro.turn(0.0, 0.06) == pytest.approx((0.02 * (0.5 - 1.0 + 2.0), 3 * NOISE * 0.02 ** 2))
    assert not gyro.readings.waiting


def test_a_reading_that_continues_after_the_step_counts_in_both_steps():
    gyro = Gyro().report((0.02, 0.5), (0.04, 1.0))
    assert gyro.turn(0.0, 0.03) == pytest.approx((0.01 + 0.01, NOISE * (0.02 ** 2 + 0.01 * 0.02)))
    assert gyro.turn(0.03, 0.04) == pytest.approx((0.01, NOISE * 0.01 * 0.02))
    assert not gyro.readings.waiting


def test_readings_from_before_the_step_do_not_count():
    gyro = Gyro().report((0.02, 9.0), (0.04, 9.0), (0.06, 1.0))
    # nor the fact that they are beyond the measurement range
    assert gyro.turn(0.04, 0.06, max_rate=5.0) == pytest.approx((0.02, NOISE * 0.02 ** 2))


@pytest.mark.parametrize('start, end', [(-0.01, 0.04), (0.0, 0.05), (0.05, 0.06), (0.02, 0.02)])
def test_readings_that_do_not_cover_the_whole_time_measure_no_turn(start, end):
    assert Gyro().report((0.02, 0.5), (0.04, 0.5)).readings.turn(ns(start), ns(end), inf) is None


@pytest.mark.parametrize('rate, measured', [(1.99, True), (-1.99, True), (2.0, False), (-2.0, False)])
def test_a_rate_at_the_limit_of_the_measurement_range_is_not_measured(rate, measured):
    gyro = Gyro().report((0.02, rate), (0.04, 0.0))
    assert (gyro.turn(0.0, 0.04, max_rate=2.0) is not None) == measured


@pytest.mark.parametrize('noise', [0.0, 1e-4, 2e-3])
def test_a_noise_that_is_greater_than_the_gyro_has_shown_is_limited(noise):
    rates = [noise * (-1) ** number for number in range(60)]
    for count, limited in (10, False), (60, True):
        gyro, start = moving([0.5, 0.4], rates[:count])
        # differences of 2 * noise between readings have half of their squares as variance; a density is per second
        density = NOISE_FACTOR * max(MIN_DENSITY, 2 * noise ** 2 * 0.02) if limited else 1.0
        assert gyro.turn(start, start + 0.04) == pytest.approx(
            (0.018, 2 * min(NOISE, density / 0.02) * 0.02 ** 2), rel=0.02)      # the first difference is half


@pytest.mark.parametrize('interval', [0.0501, 0.1, 0.4])
def test_after_a_long_interval_the_rate_was_anywhere_between_two_readings(interval):
    # usual for this gyro, so that no reading was lost; a uniform distribution has a variance of range^2 / 12
    assert Gyro(rate=0.3).report((interval, 0.9)).turn(0.0, interval) == pytest.approx(
        (0.6 * interval, (NOISE + 0.6 ** 2 / 12) * interval ** 2))


def test_a_mean_is_the_turn_of_a_long_interval():
    gyro = Gyro(rate=0.3).report((0.4, 0.9), is_mean=True)
    assert gyro.turn(0.0, 0.4) == pytest.approx((0.36, NOISE * 0.4 ** 2))


@pytest.mark.parametrize('limits, gap, error', [
    # the rate changes by at most 10 rad/s^2, so the turn is wrong by at most 10 * gap^2 / 4
    (Bounds(), 0.4, 10 * 0.4 ** 2 / 4), (Bounds(), 1.0, 2.5), (Bounds(max_angular_acceleration=2.0), 0.4, 0.08),
    # and by at most the greatest turn rate
    (Bounds(), 3.0, 6.0 * 3.0), (Bounds(max_turn_rate=0.5), 0.4, 0.5 * 0.4)])
def test_lost_readings_make_a_turn_uncertain(limits, gap, error):
    gyro, start = steady(0.02, limits=limits)
    gyro.report((start + gap, 0.0))
    # a uniform distribution between -error and error has a variance of error^2 / 3
    assert gyro.turn(start, start + gap) == pytest.approx((0.0, NOISE * gap ** 2 + error ** 2 / 3))


@pytest.mark.parametrize('before, after', [(0.1, 0.0), (0.0, 0.3), (0.1, 0.1)])
def test_a_gap_that_is_not_within_one_step_is_uncertain_without_the_wheels(before, after):
    gap, error = 0.4, 10 * 0.4 ** 2 / 4
    gyro, start = steady(0.02)
    gyro.report((start + gap, 0.0))
    part = gap - before - after
    if before:
        gyro.readings.turn(ns(start), ns(start + before), inf)
    # the error of the rate is the same in all parts of the gap
    assert gyro.turn(start + before, start + gap - after) == pytest.approx(
        (0.0, (NOISE + error ** 2 / gap ** 2 / 3) * part * gap))


def moving(rates, at_rest):
    """Return a Gyro that has reported these rates at rest, and then is in motion."""
    gyro = Gyro()
    for number, rate in enumerate(at_rest):
        imu = Imu(ns(0.02 * (number + 1)), rate, NOISE)
        gyro.readings.add(imu, at_rest=True)
        gyro.readings.last = imu
    start = 0.02 * len(at_rest)
    gyro.readings.waiting.clear()
    return gyro.report(*((start + 0.02 * (number + 1), rate) for number, rate in enumerate(rates))), start


NOISY = [1e-3 * (1 + number % 7) for number in range(50)]       # no two readings are equal


@pytest.mark.parametrize('equal, measured', [(2, True), (3, True), (4, False)])
def test_readings_that_are_equal_while_the_robot_moves_are_not_measured(equal, measured):
    gyro, start = moving([2.0] * equal, NOISY)
    assert (gyro.turn(start, start + 0.02 * equal) is not None) == measured
    gyro.report((start + 0.02 * (equal + 1), 1.9))      # and measured again
    assert gyro.turn(start + 0.02 * equal, start + 0.02 * (equal + 1)) == pytest.approx((0.038, 2.36e-9), rel=0.01)


PAIRS = [rate for rate in NOISY for _ in range(2)]      # of a gyro with coarse steps


@pytest.mark.parametrize('at_rest', [[0.0] * 50, NOISY[:19], PAIRS[:36], []])
def test_readings_of_a_gyro_without_visible_noise_may_be_equal(at_rest):
    gyro, start = moving([2.0] * 30, at_rest)
    assert gyro.turn(start, start + 0.6) is not None


@pytest.mark.parametrize('at_rest', [PAIRS[:44], PAIRS])
def test_readings_may_be_equal_as_often_as_at_rest(at_rest):
    """Pairs of equal readings at rest, and twice as many, plus two, in motion."""
    gyro, start = moving([2.0] * 6, at_rest)
    assert gyro.turn(start, start + 0.1) is not None and gyro.turn(start + 0.1, start + 0.12) is None


def test_another_interval_becomes_the_usual_one():
    gyro, start = steady(0.02)
    gyro.report(*((start + 0.1 * (number + 1), 0.0) for number in range(100)))
    lost = (10 * 0.1 ** 2 / 4) ** 2 / 3
    for number, more in (0, lost), (4, lost), (80, 0.0):    # first, readings seem to be lost
        begin = start + 0.1 * number
        assert gyro.turn(begin, begin + 0.1) == pytest.approx((0.0, NOISE * 0.1 ** 2 + more))
