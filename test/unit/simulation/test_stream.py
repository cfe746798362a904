"""The ticks of a stream show its rate, and whether its first command was late."""
from math import ceil

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.simulation.stream import LENGTH, Stream, is_late, possible_periods

STEP = 20_000_000       # ns
RATES = 50, 40, 30, 25, 20, 10, 5       # Hz
MOVE, STOP = (0.2, 0.0), (0.0, 0.0)


def rate(hertz, count, first=0):
    """Return the ticks of rospy.Rate, which rounds its period down to whole ns.

    first: periods from tick 0 to the first command.
    """
    period = int(1e9 / hertz)
    return [-(-(first + number) * period // STEP) for number in range(count)]


def sleeps(hertz, count):
    """Return the ticks of a loop that sleeps for a period."""
    return [number * ceil(round(1e9 / hertz) / STEP) for number in range(count)]


@pytest.mark.parametrize('hertz', RATES)
@pytest.mark.parametrize('count', (12, 14, LENGTH))
def test_a_first_command_that_is_late(hertz, count):
    for ticks in (rate(hertz, count), sleeps(hertz, count)):
        assert not is_late(ticks)
        assert is_late([ticks[0] + 1] + ticks[1:])
    assert not is_late(rate(hertz, count, first=1))     # like rospy.Timer


PERIODS = st.integers(STEP, 10 * STEP)
COUNTS = st.integers(12, LENGTH)


@given(PERIODS, COUNTS, st.integers(0, STEP))
def test_every_rate_is_one_that_fits(period, count, begin):
    """The rate may begin at any time between two ticks; period, begin: ns."""
    ticks = [-(-(begin + number * period) // STEP) for number in range(count)]
    assert possible_periods(ticks) > 0


@given(PERIODS, COUNTS, st.integers(0, 1))
def test_a_punctual_command_is_never_late(period, count, first):
    """This holds at any rate, for rospy.Rate (first: 0) and rospy.Timer (first: 1)."""
    assert not is_late([-(-(first + number) * period // STEP) for number in range(count)])


@given(st.integers(2, 50), COUNTS)
def test_a_late_command_is_found_at_any_whole_number_of_ticks(period, count):
    ticks = [number * period for number in range(count)]
    assert is_late([1] + ticks[1:]) and not is_late(ticks)


@given(st.lists(st.integers(0, 5), min_size=12, max_size=LENGTH - 1))
def test_what_has_no_rate_has_no_lag_that_helps(gaps):
    """Commands at any ticks have a lag of one tick only if the lag turns them into a rate."""
    ticks = [sum(gaps[:number]) for number in range(len(gaps) + 1)]
    if is_late(ticks):
        assert possible_periods([ticks[0] - 1] + ticks[1:]) > 0


@pytest.mark.parametrize('hertz', RATES)
def test_a_short_stream(hertz):
    for count in range(6, 10):
        ticks = rate(hertz, count)
        assert not is_late(ticks) and is_late([1] + ticks[1:])
    assert not is_late([0, 5]) and not is_late([0, 4])      # nothing to compare with


def test_the_periods_that_fit():
    assert possible_periods([0, 3, 5, 8, 10]) > 0       # 2.5
    assert possible_periods([0, 3, 4, 8, 10]) < 0       # no rate does that
    assert possible_periods([0, 10, 20]) == pytest.approx(10.5 - 9.5)


def lag_at_stop(ticks, stop, uncertain=True):
    """Return the lag of a stream with MOVE at these ticks, and STOP at `stop`."""
    stream = Stream(ticks[0], MOVE, uncertain)
    for tick in ticks[1:]:
        assert stream.lag_of(tick, MOVE) == 0
    return stream.lag_of(stop, STOP)


@pytest.mark.parametrize('hertz', RATES)
@pytest.mark.parametrize('count', (12, LENGTH, LENGTH + 1, 100))
def test_the_lag_of_a_stream(hertz, count):
    *ticks, stop = rate(hertz, count + 1)
    assert lag_at_stop(ticks, stop) == 0
    assert lag_at_stop([1] + ticks[1:], stop) == 1
    assert lag_at_stop([1] + ticks[1:], stop, uncertain=False) == 0
    # any number of ticks later
    assert lag_at_stop([1001] + [tick + 1000 for tick in ticks[1:]], stop + 1000) == 1


def test_a_stop_need_not_be_at_the_rate():
    """This happens after a motion whose duration is not a whole number of periods."""
    for hertz in RATES:
        ticks = rate(hertz, 12)
        for stop in range(ticks[-1], ticks[-1] + 10):
            assert lag_at_stop([1] + ticks[1:], stop) == 1 and lag_at_stop(ticks, stop) == 0


def test_the_lag_stays_until_the_stop():
    stream = Stream(1, MOVE, uncertain=True)
    for number in range(1, 12):
        stream.lag_of(3 * number, MOVE)
    turn = (0.0, 1.0)
    assert [stream.lag_of(tick, turn) for tick in (36, 39, 42)] == [1, 1, 1]
    assert stream.lag_of(45, STOP) == 1


def test_one_motion_and_a_stop_have_no_lag():
    for stop in range(1, 20):
        assert lag_at_stop([1], stop) == 0


def test_a_stream_decides_when_the_velocity_changes():
    stream = Stream(1, MOVE, uncertain=True)
    for tick in rate(20, 12)[1:]:
        assert stream.lag_of(tick, MOVE) == 0
    assert stream.lag_of(rate(20, 13)[-1], STOP) == 1
    certain = Stream(1, MOVE, uncertain=False)
    for tick in rate(20, 12)[1:]:
        certain.lag_of(tick, MOVE)
    assert certain.lag_of(rate(20, 13)[-1], STOP) == 0


def test_ticks_in_a_row():
    stream = Stream(7, MOVE, uncertain=False)
    for tick in range(8, 12):
        stream.lag_of(tick, MOVE)
    assert stream.in_a_row == 5
    for tick in (11, 13):       # two commands at one tick, and one tick skipped
        stream.lag_of(tick, MOVE)
        assert stream.in_a_row < 2
