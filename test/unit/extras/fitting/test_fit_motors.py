"""Delay, lag, acceleration limit and drag are fitted to commands and odometry."""
import re

from hypothesis import Phase, given, settings, strategies as st
import numpy
import pytest

from rbx1_nav.extras.fitting.motor_fit import differing, fit_motors, standard_errors
from rbx1_nav.extras.fitting.run import MOTORS
from sample_runs import DRIVE, EXERCISE, FLOOR, FORWARD, REST, record

START = FLOOR._replace(lag=0.1, accel_limit=1.0, drag_straight=0.002, drag_turning=0.003, delay=0.0)


@settings(max_examples=6, phases=[Phase.generate])       # a fit takes a second: too long to shrink
@given(st.floats(0.0, 0.6), st.floats(0.03, 0.3), st.floats(0.3, 0.7), st.floats(0.001, 0.03), st.floats(0.001, 0.03))
def test_motors_are_found(delay, lag, limit, straight, turning):
    surface = FLOOR._replace(delay=delay, lag=lag, accel_limit=limit, drag_straight=straight, drag_turning=turning)
    fit = fit_motors(START, 0.26, [record(DRIVE, surface=surface)])
    for key in MOTORS:
        if key not in fit.unused:
            # 5 standard errors, since rounding to ticks is not normal noise; a limit may hide a lag of 0.03 s
            assert fit.values[key] == pytest.approx(getattr(surface, key), abs=5 * fit.errors[key]), key
            assert fit.errors[key] < max(0.02 * getattr(surface, key), 5e-3), key
    assert not {'delay', 'lag', 'drag_straight', 'drag_turning'} & set(fit.unused)
    # less than a tick, 0.24 mm
    assert fit.rms < 2e-4


def test_a_run_without_a_turn_does_not_tell_the_drag_in_turns():
    fit = fit_motors(START, 0.26, [record((REST, FORWARD, REST, FORWARD, REST))])
    assert 'drag_turning' in fit.unused and 'drag_straight' not in fit.unused


def test_a_limit_that_is_never_reached_is_not_told():
    surface = FLOOR._replace(accel_limit=5.0)
    fit = fit_motors(START, 0.26, [record(EXERCISE, surface=surface)])
    assert 'accel_limit' in fit.unused
    assert fit.values['lag'] == pytest.approx(surface.lag, rel=0.02)


def test_recordings_of_two_floors_are_named():
    late, early = FLOOR._replace(delay=0.25), FLOOR._replace(delay=0.08)
    recordings = [record(motions, seed, floor, f'{seed}.bag') for seed, (motions, floor) in enumerate(
        [(DRIVE, late), (EXERCISE, early), (DRIVE, early), (EXERCISE, late)])]
    text, = differing(fit_motors(START, 0.26, recordings), START, 0.26, recordings)
    assert re.fullmatch(r'delay 0\.0[78]\d+ in 1\.bag, 2\.bag and 0\.2[45]\d* in 0\.bag, 3\.bag: expected recordings '
                        'of one robot on one floor', text)
    one = recordings[1:3]
    assert differing(fit_motors(START, 0.26, one), START, 0.26, one) == []
    assert differing(fit_motors(START, 0.26, one[:1]), START, 0.26, one[:1]) == []


@pytest.mark.parametrize('limit', [1.4, 1.7, 2.0, 2.3])
def test_a_limit_that_is_hardly_reached_is_right_or_not_told(limit):
    surface = FLOOR._replace(accel_limit=limit, lag=0.186, drag_straight=0.002)
    fit = fit_motors(START, 0.26, [record(DRIVE, surface=surface)])
    assert 'accel_limit' in fit.unused or fit.values['accel_limit'] == pytest.approx(
        limit, abs=5 * fit.errors['accel_limit'])


def test_standard_errors_allow_for_residuals_that_are_larger_where_the_slope_is():
    generator = numpy.random.default_rng(4)
    # one interval in ten is a start, with all of the slope and nearly all of the error
    slopes, sigma = (numpy.tile([value] + 9 * [rest], 200) for value, rest in ((1.0, 0.0), (1.0, 0.01)))
    left = generator.normal(0.0, sigma)
    left -= slopes * (slopes @ left) / (slopes @ slopes)        # the residuals of a fit
    error, = standard_errors(slopes[:, None], left, numpy.array([2000]))
    # its 1 sigma error is 5 %; the variance of all residuals would yield a third of it
    assert error >= 0.85 / 200 ** 0.5


def test_commands_of_another_run_leave_a_large_residual():
    run = record(DRIVE)
    other = run._replace(commands=record(EXERCISE).commands)
    assert fit_motors(START, 0.26, [run]).rms < 2e-4 < 0.01 < fit_motors(START, 0.26, [other]).rms
