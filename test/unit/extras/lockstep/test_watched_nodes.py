"""Watch finds the nodes that drive directly or through others, and those that are starting, and watches them."""
import socket
import subprocess
import threading
import time
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.lockstep import watched_nodes
from rbx1_nav.extras.lockstep.sockets import peer_process
from rbx1_nav.extras.lockstep.watched_nodes import STARTING, Watch, sources_of
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
        self.children, self.greetings = [], []
        self.clock = SimpleNamespace(connections=[], resolved_name='/clock')
        self.commands = SimpleNamespace(connections=[], resolved_name='/cmd_vel', type='geometry_msgs/Twist')
        self.watch = Watch(SimpleNamespace(impl=self.clock), lambda: self.greetings)
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


class Master:
    """Answers the calls of a Watch."""

    def __init__(self, monkeypatch, publishers, subscribers=(), types=()):
        self.publishers, self.subscribers, self.types = publishers, subscribers, types
        self.time = self.asked = 0
        monkeypatch.setattr(watched_nodes, 'call', self.call)

    def call(self, _, question):
        if question == 'getTopicTypes':
            return self.types
        self.asked += 1
        return self.publishers, self.subscribers, []

    def work(self):
        """Use as much CPU time as an answer takes."""
        self.time += 1_000_000

    def process(self):
        """Return its Process."""
        return SimpleNamespace(cpu_time=lambda: self.time, activity=lambda _: 0, sleeps=lambda: True,
                               has_pollers=lambda: False)


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
    Master(monkeypatch, PUBLISHERS, SUBSCRIBERS)
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
    world.watch.master = Master(monkeypatch, publishers).process()
    world.watch.master_time = -1_000_000
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.0)
    monkeypatch.setattr(watched_nodes, 'START_SLEEP', 0.0)
    monkeypatch.setattr(watched_nodes, 'DRIVER_SLEEP', 1000.0)
    world.listen(world.connect('/node', 'time.sleep(1000)'))
    if waits:
        wait_for(lambda: world.watch.awake() == STARTING)
        assert {world.watch.awake() for _ in range(20)} == {STARTING}
        world.watch.has_started('/node')
    world.settle()
    assert not world.watch.starting


def test_a_publisher_that_registers_while_the_clock_runs_is_waited_for(world, monkeypatch):
    """The master has worked, so it is asked."""
    master = Master(monkeypatch, [])
    world.watch.master = master.process()
    world.listen(world.connect('/node'), world.connect('/other'))
    world.settle()
    master.publishers = [['/cmd_vel', ['/node', '/gone']]]
    assert world.watch.awake() is None and master.asked == 0
    master.work()
    wait_for(lambda: world.watch.awake() == STARTING)
    assert {world.watch.awake() for _ in range(20)} == {STARTING} and master.asked == 1
    world.commands.connections = [world.clock.connections[0]]
    world.settle()
    assert world.watch.drivers == {'/node'}
    # one that was killed, and is still registered
    world.listen(world.clock.connections[1])
    world.commands.connections = []
    world.settle()


def test_a_publisher_that_never_connects_is_waited_for_only_once(world, monkeypatch):
    master = Master(monkeypatch, [['/cmd_vel', ['/node']]])
    world.watch.master = master.process()
    monkeypatch.setattr(watched_nodes, 'CONNECT_TIME', 0.5)
    world.listen(world.connect('/node'))
    master.work()
    wait_for(lambda: world.watch.awake() == STARTING)
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
    world.watch.master = master.process()
    world.listen(*[world.connect(name) for name in ('/relay', '/driver', '/recorder')])
    master.work()
    world.settle()
    assert world.watch.sources == ['/driver', '/relay'] and set(world.watch.processes) == {'/relay', '/driver'}
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
    wait_for(lambda: world.watch.awake() == '/computing')
    connect('/joint_command')
    monkeypatch.setattr(watched_nodes, 'AWAKE_TIME', 1000.0)
    thread = threading.Thread(target=connect, args=['/cmd_vel'], daemon=True)
    thread.start()
    wait_for(lambda: world.watch.joining)
    assert {world.watch.awake() for _ in range(20)} == {'/computing'} and connected == ['/joint_command']
    world.drive()
    world.settle()
    thread.join()
    assert connected == ['/joint_command', '/cmd_vel'] and not world.watch.joining
    # a node that never sleeps
    monkeypatch.setattr(watched_nodes, 'AWAKE_TIME', 0.0)
    connect('/cmd_vel')


def test_a_publisher_whose_subscription_to_the_clock_is_not_connected_yet_is_not_connected(world, monkeypatch):
    master = Master(monkeypatch, [['/cmd_vel', ['/node']]], [['/clock', ['/node', '/recorder']]])
    world.watch.master = master.process()
    world.watch.joining[threading.Event()] = 0.0
    master.work()
    assert {world.watch.awake() for _ in range(20)} == {STARTING} and not any(map(threading.Event.is_set,
                                                                                 world.watch.joining))
    world.listen(world.connect('/node'))
    wait_for(lambda: world.watch.awake() == STARTING and all(map(threading.Event.is_set, world.watch.joining)))


def test_a_new_subscriber_is_greeted_when_all_nodes_are_asleep(world):
    greeted = []
    world.watch.new_greetings = lambda: [world.greetings.pop()] if world.greetings else []
    world.greetings = [lambda: greeted.append(world.watch.listeners.keys())]
    world.drive(world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.awake() == '/computing')
    assert not greeted
    world.drive(world.connect('/driver'))
    wait_for(lambda: not world.watch.awake() and greeted)
    assert len(greeted) == 1


def test_a_subscriber_that_comes_during_a_check_is_greeted_after_the_next_one(world, monkeypatch):
    """Whether it is asleep is not known."""
    greeted = []

    def check(*_):
        world.greetings = [lambda: greeted.append('/new')]
    monkeypatch.setattr(watched_nodes, 'awake', check)
    world.watch.new_greetings = lambda: world.greetings
    assert world.watch.awake() is None and not greeted
    # it has connected after the update
    old, new = world.connect('/old'), world.connect('/new')
    world.listen(old)
    world.clock.connections = [old, new]
    assert world.watch.receivers(world.clock) == [old]
    assert world.watch.awake() is not None and greeted == ['/new']
    assert world.watch.receivers(world.clock) == [old, new]
    other = SimpleNamespace(connections=[new])
    assert world.watch.receivers(other) == [new]


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
