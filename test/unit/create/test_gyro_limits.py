"""The limits beyond which the gyro of a TurtleBot counts as faulty: see docs/bases.md, 'The gyro'."""
from math import radians

import pytest

from rbx1_nav.create.driver.gyro_check import GyroCheck, Step

# s between two readings: sums of this number are exact
PERIOD = 1 / 16
SECOND = 16         # readings


class Checked:
    """A GyroCheck that receives steps with the motion of the wheels in degrees."""

    def __init__(self, full_scale=150):
        self.errors, self.infos = [], []
        self.check = GyroCheck(radians(full_scale), self.errors.append, self.infos.append)

    def feed(self, count, times=1, turn=0.0, commanded=0.0, rest=False, driven=True, touched=False, missing=False):
        """Feed equal steps (turns in degrees for each step). Returns the number of the step that shows a fault."""
        for number in range(1, times + 1):
            before = self.check.problem
            step = Step(PERIOD, radians(turn), 1e-9, radians(commanded), rest, driven, touched, missing)
            self.check.update(count, step)
            if self.check.problem and not before:
                return number
        return None


def rested(**options):
    """Return a Checked after a second at rest."""
    checked = Checked(**options)
    assert checked.feed(512, SECOND, rest=True) is None
    return checked


# no power

@pytest.mark.parametrize('rest', [False, True])
def test_five_readings_below_100_counts(rest):
    assert rested().feed(99, SECOND, rest=rest) == 5
    assert rested().feed(100, SECOND) is None


@pytest.mark.parametrize('before', [0, 1, 9])
def test_ten_wrong_readings_in_a_row(before):
    checked = rested()
    checked.feed(300, before, rest=True)
    checked.feed(512, rest=True)
    assert checked.feed(300, SECOND, rest=True) == 10
    assert checked.errors == ['Gyro: 300 counts at rest: expected 425 to 575; using the wheels alone for the heading']


def test_without_control_a_lack_of_power_is_no_fault():
    assert Checked().feed(12, 10 * SECOND, driven=False) is None


def test_a_better_reading_starts_the_five_again():
    checked = rested()
    for _ in range(5):
        assert checked.feed(99, 4) is None and checked.feed(512) is None
    assert checked.feed(99, 4) is None and checked.feed(99) == 1


def test_the_power_may_rise_for_half_a_second_after_each_change_of_control():
    checked = Checked()
    checked.feed(512, SECOND, driven=False)
    assert checked.feed(12, SECOND) == SECOND // 2
    checked = rested()
    checked.feed(512, driven=False)
    assert checked.feed(12, SECOND) == SECOND // 2


@pytest.mark.parametrize('full_scale, limit', [(150, 65), (100, 45)])
def test_in_a_fast_left_turn_a_low_reading_is_no_fault(full_scale, limit):
    """65 degrees/s, or 45 % of the range."""
    slow, fast = (limit - 1) * PERIOD, (limit + 1) * PERIOD
    assert rested(full_scale=full_scale).feed(50, SECOND, commanded=slow) == 5
    assert rested(full_scale=full_scale).feed(50, 5 * SECOND, commanded=fast) is None
    assert rested(full_scale=full_scale).feed(50, SECOND, commanded=-fast) == 5
    # the turn of the wheels is rounded to a degree
    assert rested(full_scale=full_scale).feed(50, SECOND, turn=slow + 1) == 5
    assert rested(full_scale=full_scale).feed(50, 5 * SECOND, turn=fast + 1) is None


def test_the_error_is_delayed_for_half_a_second_after_a_fast_left_turn():
    checked = rested()
    checked.feed(50, SECOND, commanded=66 * PERIOD)
    assert checked.feed(50, SECOND) == SECOND // 2


# at rest

def test_ten_wrong_readings_at_rest_without_a_hand_on_the_robot():
    assert rested().feed(576, SECOND, rest=True) == rested().feed(424, SECOND, rest=True) == 10
    assert Checked().feed(576, SECOND, rest=True) == rested().feed(100, SECOND, rest=True) == 10
    assert rested().feed(575, SECOND, rest=True) is rested().feed(425, SECOND, rest=True) is None
    assert rested().feed(576, SECOND, rest=True, touched=True) is rested().feed(576, SECOND) is None


def test_what_shows_an_angular_velocity():
    check = Checked().check
    assert [check.accepts(count, True) for count in (424, 425, 575, 576)] == [False, True, True, False]
    assert [check.accepts(count, False) for count in (99, 100, 1022, 1023)] == [False, True, True, False]


# repaired

def broken():
    """Return a Checked with a faulty gyro."""
    checked = rested()
    assert checked.feed(900, SECOND, rest=True) == 10
    return checked


@pytest.mark.parametrize('count', [425, 512, 575])
def test_it_works_again_after_a_second_of_good_readings_at_rest(count):
    checked = broken()
    checked.feed(count, SECOND, rest=True)
    assert checked.check.problem and not checked.infos
    checked.feed(count, rest=True)        # the first reading starts the second
    assert not checked.check.problem and checked.infos == ['Gyro: working again']


@pytest.mark.parametrize('interruption', [{}, {'rest': True, 'missing': True}, {'rest': True, 'count': 424},
                                          {'rest': True, 'count': 576}])
def test_the_second_must_be_uninterrupted(interruption):
    checked = broken()
    checked.feed(512, SECOND, rest=True)
    checked.feed(**{'count': 512, **interruption})
    checked.feed(512, SECOND, rest=True)
    assert checked.check.problem
    checked.feed(512, rest=True)
    assert not checked.check.problem


def test_after_a_repair_the_same_fault_is_logged_again():
    checked = broken()
    checked.feed(512, SECOND + 1, rest=True)
    assert checked.feed(900, SECOND, rest=True) == 10
    assert len(checked.errors) == 2
