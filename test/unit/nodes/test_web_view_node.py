"""web_view.py serves the page of each robot, and stops at its end what the pages have started."""
import pytest

from rbx1_nav.node import life
from loaded_nodes import load, without_master


@pytest.fixture(name='node')
def fixture_node(monkeypatch):
    """The module; node.calls has what was started and stopped, node.server the arguments of the PageServer."""
    node = load('web_view')
    node.calls, node.taken = [], False

    class View:
        def __init__(self, name, access):
            self.name, self.connections, self.access = name, f'connections {name}', access

        def start(self):
            node.calls.append(f'start {self.name}')

        def stop(self):
            node.calls.append(f'stop {self.name}')

    class Server:
        port = 8085

        def __init__(self, *arguments, teacher_port):
            if node.taken:
                raise OSError('in use')
            node.server, node.teacher_port = arguments, teacher_port

        def start(self):
            node.calls.append('serve')

        def stop(self):
            node.calls.append('close')
    monkeypatch.setattr(node, 'RobotView', View)
    monkeypatch.setattr(node, 'PageServer', Server)
    monkeypatch.setattr(life.end_requested, 'wait', lambda: node.calls.append('end'))
    for name in node.TOKEN_VARIABLE, node.CODE_VARIABLE, node.TEACHER_VARIABLE:
        monkeypatch.delenv(name, raising=False)
    return node


def test_all_that_is_started_is_stopped(node, monkeypatch, capsys):
    without_master(monkeypatch)
    assert node.main() == 0
    assert node.calls == ['start ', 'serve', 'end', 'stop ', 'close']
    assert node.teacher_port == 0
    assert node.server[1:] == ({'/socket/': 'connections ', '/socket': 'connections '}, 'localhost', 8080)
    assert 'Open http://localhost:8085/' in capsys.readouterr().out


def test_each_robot_of_a_fleet_has_a_socket(node, monkeypatch):
    without_master(monkeypatch, robots=2)
    monkeypatch.setenv(node.TEACHER_VARIABLE, '8090')
    assert node.main() == 0 and node.teacher_port == 8090
    assert node.server[1] == {'/socket/robot1': 'connections robot1', '/socket/robot2': 'connections robot2',
                              '/socket': 'connections robot1'}
    assert sorted(node.calls) == ['close', 'end', 'serve', 'start robot1', 'start robot2', 'stop robot1', 'stop robot2']


def test_a_port_that_is_taken_is_reported(node, monkeypatch):
    _, log = without_master(monkeypatch, port=80)
    node.taken = True
    assert node.main() == 1 and node.calls == []
    assert log[-1] == ('fatal', 'address localhost, port 80: in use: expected an address of this machine and a free '
                                'port')


@pytest.mark.parametrize('title', ['', 'a' * 61, 5])
def test_a_title_that_is_rejected(node, monkeypatch, title):
    with pytest.raises(ValueError, match='title: .*: expected a text of 1 to 60 characters'):
        without_master(monkeypatch, title=title)
        node.life.init_node('web_view', node.__doc__, node.PARAMETERS)
