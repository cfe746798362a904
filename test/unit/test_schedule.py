"""When something periodic is due."""
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.units import SECOND
from rbx1_nav.schedule import Schedule


def test_a_slower_rate_than_the_calls():
    schedule = Schedule(10)
    due = [tick for tick in range(100) if schedule.due(tick * SECOND // 50)]
    assert due == list(range(0, 100, 5))


def test_late_calls_do_not_pile_up():
    schedule = Schedule(10)
    assert schedule.due(0) and schedule.due(60 * SECOND) and not schedule.due(60 * SECOND + 1)


def test_a_clock_that_goes_back_starts_it_again():
    schedule = Schedule(10)
    assert schedule.due(1000 * SECOND) and schedule.due(5 * SECOND) and not schedule.due(5 * SECOND + 1)


@given(st.lists(st.integers(-10 ** 10, 10 ** 10), max_size=50))
def test_no_clock_silences_it_for_longer_than_a_period(steps):
    schedule, now, silent_since = Schedule(10), 0, None
    for step in steps:
        before, now = now, now + step
        if schedule.due(now):
            silent_since = now
        else:
            assert now >= before and silent_since is not None and now - silent_since <= 2 * schedule.period
