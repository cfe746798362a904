"""A port that cannot be opened: a one-line message gives the reason. On a pseudo-terminal."""
import errno
import subprocess
import sys
import termios

import pytest

from rbx1_nav.extras.create import serial_port as module
from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal
from rbx1_nav.extras.create.serial_port import PortError, open_port, reason


@pytest.fixture(name='terminal')
def make_terminal(tmp_path):
    terminal = PseudoTerminal(str(tmp_path / 'robot'))
    yield terminal
    terminal.unplug()


def refusal(path):
    with pytest.raises(PortError) as caught:
        open_port(str(path), 115200)
    return str(caught.value)


def test_no_device(tmp_path):
    path = tmp_path / 'none'
    assert refusal(path) == f"{path}: no such device: expected the robot's adapter to be plugged in"


def test_not_a_serial_port(tmp_path):
    path = tmp_path / 'file'
    path.write_text('')
    assert refusal(path) == f'{path}: not a serial port: expected the device of an adapter, such as /dev/ttyUSB0'
    assert refusal(
        tmp_path) == f'{tmp_path}: not a serial port: expected the device of an adapter, such as /dev/ttyUSB0'


def test_what_a_user_without_permission_reads(tmp_path):
    text = reason(str(tmp_path / 'none'), 13, None)     # also if the group is unknown
    assert text == ('not permitted: expected a member of the group dialout; run `sudo adduser $USER dialout`, then log '
                    'in again')


def test_a_port_of_the_group_root_needs_the_udev_rules(monkeypatch):
    monkeypatch.setattr(module, 'group_of', lambda path: 'root')
    assert reason('/dev/ttyUSB0', 13, None) == (
        'not permitted: expected a port of the group dialout; install the udev rules: see docs/real_robot.md, "The '
        'serial port"')


def test_another_process_has_it(terminal):
    code = 'import serial, sys; port = serial.Serial(sys.argv[1], exclusive=True); print("open", flush=True); input()'
    with subprocess.Popen([sys.executable, '-c', code, terminal.link], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          ) as other:
        assert other.stdout.readline() == b'open\n'
        text = refusal(terminal.link)
        other.communicate(b'\n')
    assert text == (f'{terminal.link}: in use by another process: expected a port that is not in use; to find it: '
                    f'`sudo fuser -v {terminal.link}`')
    open_port(terminal.link, 57600).close()


@pytest.mark.parametrize('call', ['tcgetattr', 'tcsetattr', 'tcflush'])
def test_an_adapter_that_is_unplugged_while_it_is_opened(call, terminal, monkeypatch):
    do = getattr(termios, call)
    monkeypatch.setattr(termios, call, lambda *arguments: terminal.unplug() or do(*arguments))
    assert 'no such device' in refusal(terminal.link)


@pytest.mark.parametrize('number, text', [
    (errno.EAGAIN, 'in use by another process'), (errno.EBUSY, 'in use by another process'),
    (errno.EACCES, 'not permitted'), (errno.EPERM, 'not permitted'), (errno.ENOENT, 'no such device'),
    (errno.ENXIO, 'no such device'), (errno.ENODEV, 'no such device'), (errno.ENOTTY, 'not a serial port'),
    (errno.EINVAL, 'not a serial port'), (errno.EISDIR, 'not a serial port'), (errno.EIO, 'no such device'),
    (None, 'some error')])
def test_why_a_port_cannot_be_opened(number, text, tmp_path):
    assert reason(str(tmp_path / 'none'), number, OSError('some error')).startswith(text)
