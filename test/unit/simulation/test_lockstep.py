"""A tick lasts until all that it has woken sleeps again, and its commands take effect at its end."""
import pytest

from rbx1_nav.simulation import lockstep
from rbx1_nav.simulation.lockstep import Lockstep

MOVE, FASTER, STOP = (0.2, 0.0), (0.3, 0.0), (0.0, 0.0)


class Nodes:
    """Drivers `a` and `b`, whose processes can be seen: they sleep as soon as `work` is empty."""

    def __init__(self):
        self.drivers = {'a', 'b'}
        self.work = []          # functions, called one for each look: each time something is awake
        self.never_sleeps = None
        self.looks = 0
        self.driver_looks = 0
        self.woken = set()      # names of those that have woken by themselves
        self.new_upstream = False
        self.off_clock = set()
        self.poll = []          # what is returned to still_polling()

    def update(self):
        pass

    def connecting(self):
        return False

    def sees(self, name):
        return name in self.drivers

    def on_clock(self, name):
        return name not in self.off_clock

    def mark(self, _):
        pass

    def woke_by_itself(self, name):
        return name in self.woken

    def awake(self):
        self.looks += 1
        if self.work:
            self.work.pop(0)()
            return 'a'
        return self.never_sleeps

    def awake_drivers(self):
        self.driver_looks += 1
        return self.never_sleeps

    def polling(self):
        return list(self.poll)

    def still_polling(self, _):
        if self.poll:
            self.poll.pop()()
        return bool(self.poll)

    def forget(self, name):
        self.drivers.discard(name)
        if self.never_sleeps == name:
            self.never_sleeps = None

    def update_upstream(self):
        return self.new_upstream

    def connected(self, _):
        return True


class World:
    """A Lockstep; commands with the tick at which they took effect."""

    def __init__(self, report=None):
        self.applied = []
        self.reports = []
        self.nodes = Nodes()
        self.lockstep = Lockstep(lambda command: self.applied.append((self.lockstep.tick, command)),
                                 report or (lambda *each: self.reports.append(each)), self.nodes, lambda: False)

    def send(self, name, command):
        self.lockstep.receive(name, name, command)

    def send_unprompted(self):
        """Commands between two ticks, so many that they prove something."""
        for _ in range(lockstep.PROOF):
            self.send('a', MOVE)

    def tick(self, *commands):
        """A tick with these commands in answer, (name, command) each."""
        self.lockstep.begin_tick()
        self.nodes.work += [lambda each=each: self.send(*each) for each in commands]
        self.lockstep.end_tick()

    def drive(self, *ticks, name='a', until=40):
        """Let a driver send MOVE at these ticks, counted from the next one."""
        begin = self.lockstep.tick + 1
        for tick in range(until):
            self.tick(*[(name, MOVE)] * (tick in ticks))
        return begin


@pytest.fixture
def world():
    return World()


def test_a_command_takes_effect_at_the_tick_that_it_answers(world):
    for period in (1, 2, 3, 5):
        begin = world.drive(*range(0, 40, period))
        world.tick(('a', STOP))
        assert world.applied == [(begin + tick, MOVE) for tick in range(0, 40, period)] + [(begin + 40, STOP)]
        world.applied.clear()
    assert not world.reports


def test_the_commands_of_a_tick_are_in_the_order_of_the_names(world):
    world.tick(('b', FASTER), ('a', MOVE), ('b', STOP))
    assert world.applied == [(1, MOVE), (1, FASTER), (1, STOP)]


def test_a_command_between_two_ticks_belongs_to_the_tick_before(world):
    world.tick()
    world.send('a', MOVE)
    world.tick(('a', FASTER))
    assert world.applied == [(1, MOVE), (2, FASTER)] and not world.reports


def test_a_command_that_comes_while_the_tick_begins_is_not_lost(world):
    world.tick()
    mark = world.nodes.mark
    world.nodes.mark = lambda names: (setattr(world.nodes, 'mark', mark), world.send('a', MOVE))
    world.tick()
    assert world.applied == [(1, MOVE)]


def test_the_clock_waits_while_a_node_is_awake(world):
    world.lockstep.begin_tick()
    awake = []
    world.nodes.work = [lambda: awake.append(world.lockstep.tick)] * 20 + [lambda: world.send('a', MOVE)]
    world.lockstep.end_tick()
    assert awake == [1] * 20 and world.applied == [(1, MOVE)]
    # something else may wake a node after that: the next tick begins only when it sleeps again
    world.lockstep.over_since = -1.0
    world.nodes.work = [lambda: awake.append(world.lockstep.tick)] * 20
    world.lockstep.begin_tick()
    assert awake == [1] * 40 and world.lockstep.tick == 2


def test_what_a_polling_thread_has_woken_is_waited_for(world):
    world.lockstep.begin_tick()
    world.nodes.poll = [lambda: world.nodes.work.append(lambda: world.send('b', MOVE))]
    world.lockstep.end_tick()
    assert world.applied == [(1, MOVE)]


def test_a_thread_that_polls_is_waited_for(world):
    world.lockstep.begin_tick()
    world.nodes.poll = [lambda: world.send('a', MOVE), lambda: None]
    world.lockstep.end_tick()
    assert world.applied == [(1, MOVE)]


def test_a_node_that_never_sleeps_is_waited_for_once(world, monkeypatch):
    monkeypatch.setattr(lockstep, 'NODE_TIMEOUT', 0.05)
    world.tick(('a', MOVE))
    world.nodes.never_sleeps = 'a'
    for _ in range(3):
        world.tick()
    assert [name for name, _ in world.reports] == ['a'] and 'did not come to rest' in world.reports[0][1]
    world.send('a', FASTER)
    assert world.applied[-1] == (4, FASTER)     # at once


def test_a_node_that_is_no_driver_is_given_up_alone(world, monkeypatch):
    monkeypatch.setattr(lockstep, 'NODE_TIMEOUT', 0.05)
    world.tick(('a', MOVE), ('b', MOVE))
    world.nodes.never_sleeps = 'the master'
    world.tick(('a', MOVE))
    assert [name for name, _ in world.reports] == ['the master']
    world.lockstep.begin_tick()
    world.send('a', STOP)
    assert world.applied[-1] != (3, STOP)       # still in step
    world.lockstep.end_tick()
    assert world.applied[-1] == (3, STOP)


def test_a_command_of_the_tick_in_which_its_driver_is_given_up_is_not_lost(world, monkeypatch):
    monkeypatch.setattr(lockstep, 'NODE_TIMEOUT', 0.05)
    world.tick(('a', MOVE))
    world.nodes.never_sleeps = 'a'
    world.tick(('a', FASTER))
    assert world.applied == [(1, MOVE), (2, FASTER)] and len(world.reports) == 1


def test_a_driver_that_no_tick_has_prompted_is_released(world):
    world.tick(('a', MOVE))
    world.send('a', MOVE)
    world.send('a', MOVE)
    world.tick()
    assert not world.reports    # a busy machine, perhaps
    world.send('a', MOVE)
    world.tick()
    assert world.reports == [('a', 'sends commands that no tick of /clock has prompted')]
    world.send('a', FASTER)
    assert world.applied[-1] == (3, FASTER)     # at once


def test_the_first_command_and_a_stop_at_rest_need_no_tick(world):
    world.tick()
    world.send('a', STOP)
    world.tick()
    world.send('a', MOVE)
    world.tick(('a', MOVE))
    world.tick(('a', STOP))
    world.send('a', STOP)
    world.tick()
    assert not world.reports


def test_a_node_whose_commands_come_from_others_is_not_released(world):
    world.tick(('a', MOVE))
    world.nodes.new_upstream = True
    world.send_unprompted()
    world.tick()
    assert not world.reports


def test_a_driver_that_does_not_know_the_clock_is_released(world):
    world.nodes.off_clock = {'a'}
    world.tick(('a', MOVE))
    assert not world.reports
    world.tick(('a', MOVE))
    assert world.reports == [('a', 'does not subscribe to /clock')]


def test_after_a_stop_a_driver_may_begin_again_without_a_tick(world):
    world.tick(('a', MOVE))
    world.tick(('a', STOP))
    world.tick()
    world.send('a', FASTER)
    world.tick()
    assert world.applied[-1] == (3, FASTER) and not world.reports


def test_a_turn_is_a_motion(world):
    world.tick(('a', (0.0, 1.0)))
    world.send_unprompted()
    world.tick()
    assert len(world.reports) == 1


def test_only_a_driver_at_rest_is_marked(world):
    marked = []
    world.nodes.mark = marked.append
    world.tick(('a', MOVE))
    world.tick(('a', STOP))
    world.tick()
    assert marked == [{'a', 'b'}, {'b'}, {'a', 'b'}]


def test_one_driver_that_is_released_does_not_affect_another(world):
    world.tick(('a', MOVE), ('b', MOVE))
    world.send_unprompted()
    world.tick(('b', MOVE))
    world.tick(('b', FASTER))
    assert len(world.reports) == 1 and world.applied[-1] == (3, FASTER)


def test_a_driver_at_every_tick_spares_the_look(world, monkeypatch):
    monkeypatch.setattr(lockstep, 'FRESH', 1000)
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    before = world.nodes.looks
    for _ in range(10):
        world.lockstep.begin_tick()
        world.send('a', MOVE)
        world.lockstep.end_tick()
    assert world.nodes.looks == before
    # it stops to send: that is seen by a look
    for _ in range(10):
        world.tick()
    assert world.nodes.looks > before and not world.reports
    world.tick(('a', STOP))
    assert world.applied[-1] == (61, STOP)


def test_a_steady_driver_that_stops_sending_does_not_hold_the_clock(world):
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    for _ in range(10):
        world.tick()
    assert world.lockstep.tick == 50 and not world.reports
    world.tick(('a', STOP))
    assert world.applied[-1] == (51, STOP)


def test_a_steady_driver_that_has_gone_is_not_waited_for(world, monkeypatch):
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    world.nodes.drivers = set()

    def wait_for(*_):
        raise AssertionError('waited')
    monkeypatch.setattr(world.lockstep.changed, 'wait_for', wait_for)
    world.tick()
    assert not world.reports


def test_two_commands_of_one_steady_driver_do_not_stand_for_another(world):
    world.drive(*range(40))
    for _ in range(30):
        world.tick(('a', MOVE), ('b', MOVE))
    before = world.nodes.looks
    world.lockstep.begin_tick()
    world.send('a', MOVE)
    world.send('a', FASTER)
    world.nodes.work = [lambda: world.send('b', STOP)]
    world.lockstep.end_tick()
    assert world.nodes.looks > before
    assert world.applied[-3:] == [(71, MOVE), (71, FASTER), (71, STOP)]


def test_a_driver_at_rest_beside_one_at_every_tick_is_looked_at(world):
    world.drive(*range(40))
    before = world.nodes.looks
    world.lockstep.begin_tick()
    world.send('a', MOVE)
    world.nodes.work = [lambda: world.send('b', FASTER)]
    world.lockstep.end_tick()
    assert world.nodes.looks > before and world.applied[-1] == (41, FASTER)


def test_a_steady_driver_is_not_waited_for_at_the_end(world, monkeypatch):
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    world.lockstep.ended = lambda: True
    waits = []
    monkeypatch.setattr(world.lockstep.changed, 'wait_for', lambda over, _: waits.append(over()) or waits[-1])
    world.tick()
    assert waits == [True]


def test_a_stream_whose_first_command_was_late_ends_a_tick_later(world):
    world.nodes.woken = {'a'}
    begin = world.drive(1, *range(3, 40, 3))    # of a driver that woke at tick 0
    world.tick(('a', STOP))     # not at a time of its rate, as at the end of a timer
    world.tick()
    assert world.applied[0] == (begin + 1, MOVE) and world.applied[-1] == (begin + 41, STOP)
    # the next stream is on its own
    world.tick(('a', MOVE))
    world.tick(('a', STOP))
    assert world.applied[-1] == (begin + 43, STOP)


def test_a_stream_that_a_tick_has_begun_is_not_delayed(world):
    begin = world.drive(1, *range(3, 40, 3))
    world.tick(('a', STOP))
    assert world.applied[-1] == (begin + 40, STOP)


def test_a_command_that_is_delayed_takes_effect_before_those_of_its_tick(world):
    world.nodes.woken = {'a'}
    begin = world.drive(1, *range(3, 40, 3))
    world.tick(('a', STOP))
    world.tick(('a', MOVE))
    assert world.applied[-2:] == [(begin + 41, STOP), (begin + 41, MOVE)]


def test_a_first_command_that_no_tick_has_prompted_is_not_late(world):
    """It took effect at the tick before: nothing is missing."""
    world.nodes.woken = {'a'}
    world.drive()
    world.send('a', MOVE)
    begin = world.drive(*range(1, 40, 3))
    world.tick(('a', STOP))
    assert world.applied[-1] == (begin + 40, STOP) and not world.reports


def test_nobody_is_waited_for_at_the_end():
    world = World()
    world.nodes.never_sleeps = 'a'
    world.lockstep.ended = lambda: True
    world.tick(('a', MOVE))
    world.tick()
    assert world.lockstep.tick == 2 and not world.reports


def test_nobody_is_waited_for_after_the_end_of_a_wait(world):
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    world.nodes.work = [lambda: setattr(world.lockstep, 'ended', lambda: True)]
    world.nodes.never_sleeps = 'a'
    world.nodes.poll = [lambda: None] * 1000
    world.lockstep.begin_tick()
    world.lockstep.end_tick()
    assert not world.reports


def test_a_report_that_raises_ends_the_tick():
    def strict(name, reason):
        raise RuntimeError(name + reason)
    world = World(strict)
    world.tick(('a', MOVE))
    world.send_unprompted()
    with pytest.raises(RuntimeError):
        world.tick()


def test_a_driver_that_comes_while_another_is_looked_for_is_seen():
    """Its first command arrives while nodes.sees() searches for the process of the other."""
    world = World()
    sees = world.nodes.sees

    def sees_slowly(name):
        if name == 'a':
            world.send('b', FASTER)
        return sees(name)
    world.nodes.sees = sees_slowly
    world.tick(('a', MOVE))
    world.tick()
    driver, = (each for each in world.lockstep.drivers.values() if each.name == 'b')
    assert driver.seen and not driver.answers


def test_a_node_that_connects_beside_a_steady_driver_is_looked_at():
    world = World()
    world.nodes.drivers = {'a'}
    world.drive(*range(40))

    def update():
        world.nodes.drivers = {'a', 'b'}
    world.nodes.update = update
    world.lockstep.begin_tick()
    world.send('a', MOVE)
    world.nodes.work = [lambda: world.send('b', FASTER)]
    world.lockstep.end_tick()
    assert world.applied[-1] == (41, FASTER)


def test_a_driver_that_stops_sending_is_not_steady_any_more(monkeypatch):
    """Or each further tick waits ANSWER_TIME for it."""
    world = World()
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    world.tick()
    waits = []
    monkeypatch.setattr(world.lockstep.changed, 'wait_for', lambda *_: waits.append(1))
    world.tick()
    assert not waits
