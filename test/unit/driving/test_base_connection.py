"""A driving script waits for the live subscribers of its commands, and notices one that no longer follows them."""
from contextlib import nullcontext
import socket
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.driving import base_connection as module
from rbx1_nav.driving.base_connection import ANSWER_TIMEOUT, ASK_PERIOD, PERIOD


class World:
    """A master, its nodes, which are connected to the publisher of /r/cmd_vel, and two clocks (s)."""

    def __init__(self, monkeypatch):
        self.time, self.ros_time, self.wallclock, self.slept, self.failure = 100.0, 7, False, 0, None
        self.publishers = {'/r/odom': ['/base'], '/r/cmd_vel': ['/page'], '/odom': ['/other'], '/clock': []}
        self.subscribers = {'/r/cmd_vel': ['/base', '/recorder', '/page'], '/cmd_vel': ['/other']}
        self.answers = {'/base': (2, 'old'), '/recorder': (None, ''), '/page': (None, '')}
        self.logged, self.failed, self.threads, self.asked = [], [], [], []
        self.connections = [SimpleNamespace(endpoint_id=name, stat_num_msg=3) for name in ('/recorder', '/base')]
        self.publisher = SimpleNamespace(
            resolved_name='/r/cmd_vel', impl=SimpleNamespace(connections=list(self.connections), seq=5))
        for name, value in dict(
                time=SimpleNamespace(monotonic=lambda: self.time, sleep=self.sleep), sleep=self.sleep, call=self.call,
                Server=lambda uri, *_: nullcontext(uri), ask_refusals=self.ask,
                threading=SimpleNamespace(Thread=lambda target, args, daemon: SimpleNamespace(
                    start=lambda: self.threads.append((target, args, daemon))))).items():
            monkeypatch.setattr(module, name, value)
        monkeypatch.setattr(rospy, 'get_rostime', lambda: rospy.Time(self.ros_time))
        monkeypatch.setattr(rospy, 'logwarn', lambda text, *values: self.logged.append(text % values))
        monkeypatch.setattr(rospy, 'logwarn_throttle', lambda _, text: self.logged.append(text))
        monkeypatch.setattr(rospy.rostime, 'is_wallclock', lambda: self.wallclock)

    def sleep(self, seconds):
        self.time, self.slept = self.time + seconds, self.slept + 1
        if self.slept == 3 and self.failure:
            self.answers['/base'] = self.failure

    def call(self, _, method, *args):
        return {'getSystemState': lambda: [list(self.publishers.items()), list(self.subscribers.items()), []],
                'getTopicTypes': lambda: [[name, 'nav_msgs/Odometry' if 'odom' in name else 'other']
                                          for name in self.publishers],
                'lookupNode': lambda name: name}[method](*args)

    def ask(self, server, exact):
        address = getattr(server, 'enter_result', server)
        self.asked.append((address, exact))
        answer = self.answers.get(address, OSError('dead'))
        if isinstance(answer, Exception):
            self.time, self.ros_time = self.time + 0.4, self.ros_time + 1
            raise answer
        return answer

    def wait(self):
        found = module.wait_for_listeners(self.publisher, -1.0, True, self.failed.append)
        for each in found.all:
            each.answered = self.time       # the clock of the class is the real one
        return found


@pytest.fixture(name='world')
def fixture_world(monkeypatch):
    return World(monkeypatch)


def test_bases_are_called_and_others_are_only_waited_for(world):
    found = world.wait()
    assert [(each.name, each.is_base, each.keeps_time, each.refused) for each in found.all] == [
        ('/base', True, False, 2), ('/recorder', False, False, 0)]
    assert world.threads == [(found.called[0].ask, (True, world.failed.append), True)]
    assert not (world.logged or found.on_clock_of_base or found.problem())
    world.publishers['/r/odom'], world.publishers['/clock'] = [], ['/recorder']
    found = world.wait()
    assert found.called == found.all and found.on_clock_of_base and len(world.threads) == 3
    assert 'none of the subscribers (/base, /recorder) publishes odometry' in world.logged[0]


@pytest.mark.parametrize('change, text', [
    (lambda world: world.publisher.impl.connections.pop(0), 'for /recorder to connect to /r/cmd_vel'),
    (lambda world: world.answers.update({'/base': socket.timeout()}), 'for /base to answer'),
    (lambda world: setattr(world, 'ros_time', 0), 'for the time on /clock'),
    (lambda world: setattr(world, 'publishers', None), 'for the master to list the subscribers of /r/cmd_vel'),
    (lambda world: world.subscribers.clear(), 'for a base that subscribes to /r/cmd_vel'),
    (lambda world: world.subscribers.pop('/r/cmd_vel'), 'Bases exist in other namespaces: /. To drive one, set '
     'ROS_NAMESPACE=/'),
    (lambda world: world.publishers['/clock'].append('/recorder') or setattr(world, 'wallclock', True),
     'but /recorder publishes /clock: start this node again')])
def test_what_is_missing_is_named(world, change, text):
    change(world)
    with pytest.raises(rospy.ROSException, match=f'{text}$'):
        world.wait()
    assert len(world.logged) == ('master' in text)


def test_a_dead_node_is_called_once_and_a_silent_base_again(world):
    search = module._Search('/r/cmd_vel', False)
    world.subscribers['/r/cmd_vel'].append('/dead')
    world.publishers['/r/odom'].append('/recorder')
    world.answers['/base'] = world.answers['/dead'] = socket.timeout()
    for _ in range(2):
        search.update()
        assert search.silent == ['/base'] and list(search.found) == ['/recorder'] and search.others == ['/']
        search.update()         # too early
        world.time += PERIOD
    assert [world.asked.count((name, False)) for name in ('/base', '/recorder', '/dead')] == [2, 2, 1]
    assert len(world.logged) == 1 and world.logged[0].startswith('/dead is registered as a subscriber')


@pytest.mark.parametrize('failure, text', [
    ((3, 'docked'), 'did not follow a command: docked'), (ConnectionRefusedError(), 'disconnected'),
    (OSError(), 'has stopped responding')])
def test_a_base_is_called_until_it_has_a_problem(world, failure, text):
    found, world.failure = world.wait(), failure
    base, = found.called
    base.ask(True, world.failed.append)
    assert world.failed == [found.problem()] == [f'/r/cmd_vel: /base {text}: expected it to follow the commands until '
                                                 'the end of the run']
    assert base.answered == pytest.approx(100 + ASK_PERIOD * (3 if text == 'did not follow a command: docked' else 2))
    # the fifth call ends 1.6 s after the last answer, the fourth one 0.8 s
    # and the pause after it is not waited for
    assert world.slept == (4 if text == 'has stopped responding' else 3)
    base.finished = True
    base.ask(True, world.failed.append)
    assert len(world.failed) == 1
    base.error, base.keeps_time = '', True      # a clock that advances is alive
    world.answers['/base'] = OSError()
    base.call('/base', True)
    assert not base.problem() and base.answered == pytest.approx(world.time - 0.4)
    world.publisher.impl.connections.pop()
    assert '/base disconnected: ' in base.problem()


def test_commands_that_were_not_sent_are_counted(world):
    found = world.wait()        # of 5 commands, 2 were published before the connection
    recorder, base = world.connections
    world.publisher.impl.seq, base.stat_num_msg, recorder.stat_num_msg = 25, 23, 19
    found.finish(99.0)
    assert world.logged == ['/r/cmd_vel: 4 of 23 commands to /recorder were lost'] and len(world.asked) == 3
    assert world.time == pytest.approx(100 + ANSWER_TIMEOUT, abs=0.03)      # a step of the wait is 0.02 s
    world.publisher.impl.connections.remove(recorder)
    found.finish(100.0)         # the time of the last answer: the base is asked again
    assert world.logged[1:] == ['/r/cmd_vel: /recorder disconnected during the run'] and len(world.asked) == 4
    found.all[0].keeps_time, base.stat_num_msg = True, 22
    with pytest.raises(rospy.ROSException, match='1 of 23 commands to /base were lost'):
        found.finish(99.0)
    world.answers['/base'] = 3, 'docked'
    with pytest.raises(rospy.ROSException, match='docked'):
        found.finish(world.time)
    found.release()
    assert all(each.finished for each in found.all)
