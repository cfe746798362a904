"""When the mode in which the robot is driven is requested, and what is logged about it: see docs/bases.md, 'Modes'."""
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol
from rbx1_nav.extras.create.connection import Supervisor, causes
from rbx1_nav.extras.create.protocol import FULL, OFF, PASSIVE, SAFE

from driven_create import BOTH, started

TENTH = SECOND // 10
WHEEL, CLIFF, CHARGER, DOCK = (
    {'bumps_and_wheel_drops': 8}, {'cliff_left': 1}, {'charging_sources': 1}, {'charging_sources': 2})


def reading(mode, **changes):
    names = 'cliff_left', 'cliff_front_left', 'cliff_front_right', 'cliff_right', 'charging_sources'
    return {**dict.fromkeys(names, 0), 'bumps_and_wheel_drops': 0, 'mode': mode, **changes}


class Supervised:
    """A Supervisor that receives a reading each tenth of a second."""

    def __init__(self, wanted=SAFE, plus_one=False):
        self.log = []
        self.supervisor = Supervisor(wanted, plus_one, self.log.append, self.log.append)
        self.now = 0

    def feed(self, mode, times=1, wants_motion=False, **changes):
        """Feed equal readings. Returns the numbers of those after which the wanted mode is requested."""
        requests = []
        for number in range(1, times + 1):
            self.now += TENTH
            request = self.supervisor.update(self.now, reading(mode, **changes), wants_motion)
            if request == self.supervisor.wanted:
                requests.append(number)
        return requests


@pytest.mark.parametrize('changes, text', [
    ({}, []), ({'bumps_and_wheel_drops': 3}, []), ({'bumps_and_wheel_drops': 4}, ['a wheel dropped']),
    (WHEEL, ['a wheel dropped']), ({'bumps_and_wheel_drops': 16}, ['a wheel dropped']), (CLIFF, ['a cliff']),
    ({'cliff_front_left': 1}, ['a cliff']), ({'cliff_front_right': 1}, ['a cliff']), ({'cliff_right': 1}, ['a cliff']),
    (CHARGER, ['the charger is plugged in']), (DOCK, []),
    ({**WHEEL, **CLIFF, **CHARGER}, ['a wheel dropped', 'a cliff', 'the charger is plugged in'])])
def test_why_a_robot_leaves_safe_mode(changes, text):
    assert causes(reading(SAFE, **changes)) == text


def test_the_mode_is_requested_until_the_robot_reports_it():
    # of two equal readings, the second one counts
    requests = Supervised().feed(PASSIVE, 20)
    assert requests[0] == 2 and 1 < len(requests) < 10
    robot = Supervised()
    assert [robot.feed(mode) for mode in (PASSIVE, SAFE, PASSIVE, OFF, PASSIVE)] == [[]] * 5
    # once it has been in control, a second after the last cause
    robot.feed(PASSIVE, 2), robot.feed(SAFE, 2)
    assert not robot.feed(PASSIVE, 2, **WHEEL) + robot.feed(PASSIVE, 9) + robot.feed(PASSIVE, 1, **WHEEL)
    assert robot.feed(PASSIVE, 15)[0] == 11
    assert not robot.feed(SAFE, 2) and robot.feed(PASSIVE, 15)[0] == 12


@pytest.mark.parametrize('wants_motion', [False, True])
def test_on_the_dock_the_mode_is_requested_only_for_a_command(wants_motion):
    robot = Supervised()
    assert bool(robot.feed(PASSIVE, 12, wants_motion, **DOCK)) == wants_motion
    assert robot.supervisor.reason == 'on the dock: publish on undock, or lift it off'
    assert robot.log == ['The robot cannot be driven: on the dock: publish on undock, or lift it off']


def test_what_is_logged_when_control_is_gained_and_lost():
    robot = Supervised(FULL)
    robot.feed(PASSIVE, 2)
    robot.feed(FULL, 10)
    robot.feed(SAFE, 2)
    assert robot.log == ['The robot is in full mode', 'Lost control of the robot: it changed from full to safe mode']
    robot.feed(FULL, 2)
    robot.feed(OFF, 2)
    assert robot.log[2:] == ['The robot is in full mode', 'Lost control of the robot: it changed from full to off mode']


@BOTH
@pytest.mark.parametrize('mode', [PASSIVE, SAFE, FULL])
@pytest.mark.parametrize('plus_one', [False, True])
def test_with_the_right_workaround_the_robot_is_driven(robot_type, mode, plus_one):
    driven = started(robot_type, mode_plus_one=plus_one, operation_mode=mode,
                     oi_mode_workaround=plus_one)
    assert driven.robot.mode == driven.driver.supervisor.mode == mode and len(driven.log) == 2
    driven.drive(0.2, 0, 0.2)
    assert driven.body.moving == (mode != protocol.PASSIVE)
    driven.body.switches = 8
    driven.run(1)
    driven.body.switches = 0
    driven.run(2)
    driven.command_zero()
    assert driven.driver.supervisor.in_control
    driven.driver.leave(driven.now)
    driven.run(0.2)
    assert driven.driver.left


@BOTH
def test_in_full_mode_a_robot_that_reports_its_mode_plus_one_needs_no_workaround(robot_type):
    """It reports a mode that does not exist."""
    driven = started(robot_type, mode_plus_one=True, operation_mode=FULL)
    driven.drive(0.3, 0.5, 2)
    assert driven.body.moving
    driven.run(1)
    before = driven.pose
    driven.robot.switch_on(driven.now)      # its battery is taken out and put in
    driven.run(4)
    assert driven.pose == before and driven.robot.mode == FULL
    driven.driver.leave(driven.now)
    driven.run(0.1)
    assert driven.driver.left and driven.robot.mode == PASSIVE


@BOTH
@pytest.mark.parametrize('plus_one', [False, True])
@pytest.mark.parametrize('mode', [SAFE, FULL])
def test_a_robot_that_was_not_driven_confirms_the_last_stop_in_any_mode(robot_type, mode, plus_one):
    driven = started(robot_type, mode_plus_one=plus_one, operation_mode=mode,
                     oi_mode_workaround=not plus_one)
    driven.driver.leave(driven.now)
    driven.run(0.1)
    assert driven.driver.left and driven.robot.mode == PASSIVE


@BOTH
@pytest.mark.parametrize('mode', [protocol.PASSIVE, protocol.SAFE])
@pytest.mark.parametrize('plus_one', [False, True])
def test_a_wrong_workaround_is_named_and_the_robot_is_not_driven(robot_type, mode, plus_one):
    driven = started(robot_type, 5, mode_plus_one=plus_one, operation_mode=mode,
                     oi_mode_workaround=not plus_one)
    assert driven.log[1:] == [
        'The robot cannot be driven: it reports mode %d after it was asked for %s mode: expected %d, or '
        'the parameter oi_mode_workaround: %s' % (mode + plus_one, protocol.MODE_NAMES[mode], mode + 1 - plus_one,
                                                  str(plus_one).lower())]
    # the node subscribes to commands, and refuses them with the reason
    assert driven.driver.is_ready
    driven.drive(0.2, 0, 1)
    assert not driven.body.moving or plus_one       # in that case, it is in safe mode
    assert any('oi_mode_workaround' in text for text in driven.refusals)
