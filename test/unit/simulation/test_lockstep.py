"""The clock stays in step with the nodes that drive by it."""
import pytest

from rbx1_nav.simulation import lockstep
from lockstep_world import World

MOVE, FASTER, STOP = (0.2, 0.0), (0.3, 0.0), (0.0, 0.0)


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
    # another event may wake a node after that: the next tick begins only when it sleeps again
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
    assert [name for name, _ in world.reports] == ['a'] and 'did not become idle' in world.reports[0][1]
    world.send('a', FASTER)
    assert world.applied[-1] == (4, FASTER)     # immediately


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
    assert world.applied[-1] == (3, FASTER)     # immediately


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
