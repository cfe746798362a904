"""Steady drivers, which have sent a command at each tick, and first commands that are late."""
from lockstep_world import World

MOVE, FASTER, STOP = (0.2, 0.0), (0.3, 0.0), (0.0, 0.0)


def test_a_driver_at_every_tick_spares_the_look(world):
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    before = world.nodes.looks
    for _ in range(10):
        world.lockstep.begin_tick()
        world.send('a', MOVE)
        world.lockstep.end_tick()
    assert world.nodes.looks == before
    # the driver stops sending: a check of the nodes shows this
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
    begin = world.drive(1, *range(3, 40, 3))    # the driver woke at tick 0
    world.tick(('a', STOP))     # not at a time of its rate, as when a timer expires
    world.tick()
    assert world.applied[0] == (begin + 1, MOVE) and world.applied[-1] == (begin + 41, STOP)
    # the next stream is independent
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
    """The command took effect at the previous tick, so nothing is missing."""
    world.nodes.woken = {'a'}
    world.drive()
    world.send('a', MOVE)
    begin = world.drive(*range(1, 40, 3))
    world.tick(('a', STOP))
    assert world.applied[-1] == (begin + 40, STOP) and not world.reports


def test_a_driver_that_comes_while_another_is_looked_for_is_seen():
    """The first command arrives while nodes.sees() searches for the process of the other driver."""
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
    """Otherwise each later tick would wait ANSWER_TIME for it."""
    world = World()
    world.nodes.drivers = {'a'}
    world.drive(*range(40))
    world.tick()
    waits = []
    monkeypatch.setattr(world.lockstep.changed, 'wait_for', lambda *_: waits.append(1))
    world.tick()
    assert not waits
