"""Which port is opened: the default, and an adapter that was unplugged and returns under another number."""
from types import SimpleNamespace

import pytest

from rbx1_nav.extras.create import serial_port as module
from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal
from rbx1_nav.extras.create.serial_port import describe_adapter, find_port

FTDI = 'FTDI USB-Serial 42'


@pytest.fixture(name='usb')
def make_usb(tmp_path, monkeypatch):
    """Return (plug(name, description), unplug(name)), which return the path of a port."""
    def plug(name, description):
        (tmp_path / name).write_text(description)
        return str(tmp_path / name)

    def unplug(name):
        (tmp_path / name).unlink()
        return str(tmp_path / name)

    def ports():
        for path in tmp_path.iterdir():
            manufacturer, _, product = path.read_text().partition(' ')
            yield SimpleNamespace(device=str(path), manufacturer=manufacturer, product=product, serial_number=None)
    monkeypatch.setattr(module, 'DEFAULT', (str(tmp_path / 'create'), str(tmp_path / 'ttyUSB0')))
    monkeypatch.setattr(module.list_ports, 'comports', ports)
    return plug, unplug


@pytest.mark.parametrize('name', ['ttyUSB1', 'ttyACM0'])
def test_an_adapter_is_found_under_another_number(usb, name):
    plug, unplug = usb
    path = plug('ttyUSB0', FTDI)
    assert find_port(path, FTDI, set()) == path
    unplug('ttyUSB0')
    plug('ttyUSB2', 'GPS')
    assert find_port(path, FTDI, set()) == path
    other = plug(name, FTDI)
    assert find_port(path, FTDI, set()) == other
    plug('ttyUSB0', 'GPS')      # another device has taken the number
    assert find_port(path, FTDI, set()) == other


def test_another_adapter_with_this_description_is_not_the_robots(usb):
    plug, unplug = usb
    path, other = plug('ttyUSB0', FTDI), plug('ttyUSB1', FTDI)
    unplug('ttyUSB0')
    assert find_port(path, FTDI, {other}) == path
    third = plug('ttyUSB2', FTDI)
    assert find_port(path, FTDI, {other}) == third and find_port(path, FTDI, set()) == path


def test_the_name_from_the_udev_rules_is_the_default(usb):
    plug, unplug = usb
    link = plug('create', FTDI)
    assert find_port('auto', '', set()) == link
    unplug('create')
    assert find_port('auto', '', set()) == link.replace('create', 'ttyUSB0')


def test_the_adapter_of_a_port(tmp_path):
    terminal = PseudoTerminal(str(tmp_path / 'robot'))
    assert describe_adapter(terminal.link) == 'a pseudo-terminal'
    terminal.unplug()
    (tmp_path / 'tty').write_text('')
    assert describe_adapter(str(tmp_path / 'tty')) == str(tmp_path / 'tty')
