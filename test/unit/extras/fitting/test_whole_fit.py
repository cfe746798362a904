"""A fit to recordings: the values that are found, and the reasons for values that cannot be determined."""
from math import radians
import re

import numpy
import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.extras.fitting.end_poses import future_spreads, widening
from rbx1_nav.extras.fitting.gyro_fit import rests_at
from rbx1_nav.extras.fitting.surface_file import PARTS
from rbx1_nav.extras.fitting.surface_fit import WholeFit
from rbx1_nav.node.config import ConfigError
from sample_runs import DRIVE, EXERCISE, FLOOR, FORWARD, REST, record, wrapped

START = FLOOR._replace(name='start', lag=0.2, delay=0.0, drag_straight=0.002, drag_turning=0.003, slip_straight=0.011,
                       slip_straight_spread=0.004, slip_turning=0.012, slip_turning_spread=0.005, curvature=0.0,
                       turning_loss=0.0, heading_noise_turning=0.0, heading_noise_straight=0.0, distance_noise=0.0,
                       gyro_noise=0.004, gyro_bias=0.05, gyro_scale_error=0.006)
TAPE = 0.01, 0.01, radians(2)   # m, m, rad


def fit(recordings, **options):
    """Return (FitResult, {key: Value})."""
    result = WholeFit(recordings, 0.26, START, **options).run()
    return result, {value.key: value for value in result.values}


def with_end(recording):
    """Return a Recording of which only the end pose is known."""
    end = Pose(recording.truth.x[-1], recording.truth.y[-1], wrapped(recording.truth.yaw[-1]))
    return recording._replace(truth=None, end=end)


def test_a_floor_is_found():
    result, values = fit([record(DRIVE, seed) for seed in range(4)])
    for key in ('slip_straight', 'slip_turning', 'curvature', 'turning_loss', 'heading_noise_turning',
                'heading_noise_straight', 'distance_noise', 'slip_straight_spread', 'slip_turning_spread'):
        # five standard errors: these four runs never change
        assert abs(values[key].value - getattr(FLOOR, key)) < 5 * values[key].error, key
    # accurate enough to be useful
    assert values['turning_loss'].error < 0.01 and values['heading_noise_turning'].error < 0.02
    # others: new keys, of which the fit knows nothing
    assert {key for key, value in values.items() if value.error is None} <= {
        'ticks_meter', 'gyro_measurement_range', 'gyro_scale_error', *dict(PARTS)['Others.']}
    assert result.warnings == []
    assert all(getattr(result.surface, key) == value.value for key, value in values.items())


def test_a_floor_is_found_without_odometry():
    floor = FLOOR._replace(drag_straight=0.002, drag_turning=0.003)
    _, values = fit([record(DRIVE, seed, floor)._replace(odometry=None) for seed in range(3)])
    for key in 'delay', 'slip_turning', 'turning_loss', 'heading_noise_turning':
        assert abs(values[key].value - getattr(FLOOR, key)) < 5 * values[key].error, key
    assert values['drag_straight'] == ('drag_straight', 0.002, None, 'no odometry')


def test_one_run_tells_no_spread():
    _, values = fit([record(DRIVE)])
    for key in 'slip_straight_spread', 'slip_turning_spread':
        assert values[key] == (key, getattr(START, key), None, '1 of at least 3 runs')
    for key in 'gyro_bias', 'gyro_scale_error':
        assert values[key] == (key, getattr(START, key), None, 'one run only')
    assert values['turning_loss'].error


def test_runs_without_a_turn():
    _, values = fit([record((REST, FORWARD, REST, FORWARD, REST), seed) for seed in range(3)])
    assert values['slip_turning_spread'][1:3] == (START.slip_turning_spread, None)
    assert values['drag_turning'] == ('drag_turning', START.drag_turning, None, 'no measurable effect in these runs')
    for key in 'slip_turning', 'turning_loss', 'gyro_scale_error':
        assert values[key].error is None and values[key].value == getattr(START, key), key
    assert values['slip_straight'].error


def test_a_turning_loss_without_effect_on_the_exercise_is_not_fitted():
    """Rounding to whole ticks looks like turns while driving, but the robot never turns while it drives."""
    _, values = fit([record(EXERCISE, seed, FLOOR._replace(turning_loss=0.035)) for seed in range(3)])
    assert values['turning_loss'] == ('turning_loss', START.turning_loss, None,
                                      'without effect on the end poses of these commands')
    assert values['slip_turning'].error


def test_a_large_spread_may_have_a_large_error():
    floor = FLOOR._replace(slip_turning_spread=0.12, heading_noise_turning=0.02)
    _, values = fit([record(DRIVE, seed, floor) for seed in range(5)])
    value = values['slip_turning_spread']
    assert value.error > 0.02 and abs(value.value - 0.12) < 3 * value.error


def test_runs_without_gyro_or_truth():
    _, values = fit([record(DRIVE)._replace(gyro=None, truth=None)])
    for key in 'gyro_noise', 'gyro_bias', 'gyro_scale_error':
        assert values[key] == (key, getattr(START, key), None, 'no gyro')
    for key in 'slip_straight', 'heading_noise_turning':
        assert values[key] == (key, getattr(START, key), None, 'not determined by these runs')
    assert values['drag_turning'].error


def test_neither_odometry_nor_truth_is_nothing_to_fit_to():
    with pytest.raises(ConfigError, match='^run: neither odometry nor truth: expected at least one'):
        fit([record(EXERCISE)._replace(odometry=None, truth=None)])


def test_all_runs_are_alike():
    with pytest.raises(ConfigError,
                       match='^other: no odometry, although run has it: expected the same data in all runs$'):
        fit([record(EXERCISE), record(EXERCISE, name='other')._replace(odometry=None)])


def test_ends_tell_slips_and_one_factor():
    result, values = fit([with_end(record(EXERCISE, seed)) for seed in range(3)], end_errors=TAPE)
    assert abs(values['slip_turning'].value - FLOOR.slip_turning) < 3 * values['slip_turning'].error
    # the spread contains the uncertainty of the mean after three runs
    assert values['slip_turning_spread'].value > values['slip_turning'].error
    # each noise has the error of the common factor, which is given once
    assert values['heading_noise_turning'][2:] == (None, 'multiplied by the common factor')
    assert re.match('The noises .* are multiplied by [0-9.]+ [+]- [0-9.]+, one common factor ', result.notes[0])
    assert values['curvature'].error is None
    assert f'by {widening(4):.2f} because 3 runs are few' in result.notes[0]    # x and y of three runs, without means


@pytest.mark.parametrize('degrees', [2, 4, 50])
def test_a_region_from_few_runs_is_wider(degrees):
    # the quantiles of F with 2 and n degrees of freedom, and of chi squared with 2, in closed form
    ratio = degrees * (0.1 ** (-2 / degrees) - 1) / (-2 * numpy.log(0.1))
    assert widening(degrees) == pytest.approx(ratio ** 0.5)


def test_spreads_of_future_runs_contain_what_the_fit_does_not_know():
    """The same as the deviations of slips that are drawn from what the fit knows."""
    surface = FLOOR._replace(slip_straight_spread=0.03, slip_turning_spread=0.05)
    errors = dict(slip_straight=0.02, slip_turning_spread=0.02)     # an upward error of 40 %
    generator = numpy.random.default_rng(2)
    drawn = 0.05 * 1.4 ** generator.standard_normal(100000) * generator.standard_normal(100000)
    found = future_spreads(surface, errors, 4)
    assert found['slip_straight_spread'] == pytest.approx(widening(4) * 13 ** 0.5 / 100)
    # the standard error of a deviation from 100,000 numbers is 0.3 %
    assert found['slip_turning_spread'] == pytest.approx(widening(4) * drawn.std(), rel=0.01)


def test_the_file_has_the_spreads_of_future_runs():
    floor = FLOOR._replace(slip_straight_spread=0.06, slip_turning_spread=0.09)
    result, values = fit([record(DRIVE, seed, floor) for seed in range(3)])
    found = dict(re.findall(r'(slip_\w+_spread): found ([\d.]+\d)', result.notes[0]))
    assert list(found) == ['slip_straight_spread', 'slip_turning_spread']
    for key, text in found.items():
        assert values[key].value == getattr(result.surface, key) > widening(2) * float(text), key


def test_a_truth_that_is_worse_in_motion_is_not_taken_for_noise_of_the_floor():
    def shaken(run, generator):
        moving = ~rests_at(run, run.truth.time, 0.75)
        return run._replace(truth=run.truth._replace(**{
            key: getattr(run.truth, key) + moving * generator.normal(0, sigma, len(moving))
            for key, sigma in (('x', 0.003), ('y', 0.003), ('yaw', 0.01))}))
    generator = numpy.random.default_rng(3)
    result, values = fit([shaken(record(DRIVE, seed), generator) for seed in range(4)])
    for key in 'heading_noise_turning', 'heading_noise_straight', 'distance_noise':
        assert abs(values[key].value - getattr(FLOOR, key)) < 3 * values[key].error, key
        assert values[key].error < 0.03, key
    text = 'The end poses of the windows have '
    assert result.notes[-1].startswith(text)
    exact, _ = fit([record(DRIVE, seed) for seed in range(4)])
    assert not exact.notes[-1].startswith(text)
