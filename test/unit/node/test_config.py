"""Reading configuration: a value is returned, or an error of one line names the key, the value and what is expected."""
from math import inf, nan

import pytest

from rbx1_nav.node.config import ConfigError, Section, load_yaml, show_name, suggestion


def rejection(function, *arguments, **options):
    """The text of the ConfigError that a call raises."""
    with pytest.raises(ConfigError) as error:
        function(*arguments, **options)
    assert str(error.value).isprintable() and len(str(error.value)) < 1000
    return str(error.value)


def number(key, value):
    """A number from 0.5 to 10."""
    return Section({key: value}).number(key, 0.5, 10, what='a width', unit='m')


@pytest.mark.parametrize('text, hint', [
    ('1e-1', '1.0e-1'), ('1e5', '1.0e+5'), ('-2.5e3', '-2.5e+3'), (' 3E2', '3.0e+2'), ('0.26', '0.26 without quotes')])
def test_a_number_that_is_text_to_yaml_gets_a_hint(text, hint):
    expected = f'base_width: {text!r} (text to YAML: write {hint}): expected a width from 0.5 to 10 in m'
    assert rejection(number, 'base_width', text) == expected


@pytest.mark.parametrize('text', ['wide', 'nan', '', '1e', '1 2'])
def test_other_text_gets_no_hint(text):
    assert rejection(number, 'base_width', text) == f'base_width: {text!r}: expected a width from 0.5 to 10 in m'


@pytest.mark.parametrize('value', [0, 0.49, 11, -1, nan, inf, -inf, 1e-320, True, None, [1.0]])
def test_a_number_is_in_its_range(value):
    assert rejection(number, 'rate', value) == f'rate: {value!r}: expected a width from 0.5 to 10 in m'


def test_a_choice_is_one_of_several_values():
    assert Section({}).choice('baud', (300, 19200), 300) == 300
    value = Section({'baud': 19200.0}).choice('baud', (300, 19200), 300)
    assert value == 19200 and isinstance(value, int)
    for value in (301, '300', True, [300], None):
        assert rejection(Section({'baud': value}).choice, 'baud', (300, 19200), 300) == (
            f'baud: {value!r}: expected one of 300, 19200')


def test_only_a_default_may_be_out_of_range():
    assert Section({}).number('max_speed', 1, 2, inf) == inf
    rejection(Section({'max_speed': inf}).number, 'max_speed', 1, 2, inf)


def test_a_key_is_named_as_rosparam_spells_it():
    section = Section({'a': {'b': {'c': -1}}}).section('a').section('b')
    assert rejection(section.number, 'c', 0, 1).startswith('a/b/c: -1: expected')
    assert rejection(section.number, 'd', 0, 1).startswith('a/b/d: missing: expected')


@pytest.mark.parametrize('value', ['true', 1, 0, None])
def test_a_flag_is_true_or_false(value):
    assert Section({'flag': False}).flag('flag', True) is False and Section({}).flag('flag', True) is True
    assert rejection(Section({'flag': value}).flag, 'flag', True) == f'flag: {value!r}: expected true or false'


def test_a_frame_loses_its_leading_slash():
    assert Section({'frame': '/robot/odom'}).frame('frame', 'odom') == 'robot/odom'
    assert Section({}).frame('frame', 'odom') == 'odom'


@pytest.mark.parametrize('value', ['', '/', 'a b', 7, 'odom/', None, 'odom\n', 'a\0b', 'a\x1b[1m'])
def test_a_name_that_no_frame_can_have_is_rejected(value):
    assert rejection(Section({'frame': value}).frame, 'frame', 'odom') == (
        f'frame: {value!r}: expected the name of a frame')


def test_keys_are_sorted_into_read_hardware_and_unknown():
    section = Section({'rate': 50, 'port': '/dev/ttyUSB0', 'time_out': 2}, 'base', hardware={'port', 'baud'})
    section.number('rate', 1, 100)
    assert section.ignored() == ['base/port'] and section.unknown() == ['base/time_out']


@pytest.mark.parametrize('values', [7, [], 'text', None])
def test_a_section_is_a_mapping(values):
    assert rejection(Section, values) == f'configuration: {values!r}: expected a mapping of keys to values'
    assert rejection(Section, values, 'joints') == f'joints: {values!r}: expected a mapping of keys to values'


@pytest.mark.parametrize('key, shown', [
    ('two\nlines', r"'two\nlines'"), ('\x1b[31m', r"'\x1b[31m'"), (7, '7'),
    ('radius of the wheel', 'radius of the wheel')], ids=lambda value: type(value).__name__)
def test_a_key_is_shown_in_one_line(key, shown):
    assert Section({key: 1}, 'base').unknown() == [f'base/{shown}'] and show_name(key) == shown
    assert rejection(Section({key: 0}).flag, key, True).startswith(f'{shown}: 0: ')


@pytest.mark.parametrize('text', ['a: [', '\0', '!!bool x', "!!int ''", '!!timestamp x', '? {a: b}', '[' * 10 ** 5,
                                  '\udcff'])
def test_a_file_that_is_not_yaml(tmp_path, text):
    path = tmp_path / 'a.yaml'
    path.write_bytes(text.encode('utf-8', 'surrogateescape'))
    assert rejection(load_yaml, str(path)).startswith('expected a YAML file: ')


def test_an_unknown_key_gets_a_suggestion():
    section = Section({'time_out': 1, 'colour': 'red', 7: 8}, 'base')
    section.number('timeout', 0, 10, 1.0)
    assert section.unknown() == ['base/time_out (did you mean timeout?)', 'base/colour', 'base/7']


@pytest.mark.parametrize('name, known', [
    ('sm', 'sim'), ('im', 'sim'), ('simm', 'sim'), ('smi', 'sim'), ('ism', 'sim'), ('sin', 'sim'), ('rtae', 'rate'),
    ('raet', 'rate'), ('rat', 'rate'), ('ate', 'rate'), ('rates', 'rate'), ('rats', 'rate'), ('pott', 'port'),
    ('time', 'timeout'), ('tiemout', 'timeout'), ('timeouts', 'timeout'), ('jiont', 'joints'),
    ('base_frame', 'base_frame_id'), ('speed', 'seed')])
def test_a_typo_gets_a_suggestion(name, known):
    assert suggestion(name, ['controllers', known]) == f' (did you mean {known}?)'


@pytest.mark.parametrize('name, other', [
    ('imu', 'sim'), ('ties', 'time'), ('usb', 'sim'), ('', 'sim'),
    ('colour', 'controllers')])
def test_another_word_gets_none(name, other):
    assert suggestion(name, [other]) == ''
