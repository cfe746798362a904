"""When the mode in which the robot is driven is requested, and what is logged about it: see docs/bases.md, 'Modes'."""
import pytest

from rbx1_nav.create.driver.supervisor import Supervisor, causes
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
        self.starts = 0     # number of requests of passive mode

    def start(self):
        """Start the robot."""
        self.supervisor.restart(self.now)

    def feed(self, mode, times=1, wants_motion=False, tick=TENTH, **changes):
        """Feed equal readings. Returns the numbers of those after which the wanted mode is requested."""
        requests = []
        for number in range(1, times + 1):
            self.now += tick
            request = self.supervisor.update(self.now, reading(mode, **changes), wants_motion)
            self.starts += request == PASSIVE
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

def begun(wanted=SAFE):
    """Return a robot of unknown offset that was just started."""
    robot = Supervised(wanted, plus_one=None)
    robot.start()
    return robot


@pytest.mark.parametrize('wanted', [PASSIVE, SAFE, FULL])
@pytest.mark.parametrize('offset', [0, 1])
def test_what_is_reported_after_a_start_shows_the_offset(wanted, offset):
    robot = begun(wanted)
    assert robot.feed(PASSIVE + offset, 2) == ([] if wanted == PASSIVE else [2])
    robot.feed(wanted + offset, 2)
    assert robot.supervisor.in_control and robot.supervisor.offset == offset and not robot.starts
    assert sum('mode plus one' in line for line in robot.log) == offset


def test_a_reading_less_than_0_1_s_after_the_start_does_not_show_its_effect():
    robot = begun()
    assert robot.feed(SAFE, 3, tick=TENTH // 4) == [] and not robot.supervisor.observed
    assert robot.feed(PASSIVE, 2, tick=TENTH // 4) == [2] and robot.supervisor.offset == 0


@pytest.mark.parametrize('mode', [OFF, FULL, 4])
def test_another_mode_after_a_start_shows_nothing_and_the_start_is_repeated(mode):
    robot = begun()
    assert robot.feed(mode, 10) == [] and robot.starts == 2 and not robot.supervisor.in_control
    assert robot.feed(PASSIVE, 2) == [2]
    # the node can report it
    robot = begun()
    robot.feed(mode, 30)
    assert robot.supervisor.reason.startswith(f'it reports mode {mode} ')


def test_the_offset_is_observed_despite_an_obstacle():
    robot = begun()
    assert robot.feed(SAFE, 3, **WHEEL) == [] and robot.supervisor.mode == PASSIVE and robot.supervisor.offset == 1
    assert robot.feed(SAFE, 1) == [1]


def test_a_lost_start_is_repeated_when_the_robot_does_not_seem_to_obey():
    """The robot is still in safe mode, and does not report its mode plus one."""
    robot = begun()
    assert robot.feed(SAFE, 20) == [2, 7, 12, 17] and robot.supervisor.offset == 1 and not robot.starts
    assert robot.feed(SAFE, 2) == [] and robot.starts == 1
    assert robot.feed(PASSIVE, 2) == [2] and robot.supervisor.offset == 0
    robot.feed(SAFE, 2)
    assert robot.supervisor.in_control


def test_a_given_offset_needs_no_start():
    robot = Supervised(plus_one=True)
    robot.start()
    assert robot.feed(PASSIVE, 50) and not robot.starts and robot.supervisor.offset == 1


@pytest.mark.parametrize('plus_one, mode, passive', [
    (False, 1, True), (False, 2, False), (True, 1, False), (True, 2, True), (True, 3, False), (None, 1, True),
    (None, 2, True), (None, 3, False), (None, 0, False)])
def test_which_readings_may_show_passive_mode(plus_one, mode, passive):
    assert Supervised(plus_one=plus_one).supervisor.is_passive(reading(mode)) == passive


def test_a_silence_is_forgotten_and_a_start_also_forgets_the_offset():
    robot = begun()
    robot.feed(SAFE, 2)
    robot.feed(FULL, 2)
    assert robot.supervisor.in_control
    robot.supervisor.forget()
    assert not robot.supervisor.in_control and robot.supervisor.observed
    assert robot.feed(FULL) == [] and not robot.supervisor.in_control     # the reading before does not count
    robot.feed(FULL)
    assert robot.supervisor.in_control and robot.supervisor.offset == 1 and not robot.starts
    robot.start()
    assert robot.feed(PASSIVE, 2) == [2] and robot.supervisor.offset == 0
    robot.start()
    robot.feed(SAFE, 2)
    assert sum('mode plus one' in line for line in robot.log) == 1


def test_a_silence_before_the_offset_is_known_needs_another_start():
    robot = begun()
    robot.supervisor.forget()
    assert robot.feed(SAFE, 2) == [] and robot.starts == 1 and not robot.supervisor.observed
