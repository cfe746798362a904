"""Commands of several senders contradict each other if they alternate and differ."""
import pytest

from rbx1_nav.control.gate import Senders
from rbx1_nav.units import SECOND

TICK = SECOND // 50


class Base:
    """A base that receives commands from the senders a, b, ..."""

    def __init__(self):
        self.senders = Senders()
        self.live = {name: object() for name in 'abc'}
        self.now = 0

    def send(self, name, *command, after=TICK):
        """Send a command, and return the contradiction that it causes."""
        self.now += after
        return self.senders.contradiction(self.now, self.live[name], name, command, self.live.values)


def test_commands_that_alternate_and_differ():
    base = Base()
    assert base.send('a', 0.2, 0.0) is base.send('b', 0.0, 1.0) is None
    assert base.send('a', 0.2, 0.0) == 'a sends 0.2 m/s, 0 rad/s, b sends 0 m/s, 1 rad/s'
    assert base.send('b', 0.0, 1.0) and base.senders.contradictions == 2
    assert base.senders.recent(base.now + SECOND, SECOND) and not base.senders.recent(base.now + SECOND, TICK)


def test_a_sender_that_takes_over():
    base = Base()
    sent = [('a', 0.2, 0.0)] * 3 + [('a', 0.0, 0.0)] + [('b', 0.0, 1.0)] * 60 + [('a', 0.2, 0.0)] * 3
    assert [base.send(*each) for each in sent] == [None] * len(sent)


def test_senders_that_agree():
    base = Base()
    assert [base.send(name, 0.2, 0.0) for name in 'abcabc'] == [None] * 6


def test_commands_far_apart():
    base = Base()
    assert [base.send(name, float(name == 'a'), 0.0, after=SECOND // 3) for name in 'ababab'] == [None] * 6


def test_a_sender_that_has_gone():
    base = Base()
    base.send('a', 0.2, 0.0), base.send('b', 0.0, 1.0)
    gone = base.live.pop('b')
    assert base.send('a', 0.2, 0.0) is None
    base.live['b'] = object()
    base.send('b', 0.0, 1.0)
    assert id(gone) not in base.senders.latest


def test_a_clock_that_jumps_back():
    base = Base()
    base.send('a', 0.2, 0.0, after=100 * SECOND), base.send('b', 0.0, 1.0)
    assert base.send('a', 0.2, 0.0, after=-50 * SECOND) is None


def test_commands_of_the_same_moment():
    base = Base()
    assert [base.send(name, float(name == 'a'), 0.0, after=0) for name in 'ab'] == [None] * 2
    assert base.send('a', 1.0, 0.0, after=0) == 'a sends 1 m/s, 0 rad/s, b sends 0 m/s, 0 rad/s'
    assert base.send('b', 0.0, 0.0) and base.senders.contradictions == 2


@pytest.mark.parametrize('silence, contradicts', [(SECOND // 2, True), (SECOND // 2 + 1, False)])
def test_a_sender_gives_up_control_after_half_a_second_of_silence(silence, contradicts):
    base = Base()
    base.send('a', 0.2, 0.0), base.send('b', 0.0, 1.0)
    assert bool(base.send('a', 0.2, 0.0, after=silence - TICK)) is contradicts


def test_the_text_names_the_sender_of_the_latest_command():
    base = Base()
    for name in 'abc':
        assert base.send(name, float(ord(name)), 0.0) is None
    assert base.send('a', 0.0, 0.0) == 'a sends 0 m/s, 0 rad/s, c sends 99 m/s, 0 rad/s'
    assert base.send('b', 0.0, 0.5) == 'b sends 0 m/s, 0.5 rad/s, a sends 0 m/s, 0 rad/s'


def test_a_third_sender_does_not_hide_a_contradiction():
    base = Base()
    for name in 'abc':
        base.send(name, float(name == 'a'), 0.0)
    assert base.send('a', 1.0, 0.0) and base.send('b', 0.0, 0.0)


def test_a_first_command_counts_although_its_connection_is_not_listed_yet():
    base = Base()
    live = base.live
    base.send('a', 0.2, 0.0)
    base.live = {'b': live['b']}
    base.senders.contradiction(base.now, base.live['b'], 'b', (0.0, 1.0), lambda: [live['a']])
    base.live = live
    base.send('a', 0.2, 0.0)
    assert base.send('b', 0.0, 1.0)


def test_how_long_a_contradiction_is_recent():
    base = Base()
    assert base.senders.recent(0, SECOND) is None
    for name in 'aba':
        text = base.send(name, float(name == 'a'), 0.0)
    assert [base.senders.recent(base.now + age, SECOND) for age in (0, SECOND)] == [text] * 2
    assert base.senders.recent(base.now + SECOND + 1, SECOND) is None
    assert base.senders.recent(base.now - 1, SECOND) is None    # the clock jumped back
