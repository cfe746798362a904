"""Watch finds the nodes that drive directly or through others, and those that are starting, and watches them."""
import os
import socket
import subprocess
import time
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.lockstep import watched_nodes
from rbx1_nav.extras.lockstep.command_sources import sources_of
from rbx1_nav.extras.lockstep.sockets import peer_process
from waiting import wait_for
from watch_world import Master, worlds

PUBLISHERS = [['/cmd_vel', ['/mux']], ['/cmd_vel_raw', ['/driver', '/teleop']], ['/odom', ['/base']],
              ['/goal', ['/rviz']]]
SUBSCRIBERS = [['/cmd_vel', ['/base']], ['/cmd_vel_raw', ['/mux']], ['/odom', ['/driver', '/rviz']]]


def test_sources_of_commands():
    assert sources_of(['/cmd_vel'], PUBLISHERS, SUBSCRIBERS) == ['/mux', '/driver', '/teleop', '/base']
    assert sources_of(['/goal'], PUBLISHERS, SUBSCRIBERS) == ['/rviz', '/base', '/mux', '/driver', '/teleop']
    assert sources_of(['/nothing'], PUBLISHERS, SUBSCRIBERS) == []
    assert sources_of(['/cmd_vel', '/goal'], PUBLISHERS, SUBSCRIBERS)[:2] == ['/mux', '/rviz']


@pytest.fixture(name='world')
def make_world(monkeypatch):
    yield from worlds(monkeypatch)


def test_a_driver_is_watched_while_it_is_connected(world):
    assert world.watch.waits_for() is None
    world.drive(world.connect('/driver'))
    assert world.watch.drivers == {'/driver'}
    world.settle()
    world.drive(*world.commands.connections, world.connect('/computing', 'while True: pass'))
    wait_for(lambda: world.watch.waits_for() == '/computing')
    world.drive()
    assert not world.watch.drivers and not world.watch.processes
    world.settle()


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
    assert world.watch.graph.sources == ['/base', '/teleop', '/driver', '/mux']
    assert set(world.watch.processes) == {'/mux', '/driver', '/teleop'} and world.watch.drivers == {'/mux'}
    assert world.watch.groups(SimpleNamespace(connections=connections)) == [
        ([recorder], False), ([teleop], True), ([driver], True), ([mux], True)]
    assert world.watch.groups(SimpleNamespace(connections=[])) == []


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
    assert world.watch.waits_for() is None


@pytest.mark.skipif(not socket.has_dualstack_ipv6(), reason='no IPv6')
def test_a_peer_that_listens_for_both_families_is_found():
    """rosnodejs, Java and Go do; the kernel lists its connection with an IPv6 address."""
    code = ('import socket, sys; s = socket.create_server(("", 0), family=socket.AF_INET6, dualstack_ipv6=True); '
            'print(s.getsockname()[1], flush=True); c, _ = s.accept(); sys.stdin.read()')
    child = subprocess.Popen(['/usr/bin/python3', '-c', code], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    with child, socket.create_connection(('127.0.0.1', int(child.stdout.readline()))) as connection:
        process = wait_for(lambda: peer_process(connection))
        assert process.folder == f'/proc/{child.pid}/task/'
        child.stdin.close()


def test_a_driver_that_is_forgotten_holds_the_clock_no_more(world):
    """There is no update() in between: Lockstep forgets a node while it waits for it, and then looks again."""
    world.drive(world.connect('/driver', 'while True: pass'))
    wait_for(lambda: world.watch.waits_for() == '/driver')
    assert world.watch.forget('/driver')
    world.settle()
    assert not world.watch.drivers
    # until it connects again
    world.drive(world.connect('/driver'))
    assert world.watch.drivers == {'/driver'}


def test_the_files_of_a_node_that_starts_and_then_drives_are_closed(world):
    """It is known by its connection for the clock, and then by that for the commands."""
    def files():
        return [link for file in os.listdir('/proc/self/fd') if f'/proc/{child.pid}/task' in (
            link := os.path.realpath(f'/proc/self/fd/{file}'))]
    node = world.connect('/node')
    child = world.children[-1]
    world.listen(node)
    starting = world.watch.processes['/node']
    before = len(files())
    with node.socket.dup() as commands:
        world.drive(SimpleNamespace(header=node.header, endpoint_id='/node', socket=commands))
        assert world.watch.drivers == {'/node'} and world.watch.processes['/node'] is not starting
    del starting
    assert len(files()) == before == 3
