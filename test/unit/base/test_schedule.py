"""When a periodic task is due."""
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND


def test_a_rate_below_that_of_the_calls():
    schedule = Schedule(10)
    due = [tick for tick in range(100) if schedule.due(tick * SECOND // 50)]
    assert due == list(range(0, 100, 5))


def test_missed_periods_are_not_made_up_for():
    schedule = Schedule(10)
    assert schedule.due(0) and schedule.due(60 * SECOND) and not schedule.due(60 * SECOND + 1)


def test_a_clock_that_jumps_back_restarts_the_schedule():
    schedule = Schedule(10)
    assert schedule.due(1000 * SECOND) and schedule.due(5 * SECOND) and not schedule.due(5 * SECOND + 1)


@given(st.lists(st.integers(-10 ** 10, 10 ** 10), max_size=50))
def test_on_every_clock_it_is_due_within_two_periods(steps):
    schedule, now, last_due = Schedule(10), 0, None
    for step in steps:
        before, now = now, now + step
        if schedule.due(now):
            last_due = now
        else:
            assert now >= before and last_due is not None and now - last_due <= 2 * schedule.period
