"""When a command is refused, and which speeds the wheels may have: see docs/bases.md, 'A command is refused'."""
from types import SimpleNamespace

import pytest

from rbx1_nav.base.command_gate import CommandGate, RefusedCommand
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create.refused_commands import Acceptance
from rbx1_nav.extras.create.create_parameters import read_settings
from rbx1_nav.extras.create.odometry import NOWHERE, Expected
from rbx1_nav.extras.create.protocol import CLIFFS, CREATE
from rbx1_nav.extras.create.sender import Phase

NOW = 10 * SECOND


class Base:
    """An Acceptance whose robot answers and is in the requested mode."""

    def __init__(self, **params):
        settings, robot = read_settings(params)
        self.gate = CommandGate(robot.limits, robot.timeout)
        self.sender, self.queries = SimpleNamespace(phase=Phase.DRIVEN), SimpleNamespace(heard=NOW)
        self.supervisor = SimpleNamespace(in_control=True, reason='')
        self.acceptance = Acceptance(settings, self.gate, self.sender, self.queries, self.supervisor)
        self.feel(0, 0)

    def feel(self, *bits):
        """Feed readings with these bumps and wheel drops. Returns the result of the last one."""
        no_cliff = dict.fromkeys(CLIFFS, 0)
        return [self.acceptance.feel({**no_cliff, 'bumps_and_wheel_drops': each}) for each in bits][-1]

    def command(self, linear, angular, now=NOW):
        """Put a command in force. Returns why it is refused, or ''."""
        self.gate.command(now, linear, angular, ())
        try:
            self.acceptance.check_obedience(now)
        except RefusedCommand as error:
            return str(error)
        return ''

    def control(self, has_control):
        """Set whether the robot is in the requested mode."""
        self.supervisor.in_control = has_control
        self.sender.phase = Phase.DRIVEN if has_control else Phase.WAITING

    def follow(self, metres, travel=NOWHERE, elapsed=0.1):
        self.acceptance.follow(elapsed, Expected(metres, metres), travel, 0.26)

    @property
    def speeds(self):
        return self.acceptance.speeds(CREATE)


@pytest.mark.parametrize('bits', [1, 2, 3])
def test_a_bump_stops_forward_motion_at_once_and_is_refused_after_300_ms(bits):
    base = Base()
    base.command(0.2, 0)
    assert base.speeds == (200, 200)
    base.feel(bits)
    # one reading may be corrupted
    assert base.speeds == (0, 0) and base.command(0.2, 0) == base.command(0.2, 0, NOW + SECOND) == ''
    base.feel(bits)
    assert base.command(0.2, 0) == base.command(0.2, 0, NOW + 299 * SECOND // 1000) == '' and base.speeds == (0, 0)
    assert base.command(0.2, 0, NOW + 3 * SECOND // 10) == 'a bumper is pressed'
    # a script that reacts has this time again
    assert base.command(-0.2, 0, NOW + SECOND) == base.command(0, 1, NOW + SECOND) == ''
    assert base.command(0.2, 0, NOW + 2 * SECOND) == ''
    base.feel(0)
    assert base.command(0.2, 0, NOW + 3 * SECOND) == ''


def test_a_bump_does_not_stop_if_it_should_not():
    base = Base(stop_motors_on_bump=False)
    base.feel(3, 3)
    assert base.command(0.2, 0) == base.command(0.2, 0, NOW + SECOND) == '' and base.speeds == (200, 200)


@pytest.mark.parametrize('bits', [4, 8, 16])
def test_two_readings_show_a_dropped_wheel(bits):
    base = Base()
    base.command(-0.2, 0)
    assert not base.feel(bits) and base.speeds == (0, 0)
    assert base.feel(bits) and not base.feel(0) and base.speeds == (-200, -200)
    assert not base.feel(4, 8) and not base.feel(3, 3)


@pytest.mark.parametrize('metres, refused', [(0.099, False), (0.101, True)])
def test_wheels_that_do_not_turn_in_a_tenth_of_a_metre(metres, refused):
    base = Base()
    for _ in range(10):
        base.follow(metres / 10)
    assert ('its wheels do not turn' in base.command(0.2, 0)) == refused
    base.gate.halt()
    base.acceptance.check_obedience(NOW)        # nothing to refuse at rest
    # the refusal locks out, and then the wheels have another chance
    assert base.command(0.2, 0) == ''


def test_a_robot_that_does_not_answer_for_0_3_s():
    base = Base()
    base.sender.phase = Phase.SILENT
    assert base.command(0.2, 0, NOW + SECOND * 3 // 10) == '' and base.speeds == (0, 0)
    assert base.command(0.2, 0, NOW + SECOND * 3 // 10 + 1) == 'the robot does not answer'
    base.queries.heard = None
    assert base.command(0.2, 0) == 'the robot does not answer'


@pytest.mark.parametrize('reason, text', [
    ('a cliff', 'the robot cannot be driven: a cliff'),
    ('', 'the robot cannot be driven: it does not change to the requested mode')])
def test_a_robot_that_is_not_in_the_requested_mode_for_0_3_s(reason, text):
    base = Base()
    base.control(False)
    base.supervisor.reason = reason
    assert base.command(0.2, 0) == base.command(0.2, 0, NOW + SECOND * 3 // 10 - 1) == '' and base.speeds == (0, 0)
    assert base.command(0.2, 0, NOW + SECOND * 3 // 10) == text
    # the time starts again when the robot follows
    base.control(True)
    assert base.command(0.2, 0, NOW + SECOND) == ''
    base.control(False)
    assert base.command(0.2, 0, NOW + 2 * SECOND) == ''


@pytest.mark.parametrize('sender, moving, pause, refused', [
    ('driver', True, SECOND * 3 // 5, True), ('driver', True, SECOND * 3 // 5 + 1, False),
    ('driver', False, 1, False), ('other', True, 1, False)])
def test_a_sender_is_locked_out_until_it_stops_or_has_been_silent_for_more_than_the_timeout(
        sender, moving, pause, refused):
    base = Base()
    base.acceptance.check_sender(NOW, 'driver', True)
    for _ in range(2):      # the second event concerns everybody again
        base.acceptance.lock('the robot was reset')
        base.acceptance.check_sender(NOW, 'driver', False)
    base.acceptance.lock('a wheel dropped')
    if refused:
        with pytest.raises(RefusedCommand, match='a wheel dropped; expected a zero command, or none for 0.6 s'):
            base.acceptance.check_sender(NOW + pause, sender, moving)
        return
    base.acceptance.check_sender(NOW + pause, sender, moving)
    base.acceptance.check_sender(NOW + pause + 1, sender, True)


def test_a_command_to_stop_is_never_refused():
    base = Base()
    base.control(False)
    base.command(0.2, 0)
    assert base.command(0, 0, NOW + SECOND) == '' and base.command(0.2, 0, NOW + SECOND) == ''
