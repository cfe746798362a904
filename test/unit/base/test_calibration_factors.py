"""Correction factors are calculated from the reported and the measured values."""
from math import inf, nan, pi

from hypothesis import given, strategies as st
import pytest

from rbx1_nav.base.calibration_factors import MAX_GAP, corrected, read_measured, turn_by_gyro
from rbx1_nav.node.config import ConfigError


def rejection(function, *arguments):
    """Return the text of the ConfigError that a call raises."""
    with pytest.raises(ConfigError) as error:
        function(*arguments)
    assert str(error.value).isprintable()
    return str(error.value)


def measured(value):
    """Return the measured result of a drive of 1 m."""
    return read_measured('measured', value, 1.0, 'a distance', 'm')


@pytest.mark.parametrize('value', [0.955, '0.955', ' 0.955\r', '9.55e-1', '.955'])
def test_a_number_may_be_text(value):
    assert measured(value) == 0.955


@pytest.mark.parametrize('unit, text', [('m', '0.955 m'), ('m', '0.955m '), ('degrees', '0.955 degrees'),
                                        ('degrees', '0.955deg'), ('degrees', '0.955°'), ('degrees', '0.955 ')])
def test_its_unit_may_follow(unit, text):
    assert read_measured('measured', text, 1.0, 'a result', unit) == 0.955


@pytest.mark.parametrize('text', ['0,96', '1,000.5 m'])
def test_a_comma_is_not_guessed(text):
    assert rejection(measured, text) == f"measured: '{text}': expected a decimal point, not a comma"


@pytest.mark.parametrize('value, shown', [
    (96, '96'), ('96', '96.0'), ('0.49', '0.49'), (-1, '-1'), (nan, 'nan'), ('nan', 'nan'), ('inf', 'inf'),
    (True, 'True'), ('', "''"), ('95 cm', "'95 cm'"), ('m', "'m'"), ('1 deg', "'1 deg'"), ('1 m m', "'1 m m'"),
    (None, 'None'), ([1], '[1]')])
def test_what_is_no_such_distance_is_rejected(value, shown):
    text = rejection(measured, value)
    assert text.startswith(f'measured: {shown}') and text.endswith('expected a distance from 0.5 to 2 in m')


@given(true=st.floats(0.55, 1.8), factor=st.floats(0.3, 3), sensitivity=st.floats(0.5, 2))
def test_with_the_new_factor_the_sensor_reports_what_is_measured(true, factor, sensitivity):
    raw = true * sensitivity
    new = corrected('scale', factor, true, raw * factor)
    assert raw * new == pytest.approx(true)


@pytest.mark.parametrize('reported', [0.0, 1e-3, -1.0, 1e3])
def test_a_sensor_that_reports_something_else_has_no_factor(reported):
    assert 'expected a factor from 0.1 to 10' in rejection(corrected, 'scale', 1.0, 1.0, reported)


@pytest.mark.parametrize('factor', [0.1, 10.0])
def test_a_factor_may_be_at_a_limit(factor):
    assert corrected('scale', 1.0, factor, 1.0) == factor


def readings(bias, scale, rest=2.0, period=0.02):
    """Return the readings of a gyro that rests, turns by 2 pi rad in 10 s, and rests for 1 s."""
    steps = [(rest, 0.0), (10.0, 2 * pi / 10), (1.0, 0.0)]
    rates = [rate * scale + bias for duration, rate in steps for _ in range(round(duration / period))]
    return [(100 + index * period, rate) for index, rate in enumerate([bias] + rates)]


def by_gyro(every, start):
    """Return the measured turn of a robot that turns once."""
    return turn_by_gyro(every, start, start + 11.0, 2 * pi)


@given(bias=st.floats(-0.1, 0.1), scale=st.floats(0.5, 2), rest=st.sampled_from([1.0, 2.0]),
       period=st.sampled_from([0.02, 1 / 30, 0.1]))
def test_the_bias_of_a_gyro_is_no_turn(bias, scale, rest, period):
    assert by_gyro(readings(bias, scale, rest, period), 100.0 + rest) == pytest.approx(2 * pi * scale)


def test_the_period_of_the_readings_may_vary():
    every = readings(0.01, 1.0)
    # the sensor reports the mean since its last reading; two readings at rest and two in the turn are missing
    assert by_gyro([each for index, each in enumerate(every) if index not in (7, 8, 300, 301)],
                   102.001) == pytest.approx(2 * pi)


def test_a_gyro_that_fell_silent_has_no_turn():
    every = readings(0.0, 1.0)
    gap = [each for each in every if not 103.99 < each[0] < 104.11 + MAX_GAP]
    assert rejection(by_gyro, gap, 102.001) == '0.64 s between two readings: expected at most 0.5 s'
    assert rejection(by_gyro, every[:500], 102.001) == 'no reading in the last 3.0 s of the turn'


def test_a_clock_that_jumped_back_has_no_turn():
    every = readings(0.0, 1.0)
    assert '-1.00 s between two readings' in rejection(
        by_gyro, every[:300] + [(time - 1.02, rate) for time, rate in every[300:]], 102.001)


@pytest.mark.parametrize('rest, start', [(0.5, 100.501), (2.0, 99.0)])
def test_a_gyro_that_was_not_at_rest_has_no_bias(rest, start):
    assert 'expected at least 1 s of readings' in rejection(by_gyro, readings(0.0, 1.0, rest), start)


@pytest.mark.parametrize('rate', [nan, inf])
def test_readings_that_are_not_finite(rate):
    assert 'expected finite readings' in rejection(by_gyro, readings(0.0, 1.0) + [(113.1, rate)], 102.001)


@pytest.mark.parametrize('scale', [0.0, 0.05, -0.09])
def test_a_gyro_that_reports_no_turn(scale):
    assert rejection(by_gyro, readings(0.01, scale), 102.001).startswith('the gyro reports no turn (')
