"""What a base logs and reports about a command; no thread changes a base or a joint while another one reads it."""
from math import inf
from threading import Lock

from diagnostic_updater import DiagnosticStatusWrapper
from geometry_msgs.msg import Twist, Vector3
import pytest
import rospy
from std_msgs.msg import Float64

from rbx1_nav.base import command_subscriber as module
from rbx1_nav.base.clocks import Clock
from rbx1_nav.base.command_gate import CommandGate, RefusedCommand
from rbx1_nav.base.command_subscriber import VelocityCommands
from rbx1_nav.base.robot_parameters import Joint, Limits
from rbx1_nav.base.refusals import Refusals
from rbx1_nav.base.units import SECOND
from fake_topics import Topic, replace_topics


class Time(Clock):
    """A clock that the test sets."""

    time = 5 * SECOND

    def now(self):
        return self.time


class World:
    """A base that follows commands within 0.5 m/s and 3 rad/s, and what is logged."""

    def __init__(self, monkeypatch, wheel_limit=inf):
        self.lines, self.taken, self.refusal = [], [], None
        for name in 'logwarn_throttle', 'logerr_throttle':
            monkeypatch.setattr(rospy, name, lambda _, text: self.lines.append(text))
        self.lock, self.gate, self.refusals = Lock(), CommandGate(Limits(0.5, 3.0), SECOND // 4), Refusals()
        self.clock = Time(50)
        self.commands = VelocityCommands(self, self.gate, self.clock, self.lock, '/r/', self.refusals, wheel_limit)

    def command(self, now, linear, angular, others, sender):
        assert self.lock.locked()       # another thread moves the base
        self.taken.append((now, linear, angular, others, sender))
        if self.refusal:
            raise RefusedCommand(self.refusal)
        return self.gate.command(now, linear, angular, others)

    def send(self, *values, sender='/driver'):
        twist = Twist(Vector3(*values[:3]), Vector3(*values[3:]))
        twist._connection_header = {'callerid': sender}
        self.commands.on_twist(twist)

    def statuses(self):
        status = DiagnosticStatusWrapper()
        self.commands.diagnose(status)
        return {each.key: each.value for each in status.values}


def test_a_command_reaches_the_base(monkeypatch):
    world = World(monkeypatch)
    world.send(0.1, 0.0, 0.0, 0.0, 0.0, -0.2)
    assert world.taken == [(5 * SECOND, 0.1, -0.2, (0.0, 0.0, 0.0, 0.0), '/driver')] and not world.lines
    world.clock.time += SECOND // 5
    assert world.statuses() == {
        'dX': '0.1', 'dR': '-0.2', 'Age of the last command (s)': '0.200', 'Rejected commands': '0',
        'Refused commands': '0', 'Clamped commands': '0', 'Dropped commands': '0', 'Contradictory commands': '0'}
    world.commands.log_timeout()
    assert world.lines == ['/r/cmd_vel: no command for 0.25 s: stopped'] and world.refusals._all['/driver'][0] == 1


@pytest.mark.parametrize('wheel_limit, expected', [
    (inf, '0.5 m/s, 3 rad/s'), (0.45, '0.5 m/s, 3 rad/s, 0.45 m/s at each wheel')])
def test_a_clamped_command_is_reported_with_each_limit_and_its_unit(monkeypatch, wheel_limit, expected):
    world = World(monkeypatch, wheel_limit)
    world.send(0.7, 0.0, 0.0, 0.0, 0.0, 0.2)
    assert world.lines == [f'/r/cmd_vel: 0.7 m/s, 0.2 rad/s: expected at most {expected}; clamped']
    assert world.refusals.count == 0 and world.refusals._all['/driver'][0] == 1
    assert world.statuses()['Clamped commands'] == '1' and world.statuses()['dX'] == '0.5'


def test_velocities_that_are_ignored_are_named(monkeypatch):
    world = World(monkeypatch)
    world.send(0.1, 2.0, 3.0, 4.0, 5.0, 0.2)
    assert len(world.lines) == 1 and '= (2.0, 3.0, 4.0, 5.0): a differential drive' in world.lines[0]


def test_a_command_that_is_not_followed(monkeypatch):
    world = World(monkeypatch)
    world.send(float('nan'), 0.0, 0.0, 0.0, 0.0, 0.2)
    assert world.lines == ['/r/cmd_vel: nan: expected finite numbers of at most 1e+06; rejected, base stopped']
    world.refusal = 'the robot is docked'
    world.send(0.1, 0.0, 0.0, 0.0, 0.0, 0.2, sender='/other')
    assert world.lines[1:] == ['/r/cmd_vel: refused a command from /other: the robot is docked']
    assert world.refusals._refused['/other'] == (1, 'the robot is docked') and world.refusals.count == 2
    assert world.statuses()['Rejected commands'] == '1'


def test_two_senders_contradict_each_other(monkeypatch):
    world, connections = World(monkeypatch), []
    monkeypatch.setattr(world.commands, 'connections', lambda: connections)
    senders = [{'callerid': name} for name in ('/a', '/b')]
    connections += [type('Connection', (), {'header': header}) for header in senders]
    for number in range(4):
        twist = Twist(Vector3(0.1 + number % 2, 0.0, 0.0), Vector3())
        twist._connection_header = senders[number % 2]
        world.commands.on_twist(twist)
    assert 'contradictory commands: /a sends 0.1 m/s, 0 rad/s, /b sends 1.1 m/s' in ''.join(world.lines)
    status = DiagnosticStatusWrapper()
    world.commands.diagnose(status)
    assert status.message.startswith('Contradictory commands: /b sends 1.1') and world.statuses()[
        'Contradictory commands'] == '2'


def test_a_goal_of_a_joint(monkeypatch):
    world, lock = World(monkeypatch), Lock()

    class Guarded(Joint):
        def command(self, goal):
            assert lock.locked()        # another thread moves the joint
            super().command(goal)
    joint = Guarded('arm', -1.0, 2.0, 0.5)
    module._on_goal(Float64(1.5), (joint, lock))
    assert joint.goal == 1.5
    module._on_goal(Float64(inf), (joint, lock))
    assert joint.goal == 1.5 and world.lines == ['/arm/command: inf: expected a finite angle in rad; rejected']
    replace_topics(monkeypatch)
    assert [each.name for each in module.subscribe_joints([joint], lock, '/r/')] == ['/r/arm/command']


def test_it_subscribes_once_and_its_clock_watches_the_senders(monkeypatch):
    world, watched = World(monkeypatch), []
    replace_topics(monkeypatch)
    monkeypatch.setattr(Topic, 'unregister', lambda topic: watched.append(topic.name), raising=False)
    world.clock.watch = world.clock.unwatch = watched.append
    world.commands.close()
    for _ in range(2):
        world.commands.subscribe()
    topic = world.commands.subscriber
    world.commands.close()
    assert watched == [topic, topic, '/r/cmd_vel']
