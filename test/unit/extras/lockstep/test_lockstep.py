"""The clock stays in step with the nodes that drive by it, and names those that do not."""
from types import SimpleNamespace

from geometry_msgs.msg import Twist
import pytest

from rbx1_nav.extras.lockstep import lockstep
from lockstep_world import FASTER, MOVE, STOP, Connection, World

TURN = SimpleNamespace(linear=0.0, angular=1.0)
UNPROMPTED = 'sends commands that no tick of /clock has prompted'


@pytest.fixture(name='world')
def make_world(monkeypatch):
    return World(monkeypatch)


def test_a_command_takes_effect_at_the_tick_that_it_answers(world):
    for period in (1, 2, 3, 5):
        begin = world.lockstep.tick + 1
        for tick in range(40):
            world.tick(*[('a', MOVE)] * (tick % period == 0))
        world.tick(('a', STOP))
        assert world.applied == [(begin + tick, MOVE) for tick in range(0, 40, period)] + [(begin + 40, STOP)]
        world.applied.clear()
    assert not world.reports


def test_the_order_of_a_tick(world):
    """Topic by topic, and source by source; commands in the order of the names."""
    events = []

    def node(name, *commands):
        def work():
            events.append(f'{name} works')
            for command in commands:
                world.send(*command)

        def on_message():
            events.append(f'{name} receives')
            world.processes.work.append(work)
        return Connection(name, on_message)
    recorder = Connection('recorder', lambda: events.append('recorder receives'))
    world.lockstep.begin()
    world.deliver(node('s'), node('a', ('b', FASTER), ('a', MOVE)), recorder, message=Twist())
    world.deliver(node('a', ('a', STOP)))
    world.lockstep.apply()
    assert events == ['recorder receives', 's receives', 's works', 'a receives', 'a works', 'a receives', 'a works']
    assert world.applied == [(1, MOVE), (1, FASTER), (1, STOP)]


def test_a_command_between_two_ticks_belongs_to_the_tick_before(world):
    world.tick()
    world.send('a', MOVE)
    world.lockstep.begin()
    world.lockstep.apply()
    assert world.applied == [(2, MOVE)]
    # also if it comes while the tick begins
    world.processes.work = [lambda: world.send('a', STOP)]
    world.lockstep.begin()
    world.lockstep.apply()
    assert world.applied[1:] == [(3, STOP)]


def test_a_node_that_never_sleeps_is_given_up(world):
    world.tick(('a', MOVE))
    world.processes.never_sleeps = 'a'
    world.tick(('a', FASTER))
    assert world.reports == [('a', 'did not become idle within 5 s')] and world.lines == ['The clock waits for a']
    assert len(world.tests) > 2    # for threads that poll; again and again in a long wait
    assert world.applied == [(1, MOVE), (2, FASTER)]
    # it is not judged again
    world.processes.forgotten = {'b': None}
    world.processes.obstacles = {'b': 'is not visible'}
    world.tick(*[('b', MOVE)] * 9)
    world.tick(*[('b', FASTER)] * 9)
    assert len(world.reports) == 1
    # no word about this node, which messages keep busy, nor about a node that only takes long to start
    world.processes.never_sleeps = 'base'
    world.tick()
    world.processes.never_sleeps = None
    world.tick()
    world.processes.never_sleeps = 'starting'
    world.tick()
    assert len(world.reports) == 1


def test_nobody_is_waited_for_at_the_end(world):
    world.processes.never_sleeps = 'a'
    world.lockstep.ended = lambda: True
    world.tick(('a', MOVE))
    world.tick()
    assert world.lockstep.tick == 2 and not world.reports and not world.sleeps


def test_a_driver_that_sends_while_the_clock_is_held_is_named(world):
    world.drive(2)
    world.send('a', MOVE)
    world.tick()
    assert world.reports == [('a', UNPROMPTED)]
    for _ in range(3):      # once
        world.send('a', TURN)
        world.tick()
    assert len(world.reports) == 1 and len(world.applied) == 6


def test_the_first_motion_and_every_stop_need_no_tick(world):
    world.tick()
    world.send('a', STOP)
    world.tick()
    for _ in range(3):      # a Rate that was made before the node slept
        world.send('a', MOVE)
    world.drive(1)
    world.send('a', STOP)
    world.tick()
    assert not world.reports
    # the driver behind a relay, which is starting, and waits by the wall clock
    world.processes.starting = {'c': None}
    world.send('a', MOVE)
    world.tick()
    world.tick(('a', STOP))
    assert not world.reports
    world.processes.starting = {}
    world.send('a', MOVE)       # a key, perhaps
    world.tick()
    assert world.reports == [('a', UNPROMPTED)]


def test_a_driver_whose_commands_come_from_a_new_source_is_not_named(world):
    world.drive(2)
    world.processes.new_source = True
    world.send('a', MOVE)
    world.tick()
    assert not world.reports


def test_a_driver_that_never_lets_the_tick_end_is_named(world):
    world.drive(1)
    world.tick(*[('a', MOVE)] * lockstep.COMMANDS)
    world.tick(*[('a', STOP)] * 10)
    world.tick(*[('a', MOVE)] * lockstep.COMMANDS, *[('b', MOVE)] * lockstep.COMMANDS)
    assert not world.reports
    world.tick(*[('a', MOVE)] * (lockstep.COMMANDS + 1))
    assert world.reports == [('a', 'sends more than 3 commands at once')]


def test_a_driver_that_does_not_let_the_first_tick_end_is_named(world):
    world.tick(*[('b', MOVE)] * lockstep.COMMANDS, *[('a', MOVE)] * (lockstep.COMMANDS + 1), ('a', STOP))
    assert world.reports == [('a', 'sends more than 3 commands at once')]


def test_a_driver_that_cannot_be_in_step_is_named_if_it_drives(world):
    world.processes.obstacles = {'a': 'does not subscribe to /clock'}
    world.tick(('a', STOP), ('a', MOVE))
    assert not world.reports
    world.drive(1)
    assert world.reports == [('a', 'does not subscribe to /clock')]


def test_a_report_that_raises_ends_the_tick(monkeypatch, world):
    def strict(name, reason):
        raise RuntimeError(name + reason)
    world.lockstep.report = strict
    world.drive(2)
    world.send('a', MOVE)
    with pytest.raises(RuntimeError):
        world.tick()
