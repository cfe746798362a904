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

    def feed(self, count, times=1, turn=0.0, commanded=0.0, shown=0.0, rest=False, driven=True, touched=False,
             missing=False, deviation=0.001):
        """Feed equal steps (turns in degrees for each step). Returns the number of the step that shows a fault."""
        for number in range(1, times + 1):
            step = Step(PERIOD, radians(turn), radians(deviation) ** 2, radians(commanded), rest, driven, touched,
                        missing)
            if self.check.update(count, step, radians(shown)):
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


def test_a_better_reading_starts_the_five_again():
    checked = rested()
    for _ in range(5):
        assert checked.feed(99, 4) is None and checked.feed(512) is None
    assert checked.feed(99, 4) is None and checked.feed(99) == 1


def test_without_control_a_lack_of_power_is_reported_after_2_s():
    checked = Checked()
    checked.feed(512, SECOND, rest=True, driven=False)
    assert checked.feed(12, 3 * SECOND, driven=False) == 2 * SECOND
    # the time without power starts again with each reading that shows power
    checked = Checked()
    checked.feed(12, 2 * SECOND - 1, driven=False)
    checked.feed(512, driven=False)
    assert checked.feed(12, 3 * SECOND, driven=False) == 2 * SECOND


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


# stuck

def test_an_unchanging_reading_while_the_wheels_turn_by_45_degrees():
    checked = rested()
    assert checked.feed(512, 22, turn=2) is None        # 44 degrees
    assert checked.feed(512, turn=1.5) == 1
    assert checked.errors == ['Gyro: stuck at 512 counts while the wheels turn the robot; using the wheels alone for '
                              'the heading']


def test_a_turn_in_both_directions_counts_from_its_rightmost_to_its_leftmost_heading():
    for half, fault in ((22, False), (24, True)):
        checked = rested()
        assert checked.feed(512, half, turn=1) is None
        assert bool(checked.feed(512, 2 * half, turn=-1)) == fault


@pytest.mark.parametrize('change, fault', [(0, True), (1, True), (-1, True), (2, False), (-2, False)])
def test_a_change_by_one_count_is_noise(change, fault):
    checked = rested()
    found = [checked.feed(512 + change * (number % 2), turn=2) for number in range(100)]
    assert any(found) == fault


@pytest.mark.parametrize('interruption', [{'missing': True}, {'deviation': 10.1}])
def test_an_uncertain_turn_proves_nothing(interruption):
    checked = rested()
    checked.feed(512, 20, turn=2)
    checked.feed(512, turn=2, **interruption)
    assert checked.feed(512, 20, turn=2) is None
    # since then, the robot may have turned steadily
    assert checked.feed(512, 100, turn=2) is None


def test_a_turn_with_a_variance_that_is_small_enough_counts():
    checked = rested()
    assert checked.feed(512, 30, turn=2, deviation=9.9) == 23


def test_at_a_steady_rate_a_working_gyro_may_not_change():
    checked = Checked()
    assert checked.feed(400, 100, turn=2, shown=2) is None


def test_wheels_in_the_air_do_not_turn_the_robot():
    assert rested().feed(512, 100, turn=2, touched=True) is None


# a turn that the wheels do not make

@pytest.mark.parametrize('side', [1, -1])
@pytest.mark.parametrize('turn, commanded, fault', [
    (0, 0, True), (0.2, 0, True), (0, 0.2, True), (0.202, 0, False), (0, 0.202, False), (-1, -1, True)])
def test_a_shown_turn_of_90_degrees_of_which_the_wheels_make_less_than_a_tenth(side, turn, commanded, fault):
    checked = Checked()
    step = {'turn': side * turn, 'commanded': side * commanded, 'shown': side * 2.01}
    assert checked.feed(800, 44, **step) is None        # 88.4 degrees
    assert checked.feed(800, **step) == (1 if fault else None)


def test_a_robot_that_is_held_may_be_turned_by_hand():
    assert Checked().feed(800, 100, shown=2, touched=True) is None


def test_the_turn_that_a_faulty_gyro_did_not_show_is_known():
    checked = rested()
    checked.feed(900)
    assert checked.feed(900, 100, turn=0.1, shown=2.01, deviation=3) == 45
    assert checked.check.unseen == pytest.approx(radians(45 * (0.1 - 2.01)))
    assert checked.check.variance == pytest.approx(45 * radians(3) ** 2, rel=1e-6)      # and the first reading's


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


def test_a_gyro_that_was_stuck_must_first_have_changed():
    checked = rested()
    checked.feed(600, turn=2)
    checked.feed(512, rest=True)
    assert checked.feed(512, 30, turn=2)
    checked.feed(513, 3 * SECOND, rest=True)
    assert checked.check.problem
    checked.feed(515, SECOND + 1, rest=True)
    assert not checked.check.problem


def test_after_a_repair_the_same_fault_is_logged_again():
    checked = broken()
    checked.feed(512, SECOND + 1, rest=True)
    assert checked.feed(900, SECOND, rest=True) == 10
    assert len(checked.errors) == 2
