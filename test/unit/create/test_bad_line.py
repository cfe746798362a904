"""On a bad line, a reply of a Create may be corrupted undetected, so doubtful readings are corrected."""
from math import sqrt

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver.fractions import KEPT, Fractions
from rbx1_nav.create.driver.travel import STILL, CounterTravel, Expected

PERIOD, WIDTH = 0.04, 0.26      # s, m
STEP = Expected(0.01, 0.01)     # m, in a period at 0.25 m/s


def read(counter, distance, expected=STEP, elapsed=PERIOD, angle=0):
    return counter.update({'distance': distance, 'angle': angle}, elapsed, expected)


def counter_after(losses=1, good=0):
    """Return a counter at a steady 0.25 m/s after lost replies and good readings."""
    counter = CounterTravel(protocol.CREATE, Fractions(KEPT))
    read(counter, 0)
    read(counter, 10)
    for _ in range(losses):
        counter.miss(True, 0.0, STILL)
    for _ in range(good):
        read(counter, 10)
    return counter


def test_a_good_line_is_not_doubted():
    assert read(counter_after(losses=0), 17) == pytest.approx((0.017, 0, 0, 0))


def test_a_reading_that_all_expectations_contradict_is_replaced():
    # 5 mm and 10 % of the expected travel are 6 mm
    assert read(counter_after(good=1), 15).distance == 0.015
    travel = read(counter_after(good=1), 17)
    assert travel.distance == pytest.approx(0.01)
    # 5 mm for each wheel
    assert travel.distance_variance == pytest.approx(2 * 0.005 ** 2 / 4)
    assert travel.angle_variance == pytest.approx(2 * 0.005 ** 2 / WIDTH ** 2)


def test_if_the_expectations_differ_half_of_the_difference_is_corrected():
    # the wheels had 0.25 m/s, and are commanded to stop
    travel = read(counter_after(good=1), 18, STILL)
    assert travel.distance == pytest.approx(0.014)      # halfway to the closest expectation, 10 mm
    assert travel.distance_variance == pytest.approx(2 * (0.002 + 0.005) ** 2 / 4)
    assert travel.angle_variance == pytest.approx(2 * (0.002 + 0.005) ** 2 / WIDTH ** 2)
    # a reading that is near one of the expectations is as good as any
    assert read(counter_after(good=1), 3, STILL).distance == 0.003


def test_a_turn_is_replaced_too():
    travel = read(counter_after(good=1), 10, angle=3)       # 6.8 mm at each wheel
    assert (travel.distance, travel.angle) == pytest.approx((0.01, 0))


@pytest.mark.parametrize('good, doubted', [(13, True), (14, False)])
def test_after_one_loss_14_readings_are_doubted(good, doubted):
    """The share of lost replies is 1/50 and decreases by 1/50 with each reading: 0.98^14 / 50 = 0.0151."""
    travel = read(counter_after(good=good), 17)
    assert (travel.distance == pytest.approx(0.01)) == doubted


def test_more_losses_are_doubted_longer():
    # 1 - 0.98^5 = 0.0961 is above 0.015 for 91 readings: 0.0961 * 0.98^91 = 0.0153
    assert read(counter_after(5, 90), 17).distance == pytest.approx(0.01)
    assert read(counter_after(5, 92), 17).distance == 0.017


def test_an_error_that_is_not_detected_has_a_variance():
    travel = read(counter_after(good=1), 10)
    share = 0.02 * 0.98 ** 2
    # two of 30 bytes, 5 mm
    variance = 2 * share / 30 * 0.005 ** 2
    assert travel.distance_variance == pytest.approx(variance / 4)
    assert travel.angle_variance == pytest.approx(variance / WIDTH ** 2)


@pytest.mark.parametrize('elapsed, number, distance', [(0.29, 86, 0.0725), (0.31, 92, 0.092)])
def test_after_0_3_s_a_reading_cannot_be_compared(elapsed, number, distance):
    counter = counter_after(good=1)
    expected = Expected(0.25 * elapsed, 0.25 * elapsed)
    # more than 5 mm and 10 % away from 72.5 mm and 77.5 mm
    assert read(counter, number, expected, elapsed).distance == pytest.approx(distance)


def test_the_speed_of_a_reading_with_a_loss_is_not_the_speed_of_the_wheels():
    counter = counter_after(good=1)
    counter.miss(True, PERIOD, STEP)
    read(counter, 5, STEP, 2 * PERIOD)          # of two periods, only one was read
    # near 2.5 mm, the travel at half of 5 mm per period
    assert read(counter, 3).distance == pytest.approx(0.01)


def test_a_reading_may_include_the_travel_before_a_lost_query():
    counter = counter_after(good=1)
    counter.miss(False, PERIOD, STEP)
    assert read(counter, 20, STEP, 2 * PERIOD).distance == pytest.approx(0.02)
    counter.miss(False, PERIOD, STEP)
    travel = read(counter, 10, STEP, 2 * PERIOD)
    assert travel.distance == pytest.approx(0.02)
    assert sqrt(travel.distance_variance) == pytest.approx(0.001 / sqrt(2), rel=0.1)    # 10 % of each wheel's travel
