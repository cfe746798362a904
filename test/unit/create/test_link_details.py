"""The heartbeats and settings of the line, and the texts of a port that cannot be opened."""
import errno
import os
import pty
from types import SimpleNamespace

import pytest

import rbx1_nav.create.driver.link as link_module
from rbx1_nav.create import protocol
from rbx1_nav.create.driver.guardian import HANG
from rbx1_nav.create.driver.link import LineLost, Link, describe_adapter, reason
from rbx1_nav.create.emulator.serial_line import PseudoTerminal
from rbx1_nav.create.line_settings import read_rate, read_settings
from rbx1_nav.units import SECOND

TENTH = SECOND // 10


class Guardian:
    """A guardian without a process."""

    alive, confirmed, released = None, None, False

    def __init__(self, line, stop):
        self.line, self.stop, self.beats = line, stop, 0
        self.lives = True
        self.alive = os.memfd_create('guardian')     # never used by these tests

    def beat(self, stop=b''):
        self.beats += 1
        self.confirmed = stop
        return self.lives

    def release(self):
        self.released = True
        os.close(self.alive)


@pytest.fixture(name='line')
def make_line(monkeypatch):
    """Return (the open Link with a Guardian that has no process, its log)."""
    monkeypatch.setattr(link_module, 'Guardian', Guardian)
    robot, host = pty.openpty()
    log = []
    link = Link(SimpleNamespace(model=protocol.CREATE_2, baud=None, port=os.ttyname(host)), log.append)
    os.close(host)
    assert link.open(SECOND) and link.problem == ''
    yield link, log
    link.close()
    os.close(robot)


def test_a_problem_that_is_gone_is_logged_again_when_it_returns(line):
    link, log = line
    path, link.configured = link.path, '/dev/none'
    link.close()
    for start in 10 * SECOND, 30 * SECOND:
        for tenth in range(20):
            link.open(start + tenth * TENTH)
        assert len(log) == (1 if start == 10 * SECOND else 2)
        link.configured = path
        assert link.open(start + 5 * SECOND) and link.problem == link.logged == '' and link.lost_at is None
        link.close()
        link.configured = '/dev/none'
        log[:] = [text for text in log if 'check that the same robot' not in text]


def test_the_guardian_gets_heartbeats_while_it_lives(line):
    link, _ = line
    assert link.guardian.stop == b'\x80'        # Start, until the robot is known
    for millisecond in range(1000):
        assert link.is_guarded(SECOND + millisecond * SECOND // 1000)
    # several in the time after which it takes the node for hanging, but not one for each call
    assert 3 < link.guardian.beats * HANG < 100
    link.guardian.lives = False
    assert not link.is_guarded(3 * SECOND)
    link.guardian.lives = True
    assert not link.is_guarded(5 * SECOND)      # a dead guardian remains dead
    link.confirm(protocol.CREATE_2)
    assert link.guardian.confirmed.endswith(bytes((145, 0, 0, 0, 0, 128)))      # a stop, and Start


def test_a_line_is_closed_once(line):
    link, _ = line
    guardian, port = link.guardian, link.port
    link.close()
    assert guardian.released and not port.is_open and link.guardian is link.port is None
    link.close()


def test_the_rate_of_the_line(line):
    link, log = line
    assert read_rate(link.port.fd) == 115200
    link.set_rate(19200)
    assert link.baud == read_rate(link.port.fd) == 19200 and link.settings == read_settings(link.port.fd)
    link.write(b'')
    # the new rate is not mistaken for a change by another process
    assert not log and link.changes == 0 and not link.disturbed


def test_a_partial_write_is_an_error(line, monkeypatch):
    link, _ = line
    monkeypatch.setattr(os, 'write', lambda descriptor, data: len(data) - 1)
    with pytest.raises(LineLost, match='write timed out'):
        link.write(b'ab')


def test_a_port_without_a_rate(line, monkeypatch):
    link, _ = line
    with pytest.raises(LineLost, match=link.path):
        link.set_rate(-1)


# ports

@pytest.mark.parametrize('number, text', [
    (errno.EAGAIN, 'in use by another process'), (errno.EBUSY, 'in use by another process'),
    (errno.EACCES, 'not permitted'), (errno.EPERM, 'not permitted'), (errno.ENOENT, 'no such device'),
    (errno.ENXIO, 'no such device'), (errno.ENODEV, 'no such device'), (errno.ENOTTY, 'not a serial port'),
    (errno.EINVAL, 'not a serial port'), (errno.EISDIR, 'not a serial port'), (errno.EIO, 'some error'),
    (None, 'some error')])
def test_why_a_port_cannot_be_opened(number, text, tmp_path):
    assert reason(str(tmp_path / 'none'), number, OSError('some error')).startswith(text)


def test_the_adapter_of_a_port(tmp_path):
    terminal = PseudoTerminal(str(tmp_path / 'robot'))
    assert describe_adapter(terminal.link) == 'a pseudo-terminal'
    terminal.unplug()
    (tmp_path / 'tty').write_text('')
    assert describe_adapter(str(tmp_path / 'tty')) == str(tmp_path / 'tty')
