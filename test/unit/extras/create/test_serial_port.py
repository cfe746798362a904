"""The line on a pseudo-terminal: missing, without a reader, disconnected, and with a guardian that has died."""
import os
import pty
import select
from types import SimpleNamespace

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.identification import Search
from rbx1_nav.extras.create.sender import Phase, Sender
from rbx1_nav.extras.create.serial_port import BEAT, LineLost, Link

LIMIT = 30      # s after which a wait fails


def make_link(path):
    """Return (a Link with the robot at 115200 baud, the lines that it logs)."""
    log = []
    return Link(SimpleNamespace(model=protocol.CREATE_2, baud=None, port=path), log.append), log


@pytest.fixture(name='line')
def make_line():
    """Return (the robot's side of a line, the open Link on the other side, its log)."""
    robot, host = pty.openpty()
    path = os.ttyname(host)
    os.close(host)
    link, log = make_link(path)
    assert link.open(0), link.problem
    yield robot, link, log
    guardian = link.guardian.process
    link.close()
    guardian.wait()


def test_a_port_that_is_missing_is_logged_once_after_a_second(tmp_path):
    link, log = make_link(str(tmp_path / 'none'))
    for tenth in range(40):
        assert not link.open(tenth * SECOND // 10)
        assert len(log) == (tenth >= 10)
    assert log[0].endswith('; trying again')
    link.configured = str(tmp_path)       # another problem
    assert not link.open(5 * SECOND) and len(log) == 2


def test_a_line_that_takes_no_bytes_is_lost(line):
    """A write neither blocks nor drops bytes silently."""
    _, link, _ = line
    with pytest.raises(LineLost, match='write timed out|temporarily unavailable'):
        for _ in range(10 ** 5):
            link.write(bytes(100))


def test_a_line_whose_other_end_is_closed_is_lost(line):
    """This has the effect of an unplugged cable."""
    robot, link, _ = line
    os.close(robot)
    with pytest.raises(LineLost, match=link.path):
        link.write(b'\0')


def test_the_death_of_the_guardian_ends_the_wait_for_bytes(line):
    """Until the node notices the death, a robot whose node is killed is not stopped."""
    robot, link, _ = line
    for missing in (None, 0):
        assert link.is_guarded(BEAT)
        link.guardian.process.kill()
        link.read(LIMIT * 1000, missing)     # would outlast the time limit of any test
        assert not link.is_guarded(BEAT)
        assert not select.select([robot], [], [], 0)[0]
        link.close()
        assert link.open(10 ** 9)


def test_a_line_without_rts_and_dtr_is_searched_without_waking(line):
    robot, link, log = line
    sender = Sender()
    sender.use_line(link.write)
    sender.phase = Phase.SEARCHING
    search = Search(sender, (57600,), wake=True)
    search.begin(0, link)
    count = 0
    for now in range(0, 4 * SECOND, SECOND // 10):
        search.tick(now)        # does not raise LineLost
        count += len(os.read(robot, 4096)) if select.select([robot], [], [], 0)[0] else 0
    assert search.rounds > 5 and count > 200
    assert log == ['wake_robot:=true: %s has no RTS and DTR: expected an adapter that has these lines; searching '
                   'without '
                   'waking the robot' % link.path]
