"""A Drive block waits for a base, and stops the robot at its end; how it was left decides the exit status."""
from math import pi
import os
from threading import Event
from types import SimpleNamespace

from geometry_msgs.msg import Twist
import pytest
import rospy

from rbx1_nav.driving import script, stopping
from rbx1_nav.driving.script import Drive
from rbx1_nav.driving.stopping import Commands
from rbx1_nav.node.parameters import number

CMD_VEL = SimpleNamespace(data_class=Twist, resolved_name='/cmd_vel')


class World:
    """The listeners of a script, and what it does, in `log`; `problem`: an error of the listeners."""

    called = [SimpleNamespace(name='/base'), SimpleNamespace(name='/twin')]

    def __init__(self, monkeypatch):
        self.log, self.problem, self.shutdown = [], None, False
        write = self.log.append
        for module, values in {
                script: dict(
                    _results=[], _failed=[], _interrupted=[], _started=[os.getpid()], _functions_called=Event(),
                    _script_ended=Event(), shutdown_wanted=Event(), end_requested=Event(), end=write,
                    param={'wait_timeout': 12, 'goal_angle': 13, 'linear_speed': 90}.get, wait_for_listeners=self.find),
                script.rate: dict(wait_for_tick=lambda: write('tick')), script.os: dict(_exit=write),
                script.life: dict(wait_for_shutdown=lambda: write('unregistered')),
                stopping: dict(halt=lambda: write('halt'), stop_robots=lambda: write('stop'),
                               is_shutdown=lambda: self.shutdown),
                rospy: dict.fromkeys(['loginfo', 'logwarn'], lambda text, *values: write(text % values))}.items():
            for name, value in values.items():
                monkeypatch.setattr(module, name, value)

    def find(self, *arguments):
        assert arguments == (CMD_VEL, 12, True, stopping.fail)
        self.finish('found')
        return self

    def finish(self, moved):
        self.log.append(moved)
        if self.problem:
            raise self.problem

    def release(self):
        self.log.append('released')

    def leave(self, error=None, problem=None):
        """Leave a block with an error. Return what is done at its end."""
        with Drive(CMD_VEL):
            assert Commands.current.listeners is self
            assert self.log[-3:] == ['found', 'tick', 'Connected to /base, /twin']
            self.log.clear()
            self.problem, Commands.current.moved = problem, 7.5
            if error:
                raise error


@pytest.fixture(name='world')
def fixture_world(monkeypatch):
    return World(monkeypatch)


def test_a_completed_block_is_logged_at_the_end_of_the_script(world):
    world.leave()
    assert world.log == ['halt', 'stop', 7.5, 'released'] and Commands.current is None
    script._finish('')
    assert world.log[4].startswith('Done: commanded 0.00 m') and script._functions_called.is_set()
    script._exit()      # Python itself sets the exit status
    assert world.log[5:] == ['unregistered'] and script.shutdown_wanted.is_set() and script._script_ended.is_set()
    script._interrupted.append(None)
    script._exit()
    assert world.log[6:] == ['unregistered', 0]
    script._started[:] = [1]        # a child process
    script._exit()
    assert len(world.log) == 8


def test_a_base_that_did_not_follow_fails_the_script(world):
    world.leave()
    with pytest.raises(rospy.ROSException, match='lost'):
        world.leave(problem=rospy.ROSException('lost'))
    script._finish('')      # the result of the first block is not logged
    script._exit()
    assert world.log == ['halt', 'stop', 7.5, 'released', 'unregistered', script.life.exit_status[0]]


@pytest.mark.parametrize('error, shutdown, ends, failed', [
    (ValueError(), False, [], 1), (ValueError(), True, [], 0), (SystemExit(3), False, [3], 0),
    (SystemExit('text'), False, [1], 0), (SystemExit(), False, [0], 0)])
def test_a_block_that_is_left_early(world, error, shutdown, ends, failed):
    world.shutdown = shutdown
    with pytest.raises(type(error)):
        world.leave(error)
    assert world.log == ['stop', 'released', *ends] and len(script._failed) == failed and Commands.current is None


def test_a_block_that_cannot_begin(world):
    world.problem = rospy.ROSException('Timed out')
    for world.shutdown in True, False:
        with pytest.raises(rospy.ROSException, match='Timed out'):
            world.leave()
    assert script._failed == [world.problem]
    script._started.clear()
    for publisher, text in (CMD_VEL, 'rospy.init_node'), ('cmd_vel', 'a rospy.Publisher of geometry_msgs/Twist'):
        with pytest.raises(rospy.ROSException, match=f'expected {text}'):
            Drive(publisher).__enter__()


def test_a_node_starts_with_a_check_of_its_angles_and_prepares_its_end(world, monkeypatch):
    started = []

    def init_node(name, usage, parameters, on_signal, **options):
        started.append((name, usage, len(parameters), options))
        on_signal(2)
    for module, name, value in (
            (script.life, 'init_node', init_node), (stopping, 'signal_shutdown', world.log.append),
            (rospy.core, 'add_client_shutdown_hook', world.log.append), (script, '_started', []),
            (rospy.core, 'add_preshutdown_hook', world.log.append),
            (script.threading, 'Thread', lambda target, daemon: SimpleNamespace(start=target))):
        monkeypatch.setattr(module, name, value)
    script.shutdown_wanted.set()
    script.start_node('node', 'usage', [number('goal_angle', pi, 'rad', ''), number('linear_speed', 0.2, 'm/s', '')],
                      anonymous=True)
    assert world.log == [stopping.stop_robots, script._finish, 'requested', 130, '/unnamed/goal_angle: 13: 2.1 turns, '
                         'because the unit is radians. For 13 degrees: _goal_angle:=0.226893']
    monkeypatch.setitem(globals(), '__doc__', 'Usage.\nParameters:\n    ~linear_speed  speed (m/s; default: 0.2)')
    script.init_node('node', ['argument'], True, log_level=1)
    assert started == [('node', 'usage', 3, {'anonymous': True}),
                       ('node', 'Usage.', 2, {'argv': ['argument'], 'anonymous': True, 'log_level': 1})]
    assert len(world.log) == 6 and script._started == [os.getpid()]


@pytest.mark.parametrize('name, function', [
    ('init_node', script.init_node), ('is_shutdown', stopping.is_shutdown), ('sleep', script.rate.sleep),
    ('signal_shutdown', stopping.signal_shutdown), ('Rate', script.rate.Rate)])
def test_importing_it_replaces_functions_of_rospy(name, function):
    modules = [module for module in (rospy.client, rospy.core, rospy.timer) if hasattr(module, name)]
    assert {getattr(module, name) for module in (rospy, *modules)} == {function}
    assert rospy.Publisher.publish is stopping.publish and script.sys.excepthook is script._report
