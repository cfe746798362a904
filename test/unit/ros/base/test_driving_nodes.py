"""DrivingNodes finds the nodes that drive directly or through others, and watches them."""
import socket
import subprocess
import time
from types import SimpleNamespace

import pytest

from rbx1_nav.ros.base import driving_nodes
from rbx1_nav.ros.base.driving_nodes import DrivingNodes, upstream_of

PUBLISHERS = [['/cmd_vel', ['/mux']], ['/cmd_vel_raw', ['/driver', '/teleop']], ['/odom', ['/base']],
              ['/goal', ['/rviz']]]
SUBSCRIBERS = [['/cmd_vel', ['/base']], ['/cmd_vel_raw', ['/mux']], ['/odom', ['/driver', '/rviz']]]


def test_nodes_upstream():
    assert upstream_of('/cmd_vel', PUBLISHERS, SUBSCRIBERS) == {'/mux', '/driver', '/teleop', '/base'}
    assert upstream_of('/goal', PUBLISHERS, SUBSCRIBERS) == {'/rviz', '/base', '/mux', '/driver', '/teleop'}
    assert upstream_of('/nothing', PUBLISHERS, SUBSCRIBERS) == set()


def test_who_only_listens_is_not_upstream():
    assert upstream_of('/cmd_vel', [['/cmd_vel', ['/driver']], ['/odom', ['/base']]],
                       [['/cmd_vel', ['/base', '/recorder']], ['/odom', ['/recorder']]]) == {'/driver'}


def test_a_loop_of_nodes():
    assert upstream_of('/a', [['/a', ['/x']], ['/b', ['/y']]], [['/a', ['/y']], ['/b', ['/x']]]) == {'/x', '/y'}
    assert upstream_of('/a', [['/a', ['/x']]], [['/a', ['/x']]]) == {'/x'}


def test_a_long_chain_of_nodes():
    publishers = [['/%d' % number, ['/node%d' % number]] for number in range(50)]
    subscribers = [['/%d' % (number + 1), ['/node%d' % number]] for number in range(50)]
    assert upstream_of('/0', publishers, subscribers) == {'/node%d' % number for number in range(50)}


def wait_for(condition):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end, 'timed out'
        time.sleep(0.002)


class World:
    """DrivingNodes without a master; child processes act as nodes."""

    def __init__(self):
        self.server = socket.socket()
        self.server.bind(('127.0.0.1', 0))
        self.server.listen()
        self.children = []
        self.drivers = []
        self.listeners = []
        self.nodes = DrivingNodes('/cmd_vel', lambda: self.drivers, lambda: self.listeners)

    def connect(self, name, code='sys.stdin.read()'):
        """Return a connection to a node with this name that runs Python code."""
        code = 'import socket, sys, time; s = socket.create_connection(("127.0.0.1", %d))\n%s' % (
            self.server.getsockname()[1], code)
        self.children.append(subprocess.Popen(['/usr/bin/python3', '-c', code], stdin=subprocess.PIPE))
        return SimpleNamespace(header={'callerid': name}, endpoint_id=name, socket=self.server.accept()[0])


@pytest.fixture(name='world')
def make_world(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')      # nothing listens there
    monkeypatch.setattr(DrivingNodes, '_look_upstream', lambda self: None)
    # the process of pytest itself may have no other thread
    monkeypatch.setattr(driving_nodes, 'own_process', lambda: SimpleNamespace(cpu_time=lambda: 0, sleeps=lambda: True))
    world = World()
    yield world
    for process in world.nodes.processes.values():
        process.close()
    for connection in world.drivers + world.listeners:
        connection.socket.close()
    for child in world.children:
        child.kill()
        child.communicate()
    world.server.close()


def test_a_driver_is_watched_while_it_is_connected(world):
    assert not world.nodes.sees('/driver') and world.nodes.awake() is None
    world.drivers = [world.connect('/driver')]
    assert world.nodes.sees('/driver') and world.nodes.drivers == {'/driver'}
    wait_for(lambda: not world.nodes.awake())
    computing = world.connect('/computing', 'while True: pass')
    world.drivers = world.drivers + [computing]
    world.nodes.update()
    wait_for(lambda: world.nodes.awake() == '/computing')
    gone, world.drivers = world.drivers, []
    world.nodes.update()
    assert not world.nodes.drivers and not world.nodes.processes and world.nodes.awake() is None
    for connection in gone:
        connection.socket.close()


def test_a_connection_that_its_publisher_refuses_is_no_driver(world):
    # rospy keeps only the error until it closes the connection
    refused = type('Connection', (), dict(vars(world.connect('/driver')), header={'error': 'is not a publisher'}))()
    world.drivers = [refused]
    assert not world.nodes.sees('/driver') and not world.nodes.drivers
    assert world.nodes.connecting()     # the node may try again


def test_an_unseen_driver_is_not_watched(world, monkeypatch):
    monkeypatch.setattr(driving_nodes, 'peer_process', lambda _: None)
    world.drivers = [world.connect('/driver')]
    assert not world.nodes.sees('/driver') and not world.nodes.drivers


def test_a_listener_to_the_clock_is_watched_if_it_is_upstream(world, monkeypatch):
    monkeypatch.setattr(driving_nodes, 'call', lambda *_: (PUBLISHERS, SUBSCRIBERS, []))
    world.drivers = [world.connect('/mux')]
    world.listeners = [world.connect('/driver'), world.connect('/other')]
    world.nodes.update()
    assert set(world.nodes.processes) == {'/mux'}
    assert world.nodes.update_upstream()
    world.nodes.update()
    assert not world.nodes.update_upstream()
    assert set(world.nodes.processes) == {'/mux', '/driver'} and world.nodes.drivers == {'/mux'}
    assert world.nodes.on_clock('/driver') and not world.nodes.on_clock('/mux')


def test_a_master_that_does_not_answer_excuses_nobody(world):
    assert not world.nodes.update_upstream()


def test_a_driver_that_is_forgotten_is_watched_again_after_it_has_connected_again(world):
    first = world.connect('/driver')
    world.drivers = [first]
    world.nodes.update()
    world.nodes.forget('/driver')
    assert not world.nodes.sees('/driver') and not world.nodes.drivers
    world.drivers = [world.connect('/driver')]
    assert world.nodes.sees('/driver')
    first.socket.close()


def test_a_driver_that_has_been_started_again_is_watched(world):
    first = world.connect('/driver')
    world.drivers = [first]
    world.nodes.update()
    world.drivers = [world.connect('/driver', 'while True: pass')]
    world.nodes.update()
    assert world.nodes.processes['/driver'].folder == '/proc/%d/task/' % world.children[1].pid
    first.socket.close()


def test_each_connection_has_its_own_header(world):
    world.drivers = [world.connect('/driver'), world.connect('/driver')]
    header = world.drivers[0].header
    assert world.nodes.connected(header)
    world.drivers.pop(0).socket.close()
    assert not world.nodes.connected(header)


def test_a_driver_that_is_forgotten_holds_the_clock_no_more(world):
    """There is no update() in between: Lockstep forgets a node while it waits for it, and then looks again."""
    world.drivers = [world.connect('/driver', 'while True: pass')]
    world.nodes.update()
    wait_for(lambda: world.nodes.awake() == '/driver')
    world.nodes.forget('/driver')
    assert world.nodes.awake() is None


def test_a_driver_that_was_not_seen_may_be_seen_later(world, monkeypatch):
    """For example, a node was released while it ran on another machine, and then restarted on this one."""
    with monkeypatch.context() as other_machine:
        other_machine.setattr(driving_nodes, 'peer_process', lambda _: None)
        first = world.connect('/driver')
        world.drivers = [first]
        assert not world.nodes.sees('/driver')
        world.nodes.forget('/driver')
    world.drivers = [world.connect('/driver')]
    assert world.nodes.sees('/driver')
    first.socket.close()


def test_new_upstream_nodes_that_the_other_thread_has_found_excuse_a_command(world, monkeypatch):
    monkeypatch.setattr(driving_nodes, 'call', lambda *_: (PUBLISHERS, SUBSCRIBERS, []))
    world.drivers = [world.connect('/mux')]
    world.listeners = [world.connect('/driver')]
    world.nodes.update()
    world.nodes.update_upstream()       # in _look_upstream()
    assert '/driver' not in world.nodes.processes
    assert world.nodes.update_upstream()
