"""When the mode in which the robot is driven is requested, and what is logged about it: see docs/bases.md, 'Modes'."""
import pytest

from rbx1_nav.create.driver.supervisor import Offset, Supervisor, causes
from rbx1_nav.create.protocol import FULL, OFF, PASSIVE, SAFE
from rbx1_nav.units import SECOND

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

    def feed(self, mode, times=1, wants_motion=False, tick=TENTH, **changes):
        """Feed equal readings. Returns the numbers of those after which the mode is requested."""
        requests = []
        for number in range(1, times + 1):
            self.now += tick
            if self.supervisor.update(self.now, reading(mode, **changes), wants_motion):
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


def test_the_mode_is_requested_twice_per_second():
    # of two equal readings, the second one counts
    assert Supervised().feed(PASSIVE, 20) == [2, 7, 12, 17]
    robot = Supervised()
    assert [robot.feed(mode) for mode in (PASSIVE, SAFE, PASSIVE, OFF, PASSIVE)] == [[]] * 5


def test_control_is_taken_again_a_second_after_the_cause_is_gone():
    robot = Supervised()
    robot.feed(PASSIVE, 2)
    assert robot.feed(SAFE, 2) == [] and robot.supervisor.in_control
    assert robot.feed(PASSIVE, 20, **CLIFF) == [] and robot.supervisor.reason == 'a cliff'
    assert robot.feed(PASSIVE, 17) == [11, 16]
    # the second starts again at the next cause
    assert robot.feed(PASSIVE, **CLIFF) == []
    assert robot.feed(PASSIVE, 11) == [11]


def test_a_robot_that_was_never_in_control_is_asked_when_the_cause_is_gone():
    robot = Supervised()
    assert robot.feed(PASSIVE, 9, **WHEEL) == [] and robot.feed(PASSIVE, 3) == [1]


@pytest.mark.parametrize('wants_motion', [False, True])
def test_on_the_dock_the_mode_is_requested_only_for_a_command(wants_motion):
    robot = Supervised()
    assert robot.feed(PASSIVE, 12, wants_motion, **DOCK) == ([2, 7, 12] if wants_motion else [])
    assert robot.supervisor.reason == 'on the dock: lift it off if it does not follow a command'
    assert robot.log == ['The robot cannot be driven: on the dock: lift it off if it does not follow a command']


def test_after_three_attempts_without_a_cause_the_modes_are_logged():
    robot = Supervised()
    assert robot.feed(PASSIVE, 17) == [2, 7, 12, 17] and robot.supervisor.reason == '' and not robot.log
    robot.feed(PASSIVE, 1)
    assert robot.supervisor.reason == (
        'it reports mode 1 after it was asked for safe mode: expected 2 with oi_mode_workaround:=false; without this '
        'parameter the base detects it')
    # a cause explains it, and the attempts are counted again
    robot.feed(PASSIVE, 1, **WHEEL)
    assert robot.supervisor.reason == 'a wheel dropped'
    assert robot.feed(PASSIVE, 18) == [3, 8, 13, 18] and robot.supervisor.reason == ''
    robot.feed(PASSIVE, 1)
    assert 'it reports mode 1' in robot.supervisor.reason


def test_a_charger_that_is_plugged_in_is_not_the_dock():
    robot = Supervised()
    assert robot.feed(PASSIVE, 3, **CHARGER) == [] and robot.supervisor.reason == 'the charger is plugged in'


def test_success_starts_the_count_of_attempts_again():
    robot = Supervised()
    robot.feed(PASSIVE, 13)     # three attempts
    robot.feed(SAFE, 2)
    # held for a second, then three attempts
    assert robot.feed(PASSIVE, 27) == [12, 17, 22, 27] and robot.supervisor.reason == ''


def test_what_is_logged_when_control_is_gained_and_lost():
    robot = Supervised(FULL)
    robot.feed(PASSIVE, 2)
    robot.feed(FULL, 10)
    robot.feed(SAFE, 2)
    assert robot.log == ['The robot is in full mode', 'Lost control of the robot: it changed from full to safe mode']
    robot.feed(FULL, 2)
    robot.feed(OFF, 2)
    assert robot.log[2:] == ['The robot is in full mode', 'Lost control of the robot: it changed from full to off mode']


def test_a_mode_above_full_is_full():
    robot = Supervised(FULL)
    robot.feed(4, 2)
    assert robot.supervisor.in_control


# the offset of the reported mode

def test_the_mode_is_requested_once_whatever_is_reported():
    for mode in (PASSIVE, SAFE, FULL):
        robot = Supervised(plus_one=None)
        assert robot.feed(mode, 2) == [2]


def test_a_reading_less_than_0_1_s_after_the_request_does_not_show_its_effect():
    robot = Supervised(plus_one=None)
    robot.feed(PASSIVE, 2)
    robot.feed(FULL, 2, tick=TENTH // 3)
    assert robot.supervisor.offset.value is None
    robot.feed(FULL, 1, tick=TENTH // 3 + 1)
    assert robot.supervisor.offset.value == 1 and robot.supervisor.in_control


@pytest.mark.parametrize('wanted, reported, offset', [
    (PASSIVE, PASSIVE, 0), (PASSIVE, SAFE, 1), (SAFE, FULL, 1), (SAFE, PASSIVE, 0), (SAFE, OFF, None),
    (FULL, 4, 1), (FULL, FULL, 0), (FULL, PASSIVE, 0), (FULL, SAFE, None)])
def test_what_a_mode_after_the_request_shows(wanted, reported, offset):
    found = Offset(wanted)
    found.ask(FULL if wanted == SAFE else SAFE)
    found.judge(reported, False)
    assert found.value == offset


@pytest.mark.parametrize('before, obstructed, attempts, offset', [
    (PASSIVE, False, 1, 0), (PASSIVE, True, 1, None), (SAFE, False, 1, None), (SAFE, False, 2, 0),
    (SAFE, True, 2, None)])
def test_safe_mode_may_be_passive_mode_plus_one(before, obstructed, attempts, offset):
    """It is safe mode if passive mode was reported before, or if a second request did not change it."""
    found = Offset(SAFE)
    for _ in range(attempts):
        found.ask(before)
        found.judge(SAFE, obstructed)
    assert found.value == offset


def test_passive_mode_that_was_reported_after_a_request_counts_too():
    found = Offset(SAFE)
    found.ask(SAFE)
    found.judge(PASSIVE, True)
    assert found.value == 0


def test_an_obstacle_after_the_request_makes_safe_mode_doubtful():
    """The robot reports its mode plus one, and stays in passive mode because a wheel drops for a moment."""
    robot = Supervised(plus_one=None)
    assert robot.feed(SAFE, 12, tick=TENTH // 2) == [2, 12]
    robot.feed(SAFE, 1, tick=TENTH // 2, **WHEEL)
    robot.feed(SAFE, 3, tick=TENTH // 2)
    assert robot.supervisor.offset.value is None and not robot.supervisor.in_control


@pytest.mark.parametrize('plus_one, mode, passive', [
    (False, 1, True), (False, 2, False), (True, 1, False), (True, 2, True), (True, 3, False), (None, 1, True),
    (None, 2, True), (None, 3, False), (None, 0, False)])
def test_which_readings_may_show_passive_mode(plus_one, mode, passive):
    assert Supervised(plus_one=plus_one).supervisor.is_passive(reading(mode)) == passive


def test_a_silence_is_forgotten_and_a_start_also_forgets_the_offset():
    robot = Supervised(plus_one=None)
    robot.feed(PASSIVE, 2)
    robot.feed(FULL, 3)
    assert robot.supervisor.in_control and robot.supervisor.offset.value == 1
    robot.supervisor.forget()
    assert not robot.supervisor.in_control and robot.supervisor.offset.value == 1
    assert robot.feed(SAFE) == []       # the reading before the silence does not count
    robot.supervisor.restart()
    assert robot.supervisor.offset.value is None
    assert robot.feed(PASSIVE, 2) == [2]
    assert sum('mode plus one' in line for line in robot.log) == 1
