"""When the clock waits for nodes whose processes are observed and for how long, on a wall clock of the test."""
import pytest

from rbx1_nav.simulation import lockstep
from lockstep_world import FASTER, MOVE, STOP, World


class Wall:
    """A wall clock that advances only while the clock of the simulation waits."""

    def __init__(self, monkeypatch):
        self.now = 100.0
        monkeypatch.setattr(lockstep, 'monotonic', lambda: self.now)
        monkeypatch.setattr(lockstep, 'sleep', self.sleep)

    def sleep(self, duration):
        """Take at least 10 ms, so that a wait of 5 s takes few steps."""
        assert duration > 0
        self.now += max(duration, 0.01)


@pytest.fixture(name='wall')
def make_wall(monkeypatch):
    return Wall(monkeypatch)


@pytest.fixture(name='looks')
def make_looks(world, monkeypatch):
    """Return the ticks at which the nodes were checked before the next tick began."""
    looks, awake, begin_tick = [], world.nodes.awake, world.lockstep.begin_tick

    def begin():
        with monkeypatch.context() as patch:
            patch.setattr(world.nodes, 'awake', lambda: looks.append(world.lockstep.tick) or awake())
            begin_tick()
    monkeypatch.setattr(world.lockstep, 'begin_tick', begin)
    return looks


def test_a_node_that_never_sleeps_is_waited_for_5_s(world, wall):
    world.tick(('a', MOVE))
    world.nodes.never_sleeps = 'a'
    begin = wall.now
    world.tick()
    # two steps of the wall clock
    assert wall.now - begin == pytest.approx(5.0, abs=0.03)
    assert world.reports == [('a', 'did not become idle within 5 s')]


def test_each_node_that_never_sleeps_is_waited_for_5_s(world, wall):
    forget, begin, times = world.nodes.forget, wall.now, []

    def forget_one(name):
        times.append(wall.now - begin)
        forget(name)
        world.nodes.never_sleeps = {'a': 'b'}.get(name)
    world.nodes.forget = forget_one
    world.nodes.never_sleeps = 'a'
    world.tick()
    assert [name for name, _ in world.reports] == ['a', 'b'] and not world.nodes.drivers
    # two steps of the wall clock for each
    assert times == pytest.approx([5.0, 10.0], abs=0.05)


def test_a_node_that_sleeps_within_5_s_stays_in_step(world, wall):
    world.tick(('a', MOVE))
    world.lockstep.begin_tick()
    world.nodes.work = [lambda: None] * 490 + [lambda: world.send('a', FASTER)]
    world.lockstep.end_tick()
    assert not world.reports and world.applied == [(1, MOVE), (2, FASTER)]


def test_a_node_that_a_released_driver_was_is_not_observed_any_more(world):
    world.tick(('a', MOVE), ('b', MOVE))
    world.send_unprompted()
    world.tick(('b', MOVE))
    assert world.nodes.drivers == {'b'}


def test_nodes_at_rest_are_checked_before_every_tick(world, looks):
    for _ in range(2):
        world.tick()
    assert looks == [0, 1]


def test_what_a_node_has_done_is_noted_before_the_check_and_compared_after_it(world, monkeypatch):
    calls = []
    for name in 'note', 'awake', 'mark':
        monkeypatch.setattr(world.nodes, name, lambda *_, name=name: calls.append(name))
    world.lockstep.begin_tick()
    assert calls == ['note', 'awake', 'mark']
    # a command that arrives during the check: it is applied, and the next check is made in the same order
    calls.clear()
    world.nodes.mark = lambda _: len(calls) < 3 and world.send('a', MOVE)
    world.lockstep.begin_tick()
    assert calls == ['note', 'awake', 'note', 'awake'] and world.applied == [(1, MOVE)]


def test_the_nodes_are_not_checked_before_a_tick_if_all_of_them_drive(world, looks):
    world.tick(('a', MOVE), ('b', MOVE))
    looks.clear()
    world.tick(('a', MOVE), ('b', STOP))
    assert not looks
    world.tick(('a', MOVE))
    assert looks == [2]     # b is at rest, and may have woken by itself


def test_the_nodes_are_checked_before_a_tick_while_one_connects(world, looks):
    world.tick()
    looks.clear()
    world.nodes.connecting = lambda: True
    world.nodes.work = [lambda: world.send('a', MOVE)]
    world.tick()
    assert looks and world.applied == [(1, MOVE)]


def test_what_a_node_sends_after_a_command_between_two_ticks_belongs_to_the_same_tick(world, wall):
    world.tick()
    # the last check is recent, so the first command is noticed only when the tick begins
    world.send('a', MOVE)
    world.nodes.work = [lambda: world.send('b', FASTER)]
    world.tick()
    assert world.applied == [(1, MOVE), (1, FASTER)]


def test_who_is_at_rest_is_marked_again_after_a_command_between_two_ticks(world, wall):
    marked = []
    world.nodes.mark = marked.append
    world.tick()
    marked.clear()
    world.send('a', MOVE)
    world.tick()
    assert marked == [{'a', 'b'}] * 2


def test_the_ticks_of_the_last_second_are_stored(world, wall):
    for _ in range(13):
        world.tick()
        wall.now += 0.25
    assert list(world.lockstep.ticks) == [102.0, 102.25, 102.5, 102.75, 103.0]


@pytest.mark.parametrize('ticks, checks', [(24, 1), (25, 0)])
def test_a_driver_is_steady_after_25_ticks_with_one_command_each(world, wall, ticks, checks):
    world.nodes.drivers = {'a'}
    world.drive(*range(ticks), until=ticks)
    before = world.nodes.looks
    world.lockstep.begin_tick()
    world.send('a', MOVE)
    world.lockstep.end_tick()
    assert world.nodes.looks - before == checks


@pytest.mark.parametrize('sees', [True, False])
def test_a_waiting_thread_is_notified_of_each_command(world, monkeypatch, sees):
    world.nodes.sees = lambda _: sees
    notified = []
    monkeypatch.setattr(world.lockstep.changed, 'notify', lambda: notified.append(1))
    for number in range(3):
        world.send('a', STOP)
        assert len(notified) == number + 1
        world.tick()


def test_a_driver_that_has_disconnected_is_forgotten_when_another_one_connects(world):
    world.tick(('a', MOVE))
    world.tick(('a', STOP))
    world.nodes.connected = lambda connection: connection != 'a'
    world.tick(('b', MOVE))
    assert [driver.name for driver in world.lockstep.drivers.values()] == ['b']


def test_another_driver_that_connects_does_not_change_a_stream(world):
    world.nodes.woken = {'a'}
    begin = world.drive(1, *range(3, 40, 3))
    world.tick(('b', STOP))
    world.tick(('a', STOP))
    world.tick()
    # the first command was late, so the stop takes effect a tick later
    assert world.applied[-1] == (begin + 42, STOP)


def test_a_flood_that_was_dropped_does_not_follow_later():
    world = World()
    world.nodes.sees = lambda _: False
    for command in [MOVE] * 500 + [STOP]:
        world.send('a', command)
    for _ in range(3):
        world.tick()
    assert world.applied == [(1, STOP)] and len(world.reports) == 1
    world.send('a', FASTER)
    assert world.applied[-1] == (3, FASTER)     # immediately


@pytest.mark.parametrize('number', [1, 2])
def test_two_commands_without_a_tick_may_be_a_busy_machine(world, number):
    world.tick(('a', MOVE))
    for _ in range(number):
        world.send('a', MOVE)
    world.tick()
    world.tick(('a', MOVE))
    assert not world.reports
