"""Child processes that act as nodes, and the Watch that observes them."""
import socket
import subprocess
from types import SimpleNamespace

from rbx1_nav.extras.lockstep import watched_nodes
from rbx1_nav.extras.lockstep.watched_nodes import Watch
from waiting import wait_for


class World:
    """A Watch without a master; child processes act as nodes."""

    def __init__(self):
        self.server = socket.socket()
        self.server.bind(('127.0.0.1', 0))
        self.server.listen()
        self.children = []
        self.clock = SimpleNamespace(connections=[], resolved_name='/clock')
        self.commands = SimpleNamespace(connections=[], resolved_name='/cmd_vel', type='geometry_msgs/Twist')
        self.watch = Watch(SimpleNamespace(impl=self.clock))
        self.watch.commands.append(self.commands)

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
        wait_for(lambda: not self.watch.waits_for())


class Asleep:
    """A Process that is asleep."""

    def activity(self, _=False):
        return 0

    def sleeps(self):
        return True

    def has_pollers(self):
        return False


class Master(Asleep):
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

    def activity(self, _=False):
        return self.time


def worlds(monkeypatch):
    """Yield one World, for a fixture."""
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')      # nothing listens there
    # the process of pytest itself may have no other thread
    monkeypatch.setattr(watched_nodes, 'own_process', Asleep)
    # other tests on this machine use the network
    monkeypatch.setattr(watched_nodes, 'Network', lambda: SimpleNamespace(busy=lambda: False))
    world = World()
    yield world
    for child in world.children:
        child.kill()
        child.communicate()
    world.server.close()
