"""Watch finds the nodes that drive directly or through others, and those that are starting, and watches them."""
import socket
import subprocess
import time
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.lockstep import watched_nodes
from rbx1_nav.extras.lockstep.sockets import peer_process
from rbx1_nav.extras.lockstep.watched_nodes import Watch, sources_of
from waiting import wait_for

PUBLISHERS = [['/cmd_vel', ['/mux']], ['/cmd_vel_raw', ['/driver', '/teleop']], ['/odom', ['/base']],
              ['/goal', ['/rviz']]]
SUBSCRIBERS = [['/cmd_vel', ['/base']], ['/cmd_vel_raw', ['/mux']], ['/odom', ['/driver', '/rviz']]]


def test_sources_of_commands():
    assert sources_of(['/cmd_vel'], PUBLISHERS, SUBSCRIBERS) == ['/mux', '/driver', '/teleop', '/base']
    assert sources_of(['/goal'], PUBLISHERS, SUBSCRIBERS) == ['/rviz', '/base', '/mux', '/driver', '/teleop']
    assert sources_of(['/nothing'], PUBLISHERS, SUBSCRIBERS) == []
    assert sources_of(['/cmd_vel', '/goal'], PUBLISHERS, SUBSCRIBERS)[:2] == ['/mux', '/rviz']


class World:
    """A Watch without a master; child processes act as nodes."""

    def __init__(self):
        self.server = socket.socket()
        self.server.bind(('127.0.0.1', 0))
        self.server.listen()
        self.children = []
        self.clock = SimpleNamespace(connections=[])
        self.commands = SimpleNamespace(connections=[], resolved_name='/cmd_vel')
        self.watch = Watch(SimpleNamespace(impl=self.clock), lambda: False)
        self.watch.add(SimpleNamespace(impl=self.commands))

    def connect(self, name, code='sys.stdin.read()'):
        """Return a connection to a node with this name that runs Python code."""
        code = 'import socket, sys, time; s = socket.create_connection(("127.0.0.1", %d))\n%s' % (
            self.server.getsockname()[1], code)
        self.children.append(subprocess.Popen(['/usr/bin/python3', '-c', code], stdin=subprocess.PIPE))
        return SimpleNamespace(header={'callerid': name}, endpoint_id=name, socket=self.server.accept()[0])

    def drive(self, *connections):
        """Set the connections to the publishers of commands, which also subscribe to /clock."""
        self.clock.connections = self.commands.connections = list(connections)
        self.watch.update()

    def listen(self, *connections):
        """Set the connections to the subscribers of /clock."""
        self.clock.connections = list(connections)
        self.watch.update()

    def settle(self):
        """Wait until all nodes are asleep."""
        wait_for(lambda: not self.watch.awake())


@pytest.fixture(name='world')
def make_world(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')      # nothing listens there
    # the process of pytest itself may have no other thread
    monkeypatch.setattr(watched_nodes, 'own_process', lambda: SimpleNamespace(
        activity=lambda _: 0, sleeps=lambda: True, has_pollers=lambda: False))
    # other tests on this machine use the network
    monkeypatch.setattr(watched_nodes, 'Network', lambda: SimpleNamespace(busy=lambda: False))
    world = World()
    yield world
    for process in world.watch.processes.values():
        process.close()
    for child in world.children:
        child.kill()
        child.communicate()
    world.server.close()


def test_a_driver_is_watched_while_it_is_connected(world):
    assert world.watch.awake() is None
    world.drive(world.connect('/driver'))
    assert world.watch.drivers == {'/driver'}
    world.settle()
    world.drive(*world.commands.connections, world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.awake() == '/computing')
    world.drive()
    assert not world.watch.drivers and not world.watch.processes and world.watch.awake() is None


def test_what_keeps_a_node_from_being_in_step(world, monkeypatch):
    world.drive(world.connect('/driver'))
    assert world.watch.obstacle('/driver') is None and world.watch.drivers == {'/driver'}
    world.listen()
    assert world.watch.obstacle('/driver') == 'does not subscribe to /clock' and not world.watch.drivers
    monkeypatch.setattr(watched_nodes, 'peer_process', lambda _: None)
    world.drive(world.connect('/other'))
    assert not world.watch.drivers and 'is not visible' in world.watch.obstacle('/other')


def test_the_order_of_subscribers(world, monkeypatch):
    """Nodes that are not watched; sources, the farthest first; drivers."""
    monkeypatch.setattr(watched_nodes, 'call', lambda *_: (PUBLISHERS, SUBSCRIBERS, []))
    connections = [world.connect(name) for name in ('/recorder', '/mux', '/driver', '/teleop')]
    recorder, mux, driver, teleop = connections
    world.listen(*connections)
    world.settle()
    world.commands.connections = [mux]
    world.watch.update()
    assert world.watch.sources == ['/base', '/teleop', '/driver', '/mux']
    assert set(world.watch.processes) == {'/mux', '/driver', '/teleop'} and world.watch.drivers == {'/mux'}
    assert world.watch.groups(connections) == [([recorder], False), ([teleop], True), ([driver], True), ([mux], True)]
    assert world.watch.groups([recorder]) == [([recorder], False)]


def test_a_node_that_starts_is_watched_until_it_waits(world):
    node = world.connect('/node', 'sys.stdin.readline()\nwhile True: pass')
    world.listen(node)
    assert '/node' in world.watch.processes
    world.settle()
    world.watch.update()
    assert not world.watch.starting
    # it computes later
    world.children[-1].stdin.write(b'\n')
    world.children[-1].stdin.flush()
    time.sleep(0.05)
    assert world.watch.awake() is None


@pytest.mark.parametrize('publishers, waits', [([['/cmd_vel', ['/node']]], True), ([['/cmd_vel', ['/other']]], False)])
def test_a_driver_that_sleeps_by_the_wall_clock_before_its_first_command_is_waited_for(
        world, monkeypatch, publishers, waits):
    monkeypatch.setattr(watched_nodes, 'call', lambda *_: (publishers, [], []))
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    monkeypatch.setattr(watched_nodes, 'START_SLEEP', 0.0)
    monkeypatch.setattr(watched_nodes, 'DRIVER_SLEEP', 1000.0)
    world.listen(world.connect('/node', 'time.sleep(1000)'))
    if waits:
        wait_for(lambda: world.watch.processes['/node'].main_sleeps_briefly())
        assert {world.watch.awake() for _ in range(20)} == {'/node'}
        world.watch.has_started('/node')
    world.settle()
    assert not world.watch.starting


def test_a_new_subscriber_is_greeted_when_all_nodes_are_asleep(world):
    greeted = []
    world.watch.greet = lambda: greeted.append('node') or len(greeted) == 1
    world.drive(world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.awake() == '/computing')
    assert not greeted
    world.drive(world.connect('/driver'))
    assert wait_for(world.watch.awake) is not None     # it may have been woken
    world.settle()
    assert len(greeted) == 2


@pytest.mark.skipif(not socket.has_dualstack_ipv6(), reason='no IPv6')
def test_a_peer_that_listens_for_both_families_is_found():
    """rosnodejs, Java and Go do; the kernel lists its connection with an IPv6 address."""
    code = ('import socket, sys; s = socket.create_server(("", 0), family=socket.AF_INET6, dualstack_ipv6=True); '
            'print(s.getsockname()[1], flush=True); c, _ = s.accept(); sys.stdin.read()')
    child = subprocess.Popen(['/usr/bin/python3', '-c', code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with child, socket.create_connection(('127.0.0.1', int(child.stdout.readline()))) as connection:
        process = wait_for(lambda: peer_process(connection))
        assert process.folder == f'/proc/{child.pid}/task/'
        process.close()
        child.stdin.close()


def test_a_driver_that_is_forgotten_holds_the_clock_no_more(world):
    """There is no update() in between: Lockstep forgets a node while it waits for it, and then looks again."""
    world.drive(world.connect('/driver', 'while True: pass'))
    wait_for(lambda: world.watch.awake() == '/driver')
    assert world.watch.forget('/driver')
    assert world.watch.awake() is None and not world.watch.drivers
    # until it connects again
    world.drive(world.connect('/driver'))
    assert world.watch.drivers == {'/driver'}


def test_the_files_of_a_node_that_starts_and_then_drives_are_closed(world):
    """It is known by its connection for the clock, and then by that for the commands."""
    node = world.connect('/node')
    world.listen(node)
    starting = world.watch.processes['/node']
    with node.socket.dup() as commands:
        world.drive(SimpleNamespace(header=node.header, endpoint_id='/node', socket=commands))
        assert world.watch.drivers == {'/node'} and world.watch.processes['/node'] is not starting
    assert starting.threads == {}
