"""The line, at a pseudo-terminal that nobody reads, and at one that is gone."""
import os
import pty
from types import SimpleNamespace

import pytest

from rbx1_nav.create import protocol
from rbx1_nav.create.link import LineLost, Link


@pytest.fixture
def line():
    """(the robot's end of a line, the open Link at the other)."""
    robot, host = pty.openpty()
    path = os.ttyname(host)
    os.close(host)
    link = Link(SimpleNamespace(model=protocol.CREATE_2, port=path), pytest.fail)
    assert link.open(0), link.problem
    yield robot, link
    guardian = link.guardian.process
    link.close()
    guardian.wait()


def test_a_line_that_takes_no_bytes_is_lost(line):
    """It neither blocks nor drops them silently."""
    _, link = line
    with pytest.raises(LineLost, match='accepts no more bytes|temporarily unavailable'):
        for _ in range(10 ** 5):
            link.write(bytes(100))


def test_a_line_whose_other_end_is_closed_is_lost(line):
    """As if the cable were pulled."""
    robot, link = line
    os.close(robot)
    with pytest.raises(LineLost, match=link.path):
        link.write(b'\0')
