"""A fault of a TurtleBot's gyro, at rest or in motion, is detected, and a working gyro is never reported as faulty."""
from math import degrees, pi, radians

import pytest

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.create.analog_gyro import FEW
from rbx1_nav.extras.create.emulator.body import BodyErrors

from driven_create import SURFACES, DrivenCreate, started

PERIOD = 1 / 30     # s between two readings
PROOF = (FEW + 2) * PERIOD      # s until enough readings have arrived


def calibrated(seconds=4.0, **params):
    """Return a robot whose gyro has an offset."""
    driven = started('create', seconds, gyro_scale_correction=1.0, **params)
    assert driven.states[-1].gyro
    return driven


def lines(driven):
    """Return the log lines about the gyro."""
    return [line for line in driven.log if line.startswith('Gyro')]


def read(driven, seconds, count):
    """Hold the analog input at a count. Returns the reported rates (degrees/s), and the times (s) at which a problem
    was first and last detected, or None."""
    driven.body.gyro_stuck = count
    first, start = len(driven.states), driven.now
    seen = []
    while driven.now < start + seconds * 1e9:
        driven.run(0.01)
        if driven.driver.gyro.problem:
            seen.append((driven.now - start) / 1e9)
    # this reading was made before the input changed
    states = driven.states[first + 1:]
    rates = [degrees(state.gyro.rate) for state in states if state.gyro]
    return (rates, seen[0], seen[-1]) if seen else (rates, None, None)


def turn(driven, rate, angle):
    """Turn by an angle (rad) at a rate (rad/s), then rest."""
    driven.drive(0, rate, angle / abs(rate))
    driven.command_zero()
    driven.run(2)


# no power

@pytest.mark.parametrize('velocity, rest, count, text', [
    *((velocity, 4, count, '%d counts: expected at least 100: does it have power?')
      for velocity in ((0, 0), (0.2, 0), (0, 0.5), (0, 1.0), (0, -1.0), (0.2, 0.5)) for count in (0, 12, 99)),
    *(((0, 0), rest, count, '%d counts at rest: expected 425 to 575')
      for rest in (4, 40) for count in (101, 424, 576, 900, 1023))])
def test_no_power_and_a_jump_at_rest_are_noticed_at_once_however_long_the_gyro_was_right(velocity, rest, count, text):
    driven = calibrated(rest)
    driven.velocity = velocity
    driven.run(1)
    rates, first, _ = read(driven, 2, count)
    assert rates == [] and first < PROOF
    assert lines(driven) == driven.errors == [f'Gyro: {text % count}; using the wheels alone for the heading']
    assert driven.driver.gyro.yaw == pytest.approx(driven.truth.yaw, abs=0.05 if any(velocity) else 0.001)


def test_one_corrupted_reading_is_not_a_gyro_without_power():
    driven = calibrated()
    driven.velocity = 0, 0.5
    driven.run(1)
    rates, first, _ = read(driven, 0.06, 12)
    assert rates == [] and not first
    rates, first, _ = read(driven, 1, -1)
    assert not first and len(rates) > 25 and not lines(driven)


def test_a_fast_turn_is_not_a_gyro_without_power():
    driven = calibrated()
    turn(driven, 2.5, 8 * pi)       # 143 degrees/s: a count of 23
    assert not lines(driven) and driven.driver.gyro.yaw == pytest.approx(driven.truth.yaw, abs=0.1)
    assert all(abs(state.gyro.rate) < radians(121) for state in driven.states if state.gyro)


@pytest.mark.parametrize('mode, errors', [(1, 0), (2, 1)])
def test_a_gyro_that_never_has_power(mode, errors):
    """In passive mode, the base does not switch the power on."""
    driven = DrivenCreate('create', operation_mode=mode)
    driven.body.gyro_stuck = 12
    driven.connect()
    driven.run(3)
    assert ['12 counts' in error for error in driven.errors] == errors * [True]
    assert not any(state.gyro for state in driven.states)


# at rest

@pytest.mark.parametrize('mode', [2, 3])
def test_who_lifts_the_robot_may_turn_it(mode):
    driven = calibrated(operation_mode=mode)
    offset = driven.driver.gyro.offset
    driven.body.switches = 8
    driven.run(0.1)
    rates, first, _ = read(driven, 5, 300)      # 62 degrees/s
    assert not first and not lines(driven) and rates[-1] == pytest.approx(62, abs=1)
    driven.body.gyro_stuck = -1
    driven.run(0.1)
    driven.body.switches = 0
    driven.run(2)
    assert driven.driver.gyro.offset == pytest.approx(offset, abs=0.1) and not lines(driven)


# in motion

@pytest.mark.parametrize('count', [150, 800, 900])
def test_a_wrong_reading_in_motion_is_noticed_at_the_next_stop(count):
    driven = calibrated()
    driven.velocity = 0.2, 0
    driven.run(1)
    read(driven, 2, count)
    driven.velocity = None
    driven.command_zero()
    _, first, _ = read(driven, 2, count)
    # half a second until the robot counts as stationary
    assert first < 0.7 + PROOF and len(lines(driven)) == 1


@pytest.mark.parametrize('bits', [3, 8])       # bumpers, wheel drop
@pytest.mark.parametrize('velocity, seconds, count', [((0.2, 0), 4, 800), ((0, 0), 1, 300)])
def test_a_turn_of_a_robot_that_is_held_or_lifted_is_not_judged(bits, velocity, seconds, count):
    driven = calibrated(stop_motors_on_bump=False, operation_mode=3)
    driven.velocity = velocity
    driven.run(1)
    driven.body.switches = bits
    driven.run(0.1)
    rates, first, _ = read(driven, seconds, count)
    assert len(rates) > 20 and not first and not lines(driven)


@pytest.mark.parametrize('surface, sensitivity, drops', [
    ('ideal', 1.5, True), ('low_ply_carpet', 0.5, False)])
def test_a_gyro_that_works_is_never_taken_for_broken(surface, sensitivity, drops):
    driven = started('create', 4, surface=load_surface(surface, SURFACES), drops_fractions=drops)
    driven.body.errors = BodyErrors(gyro_sensitivity=sensitivity)
    for linear, angular, seconds in [(0.5, 0, 6), (0.1, 0.2, 20), (0, 0.05, 20),
                                     (0, 0.3, 10), (0.3, -1, 10), (0, 2, 5)]:
        driven.drive(linear, angular, seconds)
        driven.command_zero()
        driven.run(1)
    assert not lines(driven)


# repaired

@pytest.mark.parametrize('broken, repaired', [(12, 512), (900, 512), (12, 530), (300, -1)])
@pytest.mark.parametrize('rest', [4, 40])
def test_it_works_again_after_a_second_at_rest_with_a_new_offset(rest, broken, repaired):
    driven = calibrated(rest)
    read(driven, 8, broken)
    assert driven.driver.gyro.problem
    rates, _, last = read(driven, 5, repaired)
    assert 0.9 < last < 1.2
    # 0 from the first reading on: the offset does not include any faulty reading
    assert lines(driven)[1:] == ['Gyro: working again'] and rates == [0] * len(rates) and len(rates) > 100
    assert driven.driver.gyro.offset == (512 if repaired < 0 else repaired)
    assert driven.driver.gyro.yaw == pytest.approx(0, abs=0.001)
    read(driven, 2, 560)        # a jump within the range at rest
    assert driven.driver.gyro.offset == 560


def test_in_motion_it_does_not_work_again():
    driven = calibrated()
    driven.velocity = 0.2, 0
    read(driven, 1, 12)
    rates, _, _ = read(driven, 5, -1)
    assert rates == [] and driven.driver.gyro.problem
    driven.velocity = None
    driven.command_zero()
    driven.run(2.5)
    assert lines(driven)[-1] == 'Gyro: working again' and driven.states[-1].gyro
