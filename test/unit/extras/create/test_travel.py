"""The robot's counters are converted to travel, and implausible readings are rejected."""
from math import radians

from hypothesis import given, strategies
import numpy
import pytest

from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.angle_fractions import KEPT, Fractions
from rbx1_nav.extras.create.odometry import NOWHERE, STILL, CounterTravel, EncoderTravel, Expected

COUNT = 1 / protocol.CREATE_2.counts_per_metre      # m


def encoders(left, right):
    return {'left_encoder': left % 65536, 'right_encoder': right % 65536}


def counters(distance, angle):
    return {'distance': distance, 'angle': angle}


def encoder_travel(left, right):
    counter = EncoderTravel(protocol.CREATE_2)
    assert counter.update(encoders(left, right), 0.0, STILL, 0.0) == NOWHERE
    return counter


def counter_travel():
    counter = CounterTravel(protocol.CREATE, Fractions(KEPT))
    assert counter.update(counters(500, 90), 0.0, STILL, 0.0) == NOWHERE     # counted before
    return counter


def test_the_rounding_of_counters():
    left, right = numpy.random.default_rng(0).random((2, 100_000)) - 0.5        # counts
    for counter, errors in ((encoder_travel(0, 0), ((left + right) / 2 * COUNT, (right - left) * COUNT / 0.235)),
                            (counter_travel(), (left / 1000, numpy.radians(right)))):
        assert counter.rounding == pytest.approx(numpy.std(errors, axis=1), rel=0.01)


@given(strategies.integers(0, 65535), strategies.integers(-2000, 2000), strategies.integers(-2000, 2000))
def test_encoders_wrap(start, left, right):
    travel = encoder_travel(start, start).update(encoders(start + left, start + right), 3.0, STILL, 0.0)
    assert travel.distance == pytest.approx((left + right) / 2 * COUNT)
    assert travel.angle == pytest.approx((right - left) * COUNT / 0.235)
    assert travel.distance_variance == travel.angle_variance == 0


def test_six_implausible_readings_in_a_row_are_a_new_beginning():
    counter = encoder_travel(1000, 1000)
    for count in range(6):
        assert counter.update(encoders(20000 + count, 0), 0.015, STILL, 0.0) is None
    assert counter.update(encoders(20005, 0), 0.015, STILL, 0.0) == NOWHERE
    assert counter.update(encoders(20015, 10), 0.015, STILL, 0.0).distance == pytest.approx(10 * COUNT)


@pytest.mark.parametrize('third', [(), (1357, 3348 + 16384)])
def test_a_corrupted_reading_that_looked_possible_is_taken_back_by_the_third_good_one_after_it(third):
    counter = encoder_travel(1000, 3000)
    # at 0.5 m/s, which is 1125 counts/s; 67 mm back are possible after lost replies
    total = [counter.update(encoders(*counts), elapsed, STILL, 0.0)
             for counts, elapsed in (((1020, 3010), 0.033), ((1020 - 150, 3235), 0.2))]
    for number, counts in enumerate(filter(None, ((1282, 3272), (1320, 3310), third)), 1):
        assert counter.update(encoders(*counts), number / 30, STILL, 0.0) is None
    total.append(counter.update(encoders(1391, 3385), 0.13, STILL, 0.0))
    assert sum(each.distance for each in total) == pytest.approx((391 + 385) / 2 * COUNT)
    assert sum(each.angle for each in total) == pytest.approx((385 - 391) * COUNT / 0.235)


@pytest.mark.parametrize('distance, angle', [(100, 0), (-100, 0), (0, 20), (0, -20)])
def test_an_implausible_reading_of_a_create(distance, angle):
    assert counter_travel().update(counters(distance, angle), 0.033, STILL, 0.0) is None


def test_a_lost_reply_is_bridged_by_the_command():
    counter = counter_travel()
    counter.miss(0.1, Expected(0.02, 0.02))
    travel = counter.update(counters(20, 0), 0.2, Expected(0.04, 0.04), 0.0)
    assert travel.distance == pytest.approx(0.04)
    sure = travel.distance_variance
    # wheels that do not follow the command
    counter.miss(0.1, Expected(-0.03, -0.03))
    assert counter.update(counters(20, 0), 0.2, Expected(-0.01, -0.01), 0.0).distance_variance > 100 * sure
    # the loss counts only once
    assert counter.update(counters(20, 0), 0.1, Expected(0.02, 0.02), 0.0) == pytest.approx((0.02, 0, 0, 0))


def test_a_query_that_was_lost_is_included_in_the_next_reading():
    counter = counter_travel()
    counter.miss(0.1, Expected(0.02, 0.02))
    assert counter.update(counters(40, 0), 0.2, Expected(0.04, 0.04), 0.0) == pytest.approx((0.04, 0, 0, 0))
    # the angle, too: a quarter turn in each half of the time
    wheel = radians(45) * 0.13
    counter.miss(1.0, Expected(-wheel, wheel))
    for angle in 90, 45:
        assert counter.update(counters(0, angle), 2.0, Expected(-2 * wheel, 2 * wheel), 0.0).angle == pytest.approx(
            radians(90))
        counter.miss(1.0, Expected(-wheel, wheel))


def test_the_first_reading_after_a_silence_is_not_doubted():
    counter = counter_travel()
    counter.update(counters(7, 0), 0.033, Expected(0.0066, 0.0066), 0.0)
    for number in range(1, 4):
        counter.miss(0.2 * number, Expected(0.04, 0.04))
    # the robot continued for 2 s with its last command, which the stop sent during the silence did not stop
    travel = counter.update(counters(400, 0), 2.0, Expected(0.04, 0.04), 0.0)
    assert travel.distance == pytest.approx(0.4)


@pytest.mark.parametrize('before, after, reset', [
    ((500, 500), (0, 0), True), ((20, 20), (0, 0), False), ((500, 0), (30, 30), True), ((500, 500), (0, 40), False)])
def test_encoders_near_0_after_others_are_a_reset(before, after, reset):
    """A reading may miss 15 mm: 33 counts."""
    assert encoder_travel(*before).is_reset(encoders(*after)) == reset


def test_a_create_that_has_stopped_counting_may_be_anywhere():
    """The robot counts up to 32,767 mm."""
    travel = counter_travel().update(counters(32767, 0), 1e4, STILL, 0.0)
    assert travel.distance_variance >= 100 and travel.angle_variance >= 100
    assert counter_travel().update(counters(32766, 0), 1e4, STILL, 0.0).distance_variance == 0
