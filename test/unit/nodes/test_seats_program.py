"""seats.py rejects what cannot be started, starts a seat again that has exited, and reports it."""
import socket

import pytest

from loaded_nodes import load, run_program

MODULE = load('seats')


@pytest.mark.parametrize('arguments, text', [
    (['0'], 'seats: 0: expected an integer from 1 to 100'), (['101'], 'seats: 101: '),
    (['3', '--web-port', '80'], '--web-port: 80: expected 1024 to 65435'),
    (['3', '--master-port', '8083'], '--web-port: 8080: expected a port that is 4 or more away from --master-port'),
    (['3', '--surface', 'sand'], "surface: 'sand'"), (['3', '--seed', '-1'], 'seed: -1'),
    (['3', '--choices', 'colour'], 'choices: ')])
def test_arguments_that_are_rejected(monkeypatch, tmp_path, arguments, text):
    status, out, err = run_program(monkeypatch, tmp_path, MODULE, *arguments)
    assert (status, out) == (2, '') and f'error: {text}' in err


class Seat:
    """A seat that exits once, and then does not start again."""

    master_port, web_port, page = 11312, 8081, 'http://page'

    def __init__(self, number, starts):
        self.number, self.starts = number, starts

    def start(self):
        self.running = 1
        return bool(self.starts and self.starts.pop(0))

    @property
    def is_running(self):
        self.running -= 1
        return self.running >= 0

    def error(self):
        return 'no robot'


def test_a_seat_that_exits_is_started_again_until_that_fails(monkeypatch, capsys):
    monkeypatch.setattr(MODULE.time, 'sleep', lambda _: None)
    assert MODULE.run([Seat(4, [True, True])]) == 1
    out, err = capsys.readouterr()
    assert out.splitlines()[1:] == ['   4  http://localhost:11312   http://page', 'Ready: 1 seats. Ctrl-C stops them']
    assert err.splitlines() == [
        'seat 4: exited: no robot; starting it again', 'seat 4: started again; another browser can use http://page',
        'seat 4: exited: no robot; starting it again', 'seat 4: not started: no robot']


def test_a_seat_that_does_not_start_stops_the_program(capsys):
    with pytest.raises(SystemExit, match='seat 2: not started: no robot'):
        MODULE.run([Seat(1, [True]), Seat(2, [])])


def test_a_port_that_is_taken_is_named():
    with socket.socket() as server:
        server.bind(('localhost', 0))
        server.listen()
        port = server.getsockname()[1]
        with pytest.raises(SystemExit, match=f'address localhost, port {port}: '):
            MODULE.check_ports([], 'localhost', port)
    with pytest.raises(SystemExit, match='address 192.0.2.1, port .*: expected an address of this machine'):
        MODULE.check_ports([], '192.0.2.1', port)
    MODULE.check_ports([], 'localhost', port)
    with pytest.raises(SystemExit, match='address 192.0.2.1, port .*: expected an address of this machine'):
        MODULE.check_ports([], '192.0.2.1', port)
