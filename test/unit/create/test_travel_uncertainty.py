"""The uncertainty of travel that was not read, rounded, capped or corrupted, by independent arithmetic."""
from math import pi, radians, sqrt

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.driver.fractions import KEPT, LOST, Fractions
from rbx1_nav.create.driver.travel import (
    NOWHERE, STILL, CounterTravel, EncoderTravel, Expected, Implausible, bridged, is_possible, travel_of, unknown)

COUNT = pi * 0.072 / 508.8      # m, travel of a Create 2's wheel per count


def encoders(left, right):
    return {'left_encoder': left % 65536, 'right_encoder': right % 65536}


def counters(distance, angle=0):
    return {'distance': distance, 'angle': angle}


def encoder_travel(left=0, right=0):
    counter = EncoderTravel(protocol.CREATE_2)
    assert counter.update(encoders(left, right), 0.0, STILL) == NOWHERE
    return counter


def counter_travel(kind=KEPT):
    counter = CounterTravel(protocol.CREATE, Fractions(kind))
    assert counter.update(counters(500, 90), 0.0, STILL) == NOWHERE     # counted before
    return counter


def test_rounding_to_whole_numbers_is_uniformly_distributed():
    """The variance of a uniform distribution of width 1 is 1/12."""
    counter = travel_of(protocol.CREATE, Fractions())
    assert counter.rounding == pytest.approx((0.001 / sqrt(12), radians(1) / sqrt(12)))
    position, heading = travel_of(protocol.CREATE_2, Fractions()).rounding
    # the mean, and the difference of two wheels
    assert position ** 2 == pytest.approx(COUNT ** 2 / 12 / 2)
    assert heading ** 2 == pytest.approx(COUNT ** 2 / 12 * 2 / 0.235 ** 2)


def test_an_unknown_part_of_a_travel_is_uniformly_distributed_from_0():
    assert unknown(Expected(0.1, 0.3), 0.25) == pytest.approx((0, 0, 0.2 ** 2 / 3, 0.8 ** 2 / 3))
    assert unknown(STILL, 0.25) == NOWHERE


def test_a_bridged_travel_is_as_uncertain_as_both_expectations_differ():
    travel = bridged(Expected(0.1, 0.3), Expected(0.1, 0.3), 0.25)
    # 10 % of the travel of each wheel
    assert travel == pytest.approx((0.2, 0.8, (0.01 ** 2 + 0.03 ** 2) / 4, (0.01 ** 2 + 0.03 ** 2) / 0.25 ** 2))
    travel = bridged(Expected(0.1, -0.1), Expected(0.3, 0.1), 0.25)
    assert travel == pytest.approx((0, -0.8, 2 * 0.21 ** 2 / 4, 2 * 0.21 ** 2 / 0.25 ** 2))


@pytest.mark.parametrize('travel, possible', [(0.664, True), (0.666, False), (-0.664, True), (-0.666, False)])
def test_no_wheel_is_faster_than_130_percent_of_its_limit(travel, possible):
    """1.3 * 0.5 m/s, and 15 mm that the previous reading may have missed."""
    for wheels in (travel, 0.0), (0.0, travel), (travel, -travel):
        assert is_possible(*wheels, 1.0) == possible
    assert is_possible(0.0149, 0.0, 0.0) and not is_possible(0.0151, 0.0, 0.0)


# encoders

@pytest.mark.parametrize('left, right', [(20.0, 20.0), (20.0, 0.0)])
def test_commands_that_decide_how_often_the_encoders_wrapped_may_not_have_been_followed(left, right):
    counts = [round(each / COUNT) for each in (left, right)]
    travel = encoder_travel().update(encoders(*counts), 60.0, Expected(left, right))
    variance = (65536 * COUNT) ** 2 * sum(each > 0 for each in (left, right))
    assert travel == pytest.approx(((left + right) / 2, (right - left) / 0.235, variance / 4, variance / 0.235 ** 2),
                                   abs=0.01)    # a count is 0.4 mm, or 0.002 rad


def test_up_to_half_a_wrap_the_encoders_need_no_command():
    half = 32768 * COUNT
    assert encoder_travel().update(encoders(0, 0), 60.0, Expected(0.99 * half, -0.99 * half)).distance_variance == 0


@pytest.mark.parametrize('before, after, reset', [
    ((500, 500), (0, 0), True), ((500, 500), (36, -36), False), ((20, 20), (0, 0), False), ((500, 0), (30, 30), True),
    ((500, 500), (0, 40), False), ((500, 500), (-30, 30), True)])
def test_encoders_near_0_after_others_are_a_reset(before, after, reset):
    """A reading may miss 15 mm: 33 counts."""
    assert encoder_travel(*before).is_reset(encoders(*after)) == reset


def test_encoders_that_were_never_read_are_not_reset():
    assert not EncoderTravel(protocol.CREATE_2).is_reset(encoders(0, 0))


def feed(counter, *readings):
    """Feed readings, 15 ms apart. Returns the distance of each, or None for an implausible reading."""
    results = []
    for reading in readings:
        try:
            results.append(counter.update(encoders(*reading), 0.015, STILL).distance)
        except Implausible:
            results.append(None)
    return results


def test_three_implausible_readings_must_be_in_a_row():
    jump = 20000
    assert feed(encoder_travel(), (jump, 0), (jump, 0), (jump, 0), (jump, 0)) == [None, None, None, 0]
    # a good reading in between: the count starts again
    assert feed(encoder_travel(), (jump, 0), (jump, 0), (0, 0), (jump, 0), (jump, 0), (0, 0)) == [
        None, None, 0, None, None, 0]


def test_an_implausible_reading_is_named():
    with pytest.raises(Implausible, match='^encoders: 5000 and 7 after 1000 and 2$'):
        encoder_travel(1000, 2).update(encoders(5000, 7), 0.015, STILL)
    with pytest.raises(Implausible, match='^distance: 100 mm, angle: -3 degrees in 0.033 s$'):
        counter_travel().update(counters(100, -3), 0.0333, STILL)


# counters

def test_what_was_lost_before_the_first_reading_is_no_travel():
    counter = CounterTravel(protocol.CREATE, Fractions(KEPT))
    counter.miss(True, 0.1, Expected(0.02, 0.02))
    counter.miss(False, 0.1, Expected(0.02, 0.02))
    assert counter.update(counters(500, 90), 0.0, STILL) == NOWHERE
    assert counter.update(counters(20), 0.1, Expected(0.02, 0.02)) == pytest.approx((0.02, 0, 0, 0), abs=1e-5)


@pytest.mark.parametrize('reading, capped', [
    (counters(32767), True), (counters(-32767), True), (counters(0, 32767), True), (counters(0, -32767), True),
    (counters(32766, 32766), False)])
def test_a_robot_that_has_stopped_counting_may_be_anywhere(reading, capped):
    travel = counter_travel().update(reading, 1e4, STILL)
    # 10 m or rad, 1 sigma
    assert travel.distance_variance == (100 if capped else 0) and (travel.angle_variance >= 100) == capped


@pytest.mark.parametrize('reading, reset', [
    (counters(0, 0), True), (counters(1, 0), False), (counters(0, 1), False), ({'distance': 0}, True)])
def test_a_create_that_counts_nothing_may_have_been_reset(reading, reset):
    assert CounterTravel.is_reset(reading) == reset


def test_a_lost_reply_is_as_uncertain_as_the_speed_and_the_command_differ():
    counter = counter_travel()
    counter.update(counters(20), 0.1, Expected(0.02, 0.02))     # 0.2 m/s
    counter.miss(True, 0.2, Expected(0.06, 0.06))       # 0.3 m/s
    travel = counter.update(counters(20), 0.3, Expected(0.02, 0.02))
    deviation = 0.06 - 0.04 + 0.006
    assert travel.distance == pytest.approx(0.08)
    # the second part is for errors that are not detected on a bad line: below 1 mm^2
    assert travel.distance_variance == pytest.approx(2 * deviation ** 2 / 4, abs=1e-6)
    assert travel.angle_variance == pytest.approx(2 * deviation ** 2 / 0.26 ** 2, abs=1e-5)


def test_a_query_of_which_it_is_unclear_whether_it_arrived_counts_half():
    counter = counter_travel()
    counter.miss(False, 0.1, Expected(0.002, 0.002))
    travel = counter.update(counters(402), 2.0, Expected(0.4, 0.4))
    # 1 mm, plus or minus 1 mm; the rest is for errors that are not detected on a bad line
    assert travel.distance == pytest.approx(0.403)
    assert 0.001 < travel.distance_variance ** 0.5 < 0.01


@pytest.mark.parametrize('read, distance', [(20, 0.06), (60, 0.06)])
def test_whether_a_query_arrived_follows_from_the_next_reading(read, distance):
    counter = counter_travel()
    counter.miss(False, 0.2, Expected(0.04, 0.04))
    travel = counter.update(counters(read), 0.3, Expected(0.02, 0.02))
    assert travel.distance == pytest.approx(distance)
    # the next reading is not affected, apart from errors that are not detected on a bad line
    travel = counter.update(counters(20), 0.1, Expected(0.02, 0.02))
    assert travel.distance == pytest.approx(0.02) and travel.distance_variance < 1e-7


# a robot that drops fractions of a degree

def test_between_two_readings_of_the_angle_the_turn_follows_the_commands():
    counter = counter_travel(LOST)
    wheel = radians(5) * 0.13
    angles = []
    for reads in (False, False, True, False):
        assert counter.wants_angle(Expected(-wheel, wheel), 0.1) == reads
        reading = counters(0, 14) if reads else {'distance': 0}
        angles.append(counter.update(reading, 0.1, Expected(-wheel, wheel)).angle)
        # what was not read is as uncertain as a travel that is expected
        unread = 0 if reads else len(angles) % 4 * 5 or 5
        assert counter.unread_variance == pytest.approx((0.1 * radians(unread)) ** 2, abs=1e-9)
    # 14 degrees, and half a degree that the robot dropped
    assert angles == pytest.approx([radians(5), radians(5), radians(4.5), radians(5)])


def test_at_rest_the_angle_is_read_every_0_9_s():
    counter = counter_travel(LOST)
    read = []
    for _ in range(40):
        read.append(counter.wants_angle(STILL, 0.1))
        counter.update(counters(0) if read[-1] else {'distance': 0}, 0.1, STILL)
    # every 0.9 to 1.3 s, after the reading 0.1 s before
    assert 3 <= sum(read) <= 4 and not any(read[:8])


@pytest.mark.parametrize('begun, reading, total', [
    (True, {'distance': 0, 'angle': 14}, 34.5), (False, {'distance': 0, 'angle': 34}, 34.5),
    (False, {'distance': 0, 'angle': 14}, 34.5)])
def test_an_angle_that_was_lost_is_replaced_by_the_commands(begun, reading, total):
    counter = counter_travel(LOST)
    wheel = radians(20) * 0.13
    assert counter.wants_angle(Expected(-wheel, wheel), 0.2)
    counter.miss(begun, 0.2, Expected(-wheel, wheel))
    wheel = radians(15) * 0.13
    assert counter.wants_angle(Expected(-wheel, wheel), 0.35)
    travel = counter.update(reading, 0.35, Expected(-wheel, wheel))
    assert travel.angle == pytest.approx(radians(total)) and travel.angle_variance > radians(2) ** 2
