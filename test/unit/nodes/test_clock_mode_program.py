"""clock_mode.py prints the value that a launch file sets, unless a live base uses the other clock."""
import socket
import xmlrpc.client

import pytest

from loaded_nodes import load, run_program

BASES = ['/robot1/arbotix', '/robot2/arbotix']


@pytest.fixture(name='mode')
def fixture_mode(monkeypatch, tmp_path):
    """Runs clock_mode.py; mode.simulated: /use_sim_time or None; mode.answers: of the nodes; mode.alive: the master."""
    module = load('clock_mode')

    class Master:
        def __init__(self, _):
            if not mode.alive:
                raise OSError()

        def hasParam(self, _):
            return mode.simulated is not None

        def getParam(self, _):
            return mode.simulated

        def getSystemState(self):
            return ([['/robot1/odom', BASES[:1]], ['/odom', [BASES[1], '/recorder']], ['/scan', ['/page']]],
                    [['/robot1/cmd_vel', BASES], ['/cmd_vel', ['/page']], ['/cmd_vel2', ['/recorder']]], [])

        def getTopicTypes(self):
            return [['/robot1/odom', 'nav_msgs/Odometry'], ['/odom', 'nav_msgs/Odometry'], ['/scan', 'LaserScan']]

        def lookupNode(self, name):
            return name

    class Node:
        def __init__(self, name):
            self.name = name

        def getPid(self, _):
            assert socket.getdefaulttimeout() == 2
            if isinstance(mode.answers.get(self.name), Exception):
                raise mode.answers[self.name]
            return [1, '', 7]

    def mode(*arguments):
        return run_program(monkeypatch, tmp_path, module, *arguments)
    mode.simulated, mode.answers, mode.alive = None, {}, True
    monkeypatch.setattr(module.rosgraph, 'Master', Master)
    monkeypatch.setattr(xmlrpc.client, 'ServerProxy', Node)
    yield mode
    socket.setdefaulttimeout(None)


@pytest.mark.parametrize('before, wanted, text', [
    (True, 'False', 'false'), (None, 'true', 'true'), (False, 'TRUE', 'true')])
def test_a_base_on_the_other_clock(mode, before, wanted, text):
    mode.simulated = before
    status, out, err = mode(wanted, '/arbotix')
    assert (status, out) == (1, '') and f' {", ".join(BASES)} runs: ' in err and f'/use_sim_time: {text}: ' in err
    assert err.count('simulated' if before else 'real') == 2
    # the base that is started again is none, nor is one that was killed; one that hangs is
    mode.answers = {BASES[1]: ConnectionRefusedError()}
    assert mode(wanted, BASES[0]) == (0, f'{text}\n', '')
    for error in socket.timeout(), socket.gaierror():
        mode.answers = {BASES[1]: error}
        assert mode(wanted, BASES[0])[0] == 1


@pytest.mark.parametrize('before, wanted', [(True, 'true'), (False, 'false'), (None, 'false')])
def test_no_base_on_another_clock(mode, before, wanted):
    mode.simulated = before
    assert mode(wanted, '/arbotix') == (0, f'{wanted}\n', '')
    mode.alive, mode.simulated = False, None
    assert mode('true', '/robot1/arbotix') == (0, 'true\n', '')


@pytest.mark.parametrize('arguments, text', [
    (['true'], 'usage: clock_mode.py'), (['on', '/arbotix'], "simulated_time: 'on': expected true or false"),
    (['true', '/1/arbotix'], "robot: '1': expected a name"), (['true', '/my', 'robot/arbotix'], "robot: 'my robot': "),
    (['true', '/a/b/arbotix'], "robot: 'a/b': expected a name")])
def test_what_is_rejected(mode, arguments, text):
    status, out, err = mode(*arguments)
    assert (status, out) == (2, '') and text in err
