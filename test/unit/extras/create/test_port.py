"""A port that cannot be opened: a one-line message gives the reason. On a pseudo-terminal."""
import errno
import subprocess
import sys
import termios

import pytest

from rbx1_nav.extras.create import serial_port as module
from rbx1_nav.extras.create.serial_port import PortError, group_of, open_port, reason


def refusal(path):
    with pytest.raises(PortError) as caught:
        open_port(str(path), 115200)
    return str(caught.value)


@pytest.mark.parametrize('name, text', [
    ('none', "no such device: expected the robot's adapter to be plugged in"),
    *((name, 'not a serial port: expected the device of an adapter, such as /dev/ttyUSB0') for name in ('file', ''))])
def test_what_is_no_port(tmp_path, name, text):
    (tmp_path / 'file').write_text('')
    assert refusal(tmp_path / name) == f'{tmp_path / name}: {text}'


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


NO_PERMISSION = {
    'dialout': 'a member of the group dialout; run `sudo adduser $USER dialout`, then log in again',
    'root': 'a port of the group dialout; install the udev rules: see docs/real_robot.md, "The serial port"'}


@pytest.mark.parametrize('number, group, text', [
    (errno.EAGAIN, '', 'in use by another process'), (errno.EBUSY, '', 'in use by another process'),
    *((number, group, f'not permitted: expected {text}')
      for number in (errno.EACCES, errno.EPERM) for group, text in NO_PERMISSION.items()),
    *((number, '', 'no such device') for number in (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.EIO)),
    *((number, '', 'not a serial port') for number in (errno.ENOTTY, errno.EINVAL, errno.EISDIR)),
    (None, '', 'some error')])
def test_why_a_port_cannot_be_opened(monkeypatch, number, group, text):
    monkeypatch.setattr(module, 'group_of', lambda path: group)
    assert reason('/dev/ttyUSB0', number, OSError('some error')).startswith(text)


def test_the_group_of_a_port_that_is_missing(tmp_path):
    assert group_of(str(tmp_path / 'none')) == 'dialout'
