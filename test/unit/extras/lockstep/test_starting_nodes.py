"""The clock waits for nodes that are starting, in an order that does not depend on chance."""
import threading

import pytest

from rbx1_nav.extras.lockstep import watched_nodes
from waiting import wait_for
from watch_world import Master, worlds

STARTING = '/node, which is starting'


@pytest.fixture(name='world')
def make_world(monkeypatch):
    yield from worlds(monkeypatch)


@pytest.mark.parametrize('publishers, waits', [([['/cmd_vel', ['/node']]], True), ([['/cmd_vel', ['/other']]], False)])
def test_a_driver_that_sleeps_by_the_wall_clock_before_its_first_command_is_waited_for(
        world, monkeypatch, publishers, waits):
    world.watch.master = Master(monkeypatch, publishers)
    world.watch.master_time = -1_000_000
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    monkeypatch.setattr(watched_nodes, 'START_SLEEP', 0.0)
    monkeypatch.setattr(watched_nodes, 'DRIVER_SLEEP', 1000.0)
    world.listen(world.connect('/node', 'time.sleep(1000)'))
    if waits:
        wait_for(lambda: world.watch.waits_for() == STARTING)
        assert {world.watch.waits_for() for _ in range(20)} == {STARTING}
        world.watch.starting.pop('/node')
    world.settle()
    assert not world.watch.starting


def test_a_driver_that_sleeps_by_the_wall_clock_for_long_is_named(world, monkeypatch):
    Master(monkeypatch, [['/cmd_vel', ['/node', '/other']]])
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    monkeypatch.setattr(watched_nodes, 'START_SLEEP', 0.0)
    monkeypatch.setattr(watched_nodes, 'DRIVER_SLEEP', 0.5)
    named = []
    monkeypatch.setattr(watched_nodes.rospy, 'logwarn', lambda text, name, _: named.append((name, text[3:30])))
    world.listen(*[world.connect(name, 'time.sleep(1000)') for name in ('/node', '/clock_listener')],
                 world.connect('/other'))
    world.settle()
    assert named == [('/node', 'waits by the wall clock bef')]


def test_a_driver_whose_main_thread_spins_is_not_waited_for(world, monkeypatch):
    """rospy.spin() sleeps by the wall clock again and again; the callbacks need the time."""
    Master(monkeypatch, [['/cmd_vel', ['/node']]])
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    monkeypatch.setattr(watched_nodes, 'DRIVER_SLEEP', 1000.0)
    world.listen(world.connect('/node', 'while True: time.sleep(0.5)'))
    world.settle()
    assert not world.watch.starting


def test_a_node_that_wakes_after_the_check_is_still_waited_for(world, monkeypatch):
    def check(*checked):
        found = find_awake(*checked)
        if not found:
            node.socket.send(b'\n')
            wait_for(lambda: not world.watch.processes['/node'].naps())
        return found
    find_awake = watched_nodes.find_awake
    monkeypatch.setattr(watched_nodes, 'find_awake', check)
    monkeypatch.setattr(watched_nodes, 'START_SLEEP', 1000.0)
    world.watch.find_sources()
    node = world.connect('/node', 'import select; select.select([s], [], []); sys.stdin.read()')
    world.listen(node)
    world.watch.news.clear()
    assert wait_for(lambda: (name := world.watch.waits_for()) != '/node' and name) == STARTING
    world.settle()


def test_a_publisher_that_registers_while_the_clock_runs_is_waited_for(world, monkeypatch):
    """The master has worked, so it is asked."""
    master = Master(monkeypatch, [])
    world.watch.master = master
    world.listen(world.connect('/node'), world.connect('/other'))
    world.settle()
    master.publishers = [['/cmd_vel', ['/node', '/gone']]]
    before = master.asked
    assert world.watch.waits_for() is None and master.asked == before
    master.work()
    wait_for(lambda: world.watch.waits_for() == STARTING)
    assert {world.watch.waits_for() for _ in range(20)} == {STARTING} and master.asked > before
    world.commands.connections = [world.clock.connections[0]]
    world.settle()
    assert world.watch.drivers == {'/node'}
    # one that was killed, and is still registered
    world.listen(world.clock.connections[1])
    world.commands.connections = []
    world.settle()


def test_a_publisher_that_registers_while_the_master_is_asked_is_waited_for(world, monkeypatch):
    """The answer does not name it, but its subscription to the clock is new."""
    master = Master(monkeypatch, [])
    world.watch.master = master

    def call(*question):
        answer = master.call(*question)
        if question[1] == 'getSystemState':
            master.publishers = [['/cmd_vel', ['/node']]]
            master.work()
        return answer
    monkeypatch.setattr(watched_nodes, 'call', call)
    master.work()
    world.settle()
    assert world.watch.graph.registered == set()
    world.listen(world.connect('/node'))
    wait_for(lambda: world.watch.waits_for() == STARTING)


def test_a_publisher_that_never_connects_is_waited_for_only_once(world, monkeypatch):
    master = Master(monkeypatch, [['/cmd_vel', ['/node']]])
    world.watch.master = master
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.5)
    world.listen(world.connect('/node'))
    master.work()
    wait_for(lambda: world.watch.waits_for() == STARTING)
    world.settle()
    master.work()
    world.settle()
    assert master.asked > 1


def test_a_relay_is_watched_before_it_publishes(world, monkeypatch):
    """So are the nodes that publish to it. When it advertises, its first command is lost, and it is named."""
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    warnings = []
    monkeypatch.setattr(watched_nodes.rospy, 'logwarn', lambda text, *values: warnings.append(text % values))
    publishers, subscribers = [['/relayed', ['/driver']]], [['/relayed', ['/relay']]]
    master = Master(monkeypatch, publishers, subscribers, [['/relayed', 'geometry_msgs/Twist']])
    world.watch.master = master
    world.listen(*[world.connect(name) for name in ('/relay', '/driver', '/recorder')])
    master.work()
    world.settle()
    assert world.watch.graph.sources == ['/driver', '/relay'] and set(world.watch.processes) == {'/relay', '/driver'}
    publishers.append(['/cmd_vel', ['/relay']])
    master.work()
    world.settle()
    assert [text[:35] for text in warnings] == ['/relay has advertised /cmd_vel only']
    # no command has depended on this one
    assert not world.watch.forget('/recorder') and world.watch.forget('/driver')


def test_a_publisher_of_commands_is_connected_when_all_nodes_are_asleep(world, monkeypatch):
    def connect(topic):
        with world.watch.connecting(topic):
            connected.append(topic)
    connected = []
    world.drive(world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.waits_for() == '/computing')
    connect('/joint_command')
    monkeypatch.setattr(watched_nodes, 'AWAKE_TIME', 1000.0)
    thread = threading.Thread(target=connect, args=['/cmd_vel'], daemon=True)
    thread.start()
    wait_for(lambda: world.watch.joining)
    assert {world.watch.waits_for() for _ in range(20)} == {'/computing'} and connected == ['/joint_command']
    world.drive()
    world.settle()
    thread.join()
    assert connected == ['/joint_command', '/cmd_vel'] and not world.watch.joining
    # a node that never sleeps
    monkeypatch.setattr(watched_nodes, 'AWAKE_TIME', 0.0)
    connect('/cmd_vel')


def test_a_publisher_whose_subscription_to_the_clock_is_not_connected_yet_is_not_connected(world, monkeypatch):
    master = Master(monkeypatch, [['/cmd_vel', ['/node']]], [['/clock', ['/node', '/recorder']]])
    world.watch.master = master
    permission = watched_nodes.Permission()
    world.watch.joining.append(permission)
    master.work()
    wait_for(lambda: world.watch.waits_for() == STARTING)
    assert {world.watch.waits_for() for _ in range(20)} == {STARTING} and not permission.is_set()
    world.listen(world.connect('/node'))
    wait_for(lambda: (world.watch.waits_for() or '').endswith('which is starting') and permission.is_set())


def test_a_new_subscriber_is_greeted_when_all_nodes_are_asleep(world):
    greeted = []
    world.watch.greetings += [(True, lambda: greeted.append('state')), (False, lambda: greeted.append('time'))]
    world.drive(world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.waits_for() == '/computing')
    assert not greeted
    world.drive(world.connect('/driver'))
    wait_for(lambda: not world.watch.waits_for() and greeted)
    assert greeted == ['time', 'state']


def test_a_subscriber_that_comes_during_a_check_is_greeted_after_the_next_one(world, monkeypatch):
    """Whether it is asleep is not known."""
    greeted = []

    def check(*_):
        if not greeted:
            world.watch.greetings[:] = [(False, lambda: greeted.append('/new'))]
    monkeypatch.setattr(watched_nodes, 'find_awake', check)
    assert world.watch.waits_for() is None and not greeted
    # it has connected after the update
    old, new = world.connect('/old'), world.connect('/new')
    world.listen(old)
    world.clock.connections = [old, new]
    assert world.watch.groups(world.clock) == [([old], True)]
    wait_for(lambda: world.watch.waits_for() and greeted)
    receivers = [each for group, _ in world.watch.groups(world.clock) for each in group]
    assert len(receivers) == 2 and new in receivers
