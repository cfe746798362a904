"""Surface files are read in SI units, and rejected with one line if a value is invalid."""
import os
from math import nan, radians
from statistics import mean, stdev

import pytest
import yaml

from rbx1_nav.base.surfaces import KEYS, Surface, known_surfaces, load_surface, read_surface
from rbx1_nav.node.config import ConfigError
from rbx1_nav.simulation.slip import draw_run, read_seed

FOLDER = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'surfaces')
OPTIONAL = list(Surface._field_defaults)
KNOWN = ', '.join(known_surfaces(FOLDER))


def carpet():
    with open(os.path.join(FOLDER, 'low_ply_carpet.yaml')) as file:
        return yaml.safe_load(file)


def test_all_surfaces_of_the_package_can_be_read():
    names = known_surfaces(FOLDER)
    assert KEYS['gyro_bias'].from_si(radians(2)) == pytest.approx(2) and KEYS['lag'].from_si(2) == 2
    assert names == sorted(names) and {'create_lab_floor', 'hard_floor', 'ideal', 'low_ply_carpet'} <= set(names)
    assert load_surface('ideal', FOLDER) is None
    for name in set(names) - {'ideal'}:
        assert load_surface(name, FOLDER).name == name


@pytest.mark.parametrize('name', ['sand', '', 'ideal.yaml', '../turtlebot', 7, None, [1],
                                  pytest.param(16 ** 1000, id='huge')])
def test_an_unknown_surface_is_rejected_with_the_list_of_known_ones(name):
    with pytest.raises(ConfigError, match=f'^surface: .*expected one of {KNOWN}, or the') as error:
        load_surface(name, FOLDER)
    assert '\n' not in str(error.value)


def test_a_path_without_a_file_is_rejected_as_such():
    with pytest.raises(ConfigError, match="^surface: '/no/such/file.yaml': no such file: expected .*, or one of "
                                          f"{KNOWN}$"):
        load_surface('/no/such/file.yaml', FOLDER)


def test_a_file_of_the_user_is_read(tmp_path):
    path = tmp_path / 'parquet.yaml'
    path.write_text(yaml.safe_dump(dict(carpet(), lag=0.2)))
    surface = load_surface(str(path), FOLDER)
    assert (surface.name, surface.lag) == ('parquet', 0.2)


@pytest.mark.parametrize('text', ['a: [', 'lag', '', '- 1', '\x00'])
def test_a_file_without_a_surface_is_rejected(tmp_path, text):
    path = tmp_path / 'broken.yaml'
    path.write_text(text)
    with pytest.raises(ConfigError, match='expected') as error:
        load_surface(str(path), FOLDER)
    assert '\n' not in str(error.value) and 'broken' in str(error.value)


@pytest.mark.parametrize('key, value', [
    ('lag', 0), ('lag', -1), ('lag', 1e9), ('accel_limit', nan), ('drag_turning', 0), ('slip_straight', -0.6),
    ('slip_turning', 0.6), ('slip_turning_spread', 'much'), ('slip_straight_spread', -0.1), ('ticks_meter', 0),
    ('ticks_meter', 1e308), ('gyro_noise', 0), ('gyro_noise', 1e-9), ('gyro_bias', 1e200), ('gyro_bias', -1),
    ('gyro_scale_error', True), ('gyro_measurement_range', []), ('delay', -0.1), ('delay', 6), ('curvature', 11),
    ('curvature', nan), ('turning_loss', -0.01), ('turning_loss', 'some'), ('heading_noise_turning', -0.1),
    ('heading_noise_turning', 2), ('heading_noise_straight', True), ('heading_noise_straight', -1e-9),
    ('distance_noise', 1.5), ('distance_noise', None)])
def test_an_invalid_value_is_named_with_its_key(key, value):
    with pytest.raises(ConfigError, match=f'^surface x/{key}: .*expected a '):
        read_surface(dict(carpet(), **{key: value}), 'x')


@pytest.mark.parametrize('key', set(KEYS) - set(OPTIONAL))
def test_a_missing_key_is_named(key):
    values = carpet()
    del values[key]
    with pytest.raises(ConfigError, match=f'surface x/{key}: missing'):
        read_surface(values, 'x')


def without_optional_keys():
    return {key: value for key, value in carpet().items() if key not in OPTIONAL}


def test_a_file_without_the_optional_keys_is_valid_and_they_are_0():
    surface = read_surface(without_optional_keys(), 'x')
    assert [getattr(surface, key) for key in OPTIONAL] == [0.0] * len(OPTIONAL)
    assert read_surface(dict(without_optional_keys(), **dict.fromkeys(OPTIONAL, 0)), 'x') == surface


def test_a_misspelled_key_is_named_with_a_suggestion():
    values = carpet()
    values['lagg'] = values.pop('lag')
    with pytest.raises(ConfigError, match=r'^surface x/lagg \(did you mean lag\?\): unknown: expected only lag, '):
        read_surface(values, 'x')


@pytest.mark.parametrize('seed', [-1, 2 ** 31, 1.5, '-7', '99999999999', '7.0', '', True, None])
def test_a_seed_that_is_no_integer_in_its_range_is_rejected(seed):
    with pytest.raises(ConfigError, match='^seed: .*expected random, or an integer from 0 to 2147483647'):
        read_seed(seed)


def test_random_draws_a_seed_each_time():
    seeds = {read_seed('random') for _ in range(20)}
    # twenty equal seeds out of a million are practically impossible
    assert len(seeds) > 1
    assert all(read_seed(seed) == read_seed(str(seed)) == seed for seed in seeds | {0, 2 ** 31 - 1})


def test_the_errors_of_a_run_depend_on_the_seed_only():
    surface = load_surface('low_ply_carpet', FOLDER)
    assert draw_run(surface, 7) == draw_run(surface, 7) != draw_run(surface, 8)


def test_the_errors_of_runs_have_mean_and_spread_of_the_file():
    surface = load_surface('hard_floor', FOLDER)
    columns = list(zip(*[draw_run(surface, seed) for seed in range(2000)]))
    # over 2000 runs, 1 sigma of the mean is 0.022 spreads, of the spread 1.6 %: the limits are 5 sigma
    for values, middle, spread in zip(columns, (0.002, 0.005, 0, 0), (0.001, 0.002, radians(0.5), 0.003)):
        assert abs(mean(values) - middle) < 0.11 * spread
        assert stdev(values) == pytest.approx(spread, rel=0.08)
