"""The values of a sweep, their combinations, and the row of a run."""
import os

import numpy
import pytest

from rbx1_nav.base.robot_parameters import Limits, load_robot
from rbx1_nav.extras.many_runs.cases import RESULTS, Case, add_rows, chunks, combine, read_sweep, simulate_row, units
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS, simulate
from rbx1_nav.extras.many_runs.summary import Summary
from rbx1_nav.extras.many_runs.sweep import Sweep
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.parameters import number
from sample_surface import SURFACE

TURTLEBOT = load_robot(os.path.join(os.path.dirname(__file__), '..', '..', '..', '..', 'config', 'turtlebot.yaml'))
DECLARED = [number('linear_speed', 0.2, 'm/s', 'speed'), number('rate', 50, 'Hz', 'rate', 2, 1000),
            number('transform_timeout', 5, 's', 'no effect without ROS')]


def test_all_combinations_of_surfaces_and_values_the_last_one_fastest():
    values = read_sweep(['linear_speed=0.1,0.2', 'gyro_noise=1,2'], DECLARED)
    assert units(list(values), DECLARED) == ['linear_speed (m/s)', 'gyro_noise (degrees/s)']
    found = combine({'a': SURFACE, 'b': SURFACE}, values)
    assert [each.title() for each in found[:3]] == ['a, linear_speed 0.1, gyro_noise 1',
                                                    'a, linear_speed 0.1, gyro_noise 2',
                                                    'a, linear_speed 0.2, gyro_noise 1']
    assert len(found) == 8 and found[4].surface_name == 'b'
    assert found[1].surface == SURFACE._replace(gyro_noise=pytest.approx(0.0349066))
    assert found[2].parameters == dict(PARAMETERS, linear_speed=0.2)


@pytest.mark.parametrize('texts, text', [
    (['lga=1'], r'--set: lga \(did you mean lag\?\): expected KEY=VALUE'),
    (['transform_timeout=1'], '--set: transform_timeout: expected KEY=VALUE'),
    (['lag'], "--set/lag: '': expected a number from 0.0001 to 60 in s"),
    (['lag=1,,2'], "--set/lag: '': expected"), (['lag=1', 'lag=2'], '--set: lag: given twice'),
    (['lag=1,1.0'], '--set: lag: 1: given twice'), (['lag=[1'], r"--set: lag: '\[1': expected a number"),
    (['lag=1e9x'], "--set/lag: '1e9x': expected"), (['lag=1e9'], '--set/lag: 1000000000.0: expected .* to 60 in s'),
    (['rate=1'], '--set/rate: 1: expected .* 2 to 1000'),
    (['slip_turning=0.6'], '--set/slip_turning: 0.6: expected a fraction from -0.5 to 0.5')])
def test_an_invalid_value_is_named(texts, text):
    with pytest.raises(ConfigError, match=text):
        read_sweep(texts, DECLARED)


def test_numbers_that_are_texts_to_yaml():
    assert read_sweep(['goal_distance=1e5,2', 'lag=5e-2'], [number('goal_distance', 1.0, 'm', 'a distance')]) == {
        'goal_distance': [1e5, 2.0], 'lag': [0.05]}


def test_a_combination_that_cannot_be_driven_is_named_before_the_first_run():
    with pytest.raises(ConfigError, match='--set: lag: the surface ideal has no such value'):
        combine({'ideal': None}, {'lag': [0.1]})
    with pytest.raises(ConfigError, match='--set: ideal, linear_speed 1000: goal_distance / .* 0.05 ticks'):
        combine({'ideal': None}, {'linear_speed': [0.2, 1000.0]})


def test_a_combination_that_is_too_fast_for_the_robot_is_named_before_the_first_run():
    combinations = combine({'ideal': None}, {'linear_speed': [0.5, 0.6], 'angular_speed': [3.8]})
    with pytest.raises(ConfigError, match='ideal, linear_speed 0.6, angular_speed 3.8: linear_speed: 0.6: '
                       'expected at most 0.5, max_linear_speed of --config'):
        Sweep(combinations, ['timed'], TURTLEBOT, range(1))
    assert Sweep(combinations[:1], ['timed'], TURTLEBOT, range(1)).total == 1
    with pytest.raises(ConfigError, match='angular_speed: 3.8: expected at most 3, max_angular_speed of --config'):
        Sweep(combinations[:1], ['timed'], TURTLEBOT._replace(limits=Limits(0.5, 3.0)), range(1))


def test_the_chunks_cover_each_run_once_in_the_order_of_the_file():
    found = list(chunks(combine({'a': SURFACE, 'b': SURFACE}, {}), ['timed', 'ekf'], range(5, 50005)))
    assert [(chunk.combination.surface_name, chunk.method) for chunk in found if chunk.is_last] == [
        ('a', 'timed'), ('a', 'ekf'), ('b', 'timed'), ('b', 'ekf')]
    # the wheels of a timed run are computed once for a chunk; a run with a filter takes long
    assert [len(chunk.seeds) for chunk in found[:26]] == 25 * [2000] + [200]
    assert [seed for chunk in found[:25] for seed in chunk.seeds] == list(range(5, 50005))
    assert [seed for chunk in found[25:275] for seed in chunk.seeds] == list(range(5, 50005))


@pytest.mark.parametrize('method', ['timed', 'ekf'])
def test_a_row_has_the_results_of_its_run(method):
    run = simulate(method, TURTLEBOT, SURFACE, 3)
    row = dict(zip(RESULTS, simulate_row(Case(method, TURTLEBOT, SURFACE, PARAMETERS), 3)))
    assert len(row) == len(RESULTS)
    assert (row['true_x (m)'], row['odometry_heading (rad)']) == (run.end.truth.x, run.end.odometry.yaw)
    assert (row['first_leg (m)'], row['time (s)']) == (run.first_leg, run.end.time)
    if method == 'ekf':
        assert row['estimate_y (m)'] == run.end.estimate.y
        assert row['covariance_y_heading (m rad)'] == run.covariance[1][2]
    else:
        assert row['estimate_y (m)'] is row['covariance_x_x (m^2)'] is None
    found, expected = Summary(), Summary()
    truths = add_rows(found, [tuple(row.values())])
    assert truths.tolist() == [list(run.end.truth)]
    expected.add(*(None if pose is None else numpy.array([pose])
                   for pose in (run.end.truth, run.end.odometry, run.end.estimate)), numpy.array([run.first_leg]))
    assert found.lines(method) == expected.lines(method)
