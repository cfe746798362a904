"""Each tick waits for the command of a driver whose process cannot be observed, if it drives by the clock."""
import threading
import time

from rbx1_nav.simulation import answers
from rbx1_nav.simulation.lockstep import Lockstep

MOVE, STOP = (0.2, 0.0), (0.0, 0.0)


class Nodes:
    """Processes that cannot be observed."""

    drivers = set()

    def __init__(self):
        self.closed = set()
        self.unread_from = set()

    def update(self):
        pass

    def connecting(self):
        return False

    def sees(self, _):
        return False

    def note(self, _):
        pass

    def mark(self, _):
        pass

    def awake(self):
        return None

    def polling(self):
        return []

    def forget(self, _):
        pass

    def connected(self, connection):
        return connection not in self.closed

    def unread(self, connection):
        return connection in self.unread_from


class Recorder:
    """A Lockstep, and the commands and warnings that it produced."""

    def __init__(self):
        self.applied = []
        self.warnings = []
        self.nodes = Nodes()
        self.closed, self.unread = self.nodes.closed, self.nodes.unread_from
        self.ended = threading.Event()
        self.lockstep = Lockstep(self.applied.append, lambda name, reason: self.warnings.append(f'{name} {reason}'),
                                 self.nodes, self.ended.is_set)

    def collect(self):
        """Make a tick."""
        self.lockstep.begin_tick()
        self.lockstep.end_tick()

    def send(self, *commands, connection='first'):
        for command in commands:
            self.lockstep.receive(connection, '/driver', command)


def test_each_tick_applies_one_command_however_many_are_queued():
    recorder = Recorder()
    recorder.send(MOVE, MOVE, STOP)
    for expected in ([MOVE], [MOVE, MOVE], [MOVE, MOVE, STOP], [MOVE, MOVE, STOP]):
        recorder.collect()
        assert recorder.applied == expected
    assert not recorder.warnings


def test_a_tick_waits_for_its_command():
    recorder = Recorder()
    recorder.send(MOVE)
    recorder.collect()
    late = threading.Timer(0.05, recorder.send, [STOP])
    late.start()
    recorder.collect()
    late.join()
    assert recorder.applied == [MOVE, STOP] and not recorder.warnings


def test_after_a_stop_no_tick_waits():
    recorder = Recorder()
    recorder.send(MOVE, STOP)
    for _ in range(1000):
        recorder.collect()
    assert recorder.applied == [MOVE, STOP] and not recorder.warnings


def test_a_driver_that_stops_sending_is_released_with_a_warning(monkeypatch):
    monkeypatch.setattr(answers, 'COMMAND_TIMEOUT', 0.2)
    recorder = Recorder()
    recorder.send(MOVE)
    for _ in range(1000):
        recorder.collect()
    assert len(recorder.warnings) == 1 and recorder.warnings[0].startswith('/driver sent no command for a tick')
    recorder.send(MOVE)
    assert recorder.applied == [MOVE, MOVE]


def test_a_driver_that_sends_two_commands_per_tick_is_released():
    recorder = Recorder()
    recorder.send(MOVE)
    recorder.collect()
    for _ in range(60):
        recorder.send(MOVE, MOVE)
        recorder.collect()
    assert len(recorder.warnings) == 1 and 'more than one command per tick' in recorder.warnings[0]


def test_a_driver_that_sends_while_the_clock_is_held_is_released(monkeypatch):
    monkeypatch.setattr(answers, 'COMMAND_TIMEOUT', 0.3)
    recorder = Recorder()
    done = threading.Event()

    def stream():
        while not done.wait(0.01):
            recorder.send(MOVE)
    streamer = threading.Thread(target=stream)
    streamer.start()
    try:
        while not recorder.applied:
            recorder.collect()
            time.sleep(0.01)
    finally:
        done.set()
        streamer.join()
    assert len(recorder.warnings) == 1 and 'while the clock is held' in recorder.warnings[0]


def test_each_connection_has_its_own_queue():
    recorder = Recorder()
    recorder.send(MOVE, STOP)
    recorder.send((0.0, 1.0), STOP, connection='second')
    recorder.collect()
    recorder.collect()
    assert recorder.applied == [MOVE, (0.0, 1.0), STOP, STOP]


def answer_ticks(recorder, ticks):
    """Let a driver answer a number of ticks, with one command each."""
    for _ in range(ticks):
        recorder.send(MOVE)
        recorder.collect()


def test_a_driver_that_has_answered_many_ticks_is_waited_for_longer(monkeypatch):
    monkeypatch.setattr(answers, 'COMMAND_TIMEOUT', 0.1)
    recorder = Recorder()
    answer_ticks(recorder, answers.PROOF)
    late = threading.Timer(0.4, recorder.send, [STOP])
    late.start()
    recorder.collect()
    late.join()
    assert recorder.applied[-1] == STOP and not recorder.warnings


def test_a_driver_whose_connection_has_closed_is_not_waited_for():
    recorder = Recorder()
    answer_ticks(recorder, answers.PROOF)
    recorder.closed.add('first')
    for _ in range(1000):
        recorder.collect()
    assert not recorder.warnings


def test_commands_of_a_closed_connection_are_not_lost():
    recorder = Recorder()
    recorder.send(MOVE, MOVE, STOP)
    recorder.closed.add('first')
    recorder.collect()
    recorder.send((0.0, 1.0), connection='second')
    for _ in range(2):
        recorder.collect()
    assert recorder.applied.count(MOVE) == 2 and STOP in recorder.applied


def test_a_burst_that_is_received_late_is_not_lost():
    """The receiving thread receives the first command of a burst, and then starves for longer than a pause."""
    recorder = Recorder()
    for _ in range(40):
        recorder.collect()     # the clock runs freely
    recorder.unread.add('first')
    recorder.send(MOVE)

    def go_on():
        recorder.unread.clear()
        recorder.send(*[MOVE] * 40, STOP)
    late = threading.Timer(3 * answers.FIRST_QUIET, go_on)
    late.start()
    for _ in range(50):
        recorder.collect()
    late.join()
    assert recorder.applied == [MOVE] * 41 + [STOP] and not recorder.warnings


def test_nobody_is_waited_for_at_the_end(monkeypatch):
    recorder = Recorder()
    answer_ticks(recorder, answers.PROOF)
    recorder.ended.set()
    recorder.collect()
    assert not recorder.warnings


def test_a_command_that_is_not_finite_is_no_motion():
    recorder = Recorder()
    for value in (float('nan'), float('inf')):
        recorder.send((value, 0.0))
        recorder.collect()
        recorder.collect()
    assert not recorder.warnings


def test_a_driver_that_sends_far_more_than_the_clock_has_ticked_is_released():
    """The last command counts, because a stop must not wait behind a flood of commands."""
    recorder = Recorder()
    recorder.send(*[MOVE] * 500, STOP)
    recorder.collect()
    assert recorder.applied == [STOP]
    assert len(recorder.warnings) == 1 and 'more than one command per tick' in recorder.warnings[0]


def test_a_driver_that_lags_from_the_start_is_not_released():
    recorder = Recorder()
    for _ in range(40):
        recorder.collect()     # the clock runs freely
    recorder.send(*[MOVE] * 40)
    for _ in range(40):
        recorder.collect()
        recorder.send(MOVE)
    assert recorder.applied == [MOVE] * 40 and not recorder.warnings
