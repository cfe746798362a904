"""A pseudo-terminal for the tests in this folder."""
import pytest

from rbx1_nav.extras.create.emulator.serial_line import PseudoTerminal


@pytest.fixture(name='terminal')
def make_terminal(tmp_path):
    terminal = PseudoTerminal(str(tmp_path / 'robot'))
    yield terminal
    terminal.unplug()
