"""A real pseudo-terminal, which pyserial opens like a driver."""
import os

import pytest
import serial

from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal
from rbx1_nav.node.config import ConfigError


def received(terminal, count):
    """Return the next `count` bytes from the client."""
    data = b''
    for _ in range(1000):
        data += terminal.read()
        if len(data) >= count:
            break
        terminal.wait(0.01)
    return data


def test_bytes_pass_as_they_are_both_ways(terminal):
    every = bytes(range(256))
    with serial.Serial(terminal.link, 57600, timeout=10) as port:
        port.write(every)
        assert received(terminal, 256) == every
        terminal.write(every)
        assert port.read(256) == every


@pytest.mark.parametrize('baud', [300, 14400, 28800, 57600, 115200])
def test_the_baud_rate_of_the_client(terminal, baud):
    with serial.Serial(terminal.device, baud):
        assert terminal.baud == baud


def test_without_a_client_bytes_are_lost_and_nothing_echoes(terminal):
    terminal.write(b'lost')
    assert terminal.read() == b''
    for _ in range(2):
        with serial.Serial(terminal.device, timeout=10) as port:
            terminal.write(b'new')
            assert port.read(3) == b'new' and port.in_waiting == 0
        assert terminal.read() == b''
        terminal.write(b'lost')
        terminal.wait(0)


def test_a_pulled_cable_is_an_error_at_the_client_and_the_link_is_gone(terminal):
    port = serial.Serial(terminal.link, timeout=10)
    first = terminal.device
    terminal.unplug()
    assert terminal.device is None and terminal.baud is None and not os.path.lexists(terminal.link)
    with pytest.raises(serial.SerialException):
        port.read()
    assert terminal.read() == b''
    terminal.write(b'lost')
    terminal.wait(0.001)
    terminal.plug()
    # the client still has the old one open, so the new one has another name
    assert terminal.device != first and os.path.realpath(terminal.link) == terminal.device
    port.close()
    with serial.Serial(terminal.link, timeout=10) as port:
        port.write(b'again')
        assert received(terminal, 5) == b'again'


@pytest.mark.parametrize('name, text', [('file', 'exists, and is not a link'), ('none/port', 'No such file')])
def test_a_link_that_cannot_be_made(tmp_path, name, text):
    (tmp_path / 'file').write_text('')
    with pytest.raises(ConfigError, match=f'link: .*{text}.*expected'):
        PseudoTerminal(str(tmp_path / name))
