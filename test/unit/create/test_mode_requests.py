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


def test_control_is_taken_again_some_time_after_the_cause_is_gone():
    robot = Supervised()
    robot.feed(PASSIVE, 2)
    assert robot.feed(SAFE, 2) == [] and robot.supervisor.in_control
    assert robot.feed(PASSIVE, 20, **CLIFF) == [] and robot.supervisor.reason == 'a cliff'
    wait = robot.feed(PASSIVE, 20)[0]
    assert wait > 3
    # the time starts again at the next cause
    assert robot.feed(PASSIVE, **CLIFF) == []
    assert robot.feed(PASSIVE, 20)[0] == wait


def test_a_robot_that_was_never_in_control_is_asked_when_the_cause_is_gone():
    robot = Supervised()
    assert robot.feed(PASSIVE, 9, **WHEEL) == [] and robot.feed(PASSIVE, 3) == [1]


@pytest.mark.parametrize('wants_motion', [False, True])
def test_on_the_dock_the_mode_is_requested_only_for_a_command(wants_motion):
    robot = Supervised()
    assert bool(robot.feed(PASSIVE, 12, wants_motion, **DOCK)) == wants_motion
    assert robot.supervisor.reason == 'on the dock: lift it off if it does not follow a command'
    assert robot.log == ['The robot cannot be driven: on the dock: lift it off if it does not follow a command']


def attempts(robot):
    """Return the number of requests until the reason is known."""
    count = 0
    while not robot.supervisor.reason:
        count += len(robot.feed(PASSIVE))
        assert count < 10
    return count


def test_after_some_attempts_without_a_cause_the_modes_are_logged():
    robot = Supervised()
    needed = attempts(robot)
    assert needed > 1 and robot.log == ['The robot cannot be driven: it reports mode 1 after it was asked for safe '
                                        'mode: expected 2, or oi_mode_workaround:=true']
    # a cause explains it, and the attempts are counted again
    robot.feed(PASSIVE, 1, **WHEEL)
    assert robot.supervisor.reason == 'a wheel dropped'
    robot.feed(PASSIVE, 1)
    assert attempts(robot) == needed


def test_a_charger_that_is_plugged_in_is_not_the_dock():
    robot = Supervised()
    assert robot.feed(PASSIVE, 3, **CHARGER) == [] and robot.supervisor.reason == 'the charger is plugged in'


def test_success_starts_the_count_of_attempts_again():
    robot = Supervised()
    assert len(robot.feed(PASSIVE, 10)) > 1 and not robot.supervisor.reason
    robot.feed(SAFE, 2)
    assert attempts(robot) == attempts(Supervised())


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
    robot.feed(4, 3)
    assert robot.supervisor.in_control


def test_a_robot_that_reports_its_mode_plus_one_is_not_taken_for_one_in_safe_mode():
    robot = Supervised()
    assert robot.feed(SAFE, 2) == [2] and not robot.supervisor.in_control      # it is in passive mode
    robot.feed(FULL, 20)
    assert robot.supervisor.reason == 'it reports mode 3 after it was asked for safe mode: expected 2, or ' \
                                      'oi_mode_workaround:=true'
    robot = Supervised(plus_one=True)
    assert robot.feed(SAFE, 2) == [2]
    robot.feed(FULL, 2)
    assert robot.supervisor.in_control and robot.supervisor.is_passive(reading(SAFE))


def test_after_a_silence_the_mode_is_known_and_after_a_start_it_is_requested():
    robot = Supervised()
    robot.feed(PASSIVE, 2)
    robot.feed(SAFE, 2)
    robot.supervisor.forget()
    assert robot.feed(SAFE) == [] and not robot.supervisor.in_control     # the reading before does not count
    assert robot.feed(SAFE) == [] and robot.supervisor.in_control
    robot.supervisor.restart()
    assert robot.feed(SAFE, 3) == [2] and robot.supervisor.in_control
