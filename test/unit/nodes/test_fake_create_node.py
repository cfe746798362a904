"""fake_create.py is a robot on a terminal: it publishes the truth and each command, and waits for its client."""
import time

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.node import life
from loaded_nodes import load, without_master


class Terminal:
    """A pseudo-terminal with a client."""

    device, link, baud = '/dev/pts/7', '/tmp/robot', 57600

    def __init__(self, *_):
        self.incoming, self.clients, self.plugged, self.waits = [], [True, False], True, 0

    def read(self):
        return self.incoming.pop(0) if self.incoming else b''

    def write(self, data):
        pass

    def wait(self, duration):
        self.waits += 1
        if self.waits > 100:
            life.end_requested.set()

    def has_client(self):
        return self.clients.pop(0)

    def unplug(self):
        self.plugged = False


@pytest.fixture(name='node')
def fixture_node(monkeypatch):
    """The module; node.terminal is the one that main() opens, node.now the time in ns."""
    node = load('fake_create')
    node.topics, node.log = without_master(monkeypatch, seed=3)
    node.terminal, node.now = Terminal(), 5 * SECOND

    def pass_time():
        node.now += SECOND // 100
        return node.now
    monkeypatch.setattr(node, 'PseudoTerminal', lambda link: node.terminal)
    monkeypatch.setattr(time, 'monotonic_ns', pass_time)
    monkeypatch.setattr(life, 'sleep', lambda _: None)
    life.end_requested.clear()
    life.init_node('fake_create', '', node.PARAMETERS)
    yield node
    life.end_requested.clear()


def test_a_command_is_followed_and_published(node):
    node.terminal.incoming = [protocol.command('start') + protocol.command('safe') + protocol.command('drive_direct',
                                                                                                    0, 200, 0, 100)]
    assert node.main() == 0
    sent = [message.split() for message in node.topics['line'].sent]
    assert [data for _, data in sent] == ['80', '83', protocol.command('drive_direct', 0, 200, 0, 100).hex()]
    assert node.topics['ground_truth'].sent[0].child_frame_id == 'base_footprint'
    assert node.topics['~pull_cable'].callback and not node.terminal.plugged and node.terminal.clients == []


def test_the_line_that_a_script_waits_for(node):
    node.main()
    line, = [text for level, text in node.log if level == 'info']
    assert line.startswith('Emulated create') and 'serial port /dev/pts/7, linked as /tmp/robot; seed:=3 ' in line
    node.terminal = Terminal()
    node.terminal.link = ''
    life.end_requested.clear()
    node.main()
    assert 'serial port /dev/pts/7; seed:=3 ' in node.log[-1][1]


def test_nothing_is_published_without_subscribers(node):
    robot = node.make_robot(node.now)
    fake = node.FakeCreate(robot, node.terminal)
    for name in 'line', 'ground_truth':
        node.topics[name].connections = 0
    node.terminal.incoming = [protocol.command('start')]
    for _ in range(20):
        fake.step()
    assert not node.terminal.incoming
    assert not node.topics['line'].sent and not node.topics['ground_truth'].sent


def test_the_line_has_the_rate_of_the_client(node):
    robot = node.make_robot(node.now)
    fake = node.FakeCreate(robot, node.terminal)
    for baud, mode in (19200, protocol.OFF), (57600, protocol.PASSIVE):
        node.terminal.baud, node.terminal.incoming = baud, [protocol.command('start')]
        for _ in range(20):
            fake.step()
        assert robot.mode == mode       # the robot has 57600 baud
    node.terminal.baud = None       # no client
    fake.step()
    assert robot.line.host_baud == 57600
