"""Expected output compared with output."""
import pytest
from pages.expected import find, same


@pytest.mark.parametrize('expected, line', [
    ('[INFO] [1700000000.123]: out', '[INFO] [1800000000.5]: out'),
    ('[INFO] [1700000000.123]: out', '[INFO] [12]: out  '),
    ('x   0.52   y -1e-3', '  x -0.4 y 7'),
    ('log in /tmp/...', 'log in /tmp/x9/y'),
    ('100 %|...| 5/5', '100 %|#####| 9/9'),
    ('a.b (c) [d] *', 'a.b (c) [d] *'),
])
def test_same(expected, line):
    assert same(expected, line)


@pytest.mark.parametrize('expected, line', [
    ('out and back', 'out and back again'),
    ('at 1 m', 'at one m'),
    ('at 1 m', 'at m'),
    ('a.b', 'axb'),
    ('Wheels', 'wheels'),
])
def test_not_same(expected, line):
    assert not same(expected, line)


@pytest.mark.parametrize('line, tolerance, result', [
    ('0.10 m and 12 degrees', 0, True), ('0.1 m and 12.0 degrees', 0, True), ('0.11 m and 12 degrees', 0, False),
    ('0.15 m and 7.5 degrees', 5, True), ('0.16 m and 12 degrees', 5, False), ('0.10 m and 17.1 degrees', 5, False)])
def test_tolerance(line, tolerance, result):
    """In units of the last decimal of each number of the line."""
    assert same('0.10 m and 12 degrees', line, tolerance) is result


def test_find():
    """In this order, with other lines between."""
    lines = ['one', 'two', 'three', 'two']
    assert find(['one', '', '...', 'three', 'two'], lines) == ([0, 2, 3], None)
    assert find(['two', 'one'], lines) == ([1], 'one')
    assert find(['two', 'two', 'two'], lines) == ([1, 3], 'two')
