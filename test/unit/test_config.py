"""Reading configuration: values as they are, and one line that names the key, the value and what is expected."""
from math import inf, nan

import pytest

from rbx1_nav.config import ConfigError, Section, positive


def rejection(function, *arguments, **options):
    """The text of the ConfigError that a call raises."""
    with pytest.raises(ConfigError) as error:
        function(*arguments, **options)
    assert '\n' not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize('text, number', [
    ('1e-1', '1.0e-1'), ('1e5', '1.0e+5'), ('-2.5e3', '-2.5e+3'), (' 3E2', '3.0e+2'), ('0.26', '0.26 without quotes')])
def test_a_number_that_is_text_to_yaml_gets_a_hint(text, number):
    expected = 'base_width: %r (text to YAML: write %s): expected a finite number above 0' % (text, number)
    assert rejection(positive, 'base_width', text) == expected


@pytest.mark.parametrize('text', ['wide', 'nan', '', '1e999'])
def test_other_text_gets_no_hint(text):
    assert rejection(positive, 'base_width', text) == 'base_width: %r: expected a finite number above 0' % text


@pytest.mark.parametrize('value', [0, -1, nan, inf, True, None, [1.0]])
def test_positive_rejects_everything_but_finite_numbers_above_0(value):
    assert rejection(positive, 'rate', value) == 'rate: %r: expected a finite number above 0' % value


def test_positive_returns_a_float():
    assert positive('rate', 5) == 5.0 and isinstance(positive('rate', 5), float)


def test_a_closed_range_includes_its_lower_end():
    assert Section({'timeout': 0}).number('timeout', closed=True, high=2.0) == 0.0
    assert Section({'timeout': 2.0}).number('timeout', closed=True, high=2.0) == 2.0
    rejection(Section({'timeout': 2.1}).number, 'timeout', closed=True, high=2.0)


def test_only_a_default_may_be_infinite():
    assert Section({}).number('max_speed', inf) == inf
    rejection(Section({'max_speed': inf}).number, 'max_speed', inf)


def test_a_key_is_named_as_rosparam_spells_it():
    section = Section({'a': {'b': {'c': -1}}}).section('a').section('b')
    assert rejection(section.number, 'c').startswith('a/b/c: -1: expected')
    assert rejection(section.number, 'd').startswith('a/b/d: missing: expected')


@pytest.mark.parametrize('value', ['true', 1, 0, None])
def test_a_flag_is_true_or_false(value):
    assert Section({'flag': False}).flag('flag', True) is False and Section({}).flag('flag', True) is True
    assert rejection(Section({'flag': value}).flag, 'flag', True) == 'flag: %r: expected true or false' % value


def test_a_frame_loses_its_leading_slash():
    assert Section({'frame': '/robot/odom'}).frame('frame', 'odom') == 'robot/odom'
    assert Section({}).frame('frame', 'odom') == 'odom'


@pytest.mark.parametrize('value', ['', '/', 'a b', 7, 'odom/', None])
def test_a_name_that_no_frame_can_have_is_rejected(value):
    assert rejection(Section({'frame': value}).frame, 'frame', 'odom') == (
        'frame: %r: expected the name of a frame' % value)


def test_keys_are_sorted_into_read_hardware_and_unknown():
    section = Section({'rate': 50, 'port': '/dev/ttyUSB0', 'time_out': 2}, 'base', hardware={'port', 'baud'})
    section.number('rate')
    assert section.ignored() == ['base/port'] and section.unknown() == ['base/time_out']


@pytest.mark.parametrize('values', [7, [], 'text', None])
def test_a_section_is_a_mapping(values):
    assert rejection(Section, values) == 'configuration: %r: expected a mapping of keys to values' % (values,)
    assert rejection(Section, values, 'joints') == 'joints: %r: expected a mapping of keys to values' % (values,)
