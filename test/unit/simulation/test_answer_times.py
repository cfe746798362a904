"""How long a tick waits for the commands of a driver whose process cannot be observed, on a clock of the test."""
from collections import deque

import pytest

from rbx1_nav.simulation import answers
from rbx1_nav.simulation.answers import Answers, NotInStep

MOVE, STOP = (0.2, 0.0), (0.0, 0.0)
ROUNDING = 1e-6     # s: a sum of many waits, and a command that arrives just after a limit


class Driver:
    """Answers on a clock that advances only while a tick waits, and a driver that sends at given times."""

    def __init__(self, monkeypatch, ticks=0):
        """ticks: number of ticks while the clock ran freely."""
        self.now = 0.0
        self.events = deque()       # (time, function)
        self.is_connected = True
        self.is_ended = False
        self.unread = False
        monkeypatch.setattr(answers, 'monotonic', lambda: self.now)
        self.answers = Answers(deque([0.0] * ticks), self, lambda: self.is_connected, lambda: self.unread,
                               lambda: self.is_ended)

    def wait(self, timeout):
        """Wait like a Condition: until the next event, or for at most `timeout` (s)."""
        assert timeout > 0
        if self.events and self.events[0][0] <= self.now + timeout:
            self.now, happen = self.events.popleft()
            happen()
        else:
            self.now += timeout

    def at(self, *times, command=MOVE):
        """Let the driver send a command at each of these times, counted from now."""
        self.events += [(self.now + time, lambda: self.answers.receive(command)) for time in times]

    def tick(self):
        """Make a tick; return its command and the time that it took (s)."""
        begin = self.now
        return self.answers.next(), pytest.approx(self.now - begin, abs=ROUNDING)

    def fail(self):
        """Make a tick that raises NotInStep; return the text and the time that it took (s)."""
        begin = self.now
        with pytest.raises(NotInStep) as error:
            self.answers.next()
        return str(error.value), pytest.approx(self.now - begin, abs=ROUNDING)

    def answer(self, ticks):
        """Answer a number of ticks at once, after the end of the first burst."""
        for number in range(ticks):
            self.answers.receive(MOVE)
            assert self.tick() == (MOVE, 0.0 if number else 0.1)


@pytest.fixture(name='make')
def make_make(monkeypatch):
    return lambda **arguments: Driver(monkeypatch, **arguments)


def test_a_tick_at_rest_waits_for_nothing(make):
    assert make().tick() == (None, 0.0)


def test_a_burst_is_over_when_nothing_arrives_for_a_tenth_of_a_second_and_later_for_30_ms(make):
    driver = make()
    driver.answers.receive(MOVE)
    driver.at(0.09, 0.18)
    driver.at(0.27, command=STOP)
    assert driver.tick() == (MOVE, 0.37) and driver.answers.lag == 4
    assert [driver.tick() for _ in range(3)] == [(MOVE, 0.0), (MOVE, 0.0), (STOP, 0.0)]
    # the next stream
    driver.answers.receive(MOVE)
    driver.at(0.025, 0.05)
    assert driver.tick() == (MOVE, 0.08) and driver.answers.lag == 3


def test_a_tick_waits_1_s_for_its_command(make):
    driver = make()
    driver.answer(1)
    driver.at(0.99)
    assert driver.tick()[0] == MOVE
    driver = make()
    driver.answer(1)
    assert driver.fail() == ('sent no command for a tick within 1 s', 1.0)
    assert driver.tick() == (None, 0.0)     # it is not waited for again


@pytest.mark.parametrize('ticks, patience', [(24, 1.0), (25, 5.0)])
def test_a_driver_that_has_answered_25_ticks_is_waited_for_5_s(make, ticks, patience):
    driver = make()
    driver.answer(ticks)
    assert driver.answers.proven is (ticks == 25)
    assert driver.fail() == (f'sent no command for a tick within {patience:g} s', patience)


def test_ticks_with_a_growing_queue_prove_nothing(make):
    driver = make()
    driver.answer(1)
    for _ in range(25):
        driver.answers.receive(MOVE)
        driver.answers.receive(MOVE)
        driver.tick()
    assert not driver.answers.proven


def test_a_driver_that_is_as_far_behind_as_at_first_uses_this_clock(make):
    driver = make(ticks=10)
    for _ in range(10):
        driver.answers.receive(MOVE)
    for _ in range(25):
        driver.tick()
        driver.answers.receive(MOVE)
    assert driver.answers.proven


@pytest.mark.parametrize('answer, took', [(0.049, 0.049), (0.051, 3 * 0.051), (0.2, 0.6)])
def test_after_a_slow_answer_the_clock_is_held_for_twice_that_time(make, answer, took):
    driver = make()
    driver.answer(1)
    driver.at(answer)
    assert driver.tick() == (MOVE, took)


def test_a_proven_driver_may_answer_slowly(make):
    driver = make()
    driver.answer(25)
    driver.at(0.2)
    assert driver.tick() == (MOVE, 0.2)


def test_a_driver_that_sends_while_the_clock_is_held_is_given_up_after_1_s(make):
    driver = make()
    driver.answers.receive(MOVE)
    driver.at(*[0.05 * number for number in range(1, 40)])
    text, took = driver.fail()
    # the command that arrives at 1 s may be waited for
    assert text == 'sends commands while the clock is held' and took in (1.0, 1.05)


def test_a_driver_that_answers_slowly_and_then_sends_is_given_up_after_six_times_its_answer(make):
    driver = make()
    driver.answer(1)
    driver.at(0.9, *[0.9 + number for number in range(1, 20)])
    # it must be quiet for 1.8 s, within 5.4 s: commands after 1, 2, ... 6 s
    assert driver.fail() == ('sends commands while the clock is held', 0.9 + 6.0)


def test_a_proven_driver_that_sends_while_the_clock_is_held_stays_in_step(make):
    driver = make(ticks=1000)
    driver.answer(25)
    driver.at(0.01, command=STOP)
    assert driver.tick() == (STOP, 0.01)
    driver.answers.receive(MOVE)
    driver.at(*[0.02 * number for number in range(1, 1000)])
    command, took = driver.tick()
    assert command == MOVE and took in (5.0, 5.02)      # the command that arrives at 5 s may be waited for


def test_a_burst_that_is_not_received_yet_is_waited_for(make):
    driver = make()
    driver.answers.receive(MOVE)
    driver.unread = True
    driver.events.append((0.35, lambda: setattr(driver, 'unread', False)))
    # 0.1 s at a time, until nothing is unread at the end of one
    assert driver.tick() == (MOVE, 0.4)


@pytest.mark.parametrize('ticks', [0, 7])
def test_a_burst_may_have_25_commands_more_than_the_clock_has_ticked(make, ticks):
    for more, good in (25, True), (26, False):
        driver = make(ticks=ticks)
        for _ in range(ticks + more):
            driver.answers.receive(MOVE)
        if good:
            assert driver.tick()[0] == MOVE
        else:
            assert driver.fail() == ('sends more than one command per tick', 0.1)


@pytest.mark.parametrize('lag', [1, 5])
def test_a_queue_may_grow_by_25_commands(make, lag):
    driver = make()
    for _ in range(lag):
        driver.answers.receive(MOVE)
    driver.tick()
    for _ in range(25 + 2):     # one that the first tick took, and one for the next
        driver.answers.receive(MOVE)
    assert driver.tick()[0] == MOVE
    driver.answers.receive(MOVE)
    driver.answers.receive(MOVE)
    assert driver.fail() == ('sends more than one command per tick', 0.0)


def test_a_proven_driver_may_send_any_number_of_commands(make):
    driver = make()
    driver.answer(25)
    for _ in range(100):
        driver.answers.receive(MOVE)
    assert driver.tick() == (MOVE, 0.0)


@pytest.mark.parametrize('command, moves', [
    ((0.2, 0.0), True), ((-0.2, 0.0), True), ((0.0, 1e-9), True), ((0.0, -0.1, 0.0), True), ((0.0, 0.0, 1.0), False),
    ((float('inf'), 0.0), False), ((0.0, float('-inf')), False), ((0.0, float('nan')), False)])
def test_after_a_motion_only_a_tick_waits_for_a_command(make, command, moves):
    driver = make()
    driver.answers.receive(command)
    driver.tick()
    if moves:
        assert driver.fail()[1] == 1.0
    else:
        assert driver.tick() == (None, 0.0)


@pytest.mark.parametrize('change', [dict(is_connected=False), dict(is_ended=True)])
def test_a_driver_that_disconnects_during_the_wait_is_not_waited_for(make, change):
    driver = make()
    driver.answer(1)
    # nobody is notified of this, so it is noticed within 0.1 s
    driver.events.append((driver.now + 0.45, lambda: None))
    driver.events.append((driver.now + 0.46, lambda: vars(driver).update(change)))
    command, _ = driver.tick()
    assert command is None and driver.now == pytest.approx(0.1 + 0.46)


def test_a_wait_looks_for_the_end_ten_times_per_second(make, monkeypatch):
    driver, waits = make(), []
    driver.answer(1)
    wait = driver.wait
    monkeypatch.setattr(driver, 'wait', lambda timeout: waits.append(timeout) or wait(timeout))
    driver.fail()
    assert max(waits) == pytest.approx(0.1) and sum(waits) == pytest.approx(1.0)
