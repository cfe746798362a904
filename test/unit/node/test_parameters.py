"""A parameter is declared once, and then checked, listed in the usage text, and given a row in the reference."""
from math import inf, pi

import pytest

from rbx1_nav.node.config import ConfigError, Section
from rbx1_nav.node.parameters import choice, custom, elsewhere, flag, frame, list_parameters, number, read, table

RATE = number('rate', 50, 'Hz', 'commands per second', 2, 1000, 'a rate')
SPEED = number('speed', 0.2, 'm/s', 'forward speed', note='see [limits](#limits)')


def check(parameter, **values):
    return read([parameter], Section(values))[parameter.name]


def rejection(parameter, **values):
    with pytest.raises(ConfigError) as error:
        check(parameter, **values)
    return str(error.value)


def test_a_number():
    assert check(RATE) == 50 and check(RATE, rate=2) == 2
    assert rejection(RATE, rate=1) == 'rate: 1: expected a rate from 2 to 1000 in Hz'
    assert rejection(SPEED, speed=0) == 'speed: 0: expected a number from 1e-06 to 1000000 in m/s'


def test_a_number_without_a_default():
    assert check(number('factor', None, '', '')) is None
    assert rejection(number('width', None, 'm', '', required=True)).startswith('width: missing: expected a number')
    assert check(number('limit', inf, 'm/s', '', 1, 2)) == inf


@pytest.mark.parametrize('parameter, right, wrong, expected', [
    (flag('strict', False, ''), True, 1, 'true or false'),
    (choice('kind', ('a', 'b'), 'a', ''), 'b', 'c', 'one of a, b'),
    (frame('odom_frame', 'odom', ''), 'map', 'a b', 'the name of a frame')])
def test_the_other_kinds(parameter, right, wrong, expected):
    assert str(check(parameter)).lower() == parameter.default
    assert check(parameter, **{parameter.name: right}) == right
    assert rejection(parameter, **{parameter.name: wrong}) == f'{parameter.name}: {wrong!r}: expected {expected}'


def test_a_check_of_its_own():
    def double(value):
        if value == 3:
            raise ConfigError('size: 3: expected an even number')
        return 2 * value
    size = custom('size', 1, '', double)
    assert check(size) == 2 and check(size, size=4) == 8 and rejection(size, size=3).startswith('size: 3')


def test_the_lines_of_a_usage_text():
    angle = number('goal_angle', pi, 'rad', 'angle of a turn', shown='pi')
    known = custom('surface', 'ideal', 'the floor', str, range=lambda: 'ideal, carpet')
    assert list_parameters([RATE, SPEED, angle, known, elsewhere('sim', 'ignored')]) == """\
Parameters:
    ~rate         commands per second (Hz; 2 to 1000; default: 50)
    ~speed        forward speed (m/s; default: 0.2)
    ~goal_angle   angle of a turn (rad; default: pi)
    ~surface      the floor (ideal, carpet; default: ideal)
    ~sim          ignored"""
    assert list_parameters([]) == ''


def test_a_table():
    assert table([RATE, SPEED])[2:] == [
        '| `~rate` | 50 Hz | commands per second (2 to 1000) |',
        '| `~speed` | 0.2 m/s | forward speed; see [limits](#limits) |']
    assert table([number('width', None, 'm', 'base', 1, 2)])[2] == '| `~width` |  | base (1 to 2 m) |'
    assert table([RATE, RATE._replace(name='period'), SPEED])[2:4] == [
        '| `~rate`, `~period` | 50 Hz | commands per second (2 to 1000) |', table([SPEED])[2]]
    assert table([RATE], 'key')[0].startswith('| key |') and table([RATE], 'key')[2].startswith('| `rate` |')
