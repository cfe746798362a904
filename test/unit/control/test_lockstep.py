"""The clock waits for each tick's command, and for nobody who does not drive by it."""
import threading
import time

from rbx1_nav.control import lockstep
from rbx1_nav.control.lockstep import Lockstep

MOVE, STOP = (0.2, 0.0), (0.0, 0.0)


class Bench:
    """A Lockstep, and what came of it."""

    def __init__(self):
        self.applied = []
        self.said = []
        self.lockstep = Lockstep(self.applied.append, self.said.append)

    def send(self, *commands, connection='first'):
        for command in commands:
            self.lockstep.receive(connection, '/driver', command)


def test_one_command_a_tick_however_many_have_come():
    bench = Bench()
    bench.send(MOVE, MOVE, STOP)
    for expected in ([MOVE], [MOVE, MOVE], [MOVE, MOVE, STOP], [MOVE, MOVE, STOP]):
        bench.lockstep.collect()
        assert bench.applied == expected
    assert not bench.said


def test_a_tick_waits_for_its_command():
    bench = Bench()
    bench.send(MOVE)
    bench.lockstep.collect()
    late = threading.Timer(0.05, bench.send, [STOP])
    late.start()
    bench.lockstep.collect()
    late.join()
    assert bench.applied == [MOVE, STOP] and not bench.said


def test_nothing_to_wait_for_after_a_stop():
    bench = Bench()
    bench.send(MOVE, STOP)
    for _ in range(1000):
        bench.lockstep.collect()
    assert bench.applied == [MOVE, STOP] and not bench.said


def test_it_goes_on_without_one_that_falls_silent_and_says_so(monkeypatch):
    monkeypatch.setattr(lockstep, 'PATIENCE', 0.2)
    bench = Bench()
    bench.send(MOVE)
    for _ in range(1000):
        bench.lockstep.collect()
    assert len(bench.said) == 1 and bench.said[0].startswith('/driver left a tick without a command')
    bench.send(MOVE)
    assert bench.applied == [MOVE, MOVE]


def test_it_lets_go_of_more_than_one_command_a_tick():
    bench = Bench()
    bench.send(MOVE)
    bench.lockstep.collect()
    for _ in range(60):
        bench.send(MOVE, MOVE)
        bench.lockstep.collect()
    assert len(bench.said) == 1 and 'more than one command in a tick' in bench.said[0]


def test_it_lets_go_of_one_that_speaks_while_the_clock_stands(monkeypatch):
    monkeypatch.setattr(lockstep, 'PATIENCE', 0.3)
    bench = Bench()
    done = threading.Event()

    def talk():
        while not done.wait(0.01):
            bench.send(MOVE)
    talker = threading.Thread(target=talk)
    talker.start()
    try:
        while not bench.applied:
            bench.lockstep.collect()
            time.sleep(0.01)
    finally:
        done.set()
        talker.join()
    assert len(bench.said) == 1 and 'while the clock stands still' in bench.said[0]


def test_drivers_do_not_take_each_others_place():
    bench = Bench()
    bench.send(MOVE, STOP)
    bench.send((0.0, 1.0), STOP, connection='second')
    bench.lockstep.collect()
    bench.lockstep.collect()
    assert bench.applied == [MOVE, (0.0, 1.0), STOP, STOP]


def test_a_connection_that_is_gone_is_forgotten(monkeypatch):
    monkeypatch.setattr(lockstep, 'PATIENCE', 0.2)
    bench = Bench()
    bench.send(MOVE, connection='killed')
    bench.lockstep.collect()
    bench.lockstep.keep(['first'])
    assert not bench.lockstep.knows('killed')
    bench.lockstep.collect()
    assert not bench.said


def test_a_driver_that_lags_from_the_start_is_not_one_that_sends_too_much():
    bench = Bench()
    bench.send(*[MOVE] * 40)
    for _ in range(40):
        bench.lockstep.collect()
        bench.send(MOVE)
    assert bench.applied == [MOVE] * 40 and not bench.said
