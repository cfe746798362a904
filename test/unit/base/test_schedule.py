"""When a periodic task is due."""
from rbx1_nav.base.schedule import Schedule
from rbx1_nav.base.units import SECOND


def test_a_rate_below_that_of_the_calls():
    schedule = Schedule(10)
    due = [tick for tick in range(100) if schedule.due(tick * SECOND // 50)]
    assert due == list(range(0, 100, 5))


def test_missed_periods_are_not_made_up_for():
    schedule = Schedule(10)
    assert schedule.due(0) and not schedule.due(SECOND // 10 - 1) and schedule.due(60 * SECOND)
    assert not schedule.due(60 * SECOND + 1) and not schedule.due(60 * SECOND + SECOND // 10 - 1)
    # one that is late by less than a period is made up for, by one period it is not
    assert schedule.due(60 * SECOND + SECOND // 10 * 3 // 2) and schedule.due(60 * SECOND + SECOND // 5)
    assert schedule.due(60 * SECOND + SECOND // 10 * 4) and not schedule.due(60 * SECOND + SECOND // 2 - 1)


def test_a_clock_that_jumps_back_restarts_the_schedule():
    schedule = Schedule(10)
    assert schedule.due(1000 * SECOND) and schedule.due(5 * SECOND) and not schedule.due(5 * SECOND + 1)
