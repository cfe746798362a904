"""Commands of several senders contradict each other if they alternate and differ."""
from rbx1_nav.base.conflicting_commands import Senders
from rbx1_nav.base.units import SECOND

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
        return self.senders.contradiction(self.now, self.live[name], name, command, self.connections)

    def connections(self):
        assert self.senders.lock.locked()       # commands of other senders arrive in other threads
        return self.live.values()


def test_commands_that_alternate_and_differ():
    base = Base()
    assert base.send('a', 0.2, 0.0) is base.send('b', 0.0, 1.0) is None
    assert base.send('a', 0.2, 0.0) == 'a sends 0.2 m/s, 0 rad/s, b sends 0 m/s, 1 rad/s'
    assert base.send('b', 0.0, 1.0) and base.senders.contradictions == 2
    assert base.senders.recent(base.now + SECOND, SECOND) and not base.senders.recent(base.now + SECOND, TICK)
    # on simulated time, several commands may arrive at one time
    assert base.send('a', 0.2, 0.0, after=0) and base.send('b', 0.0, 1.0, after=0) and base.senders.recent(base.now, 0)


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
