"""A number that stands on several pages is the same on each of them.

A comment right behind the number, such as 1.4 s<!-- key: exit_after_signal -->, gives it a key.
"""
import os
import re

import pytest
from pages import markdown

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..', '..'))
VALUE = r'(?P<value>\d+(?:\.\d+)?(?:[ \n]?(?:%|[A-Za-z]+|厘米|秒|度))?)'
KEYED = re.compile(VALUE + r'<!-- key: (?P<key>\w+) -->')
COMMENT = re.compile(r'<!--\s*key\b')
UNITS = {'厘米': 'cm', '秒': 's', '度': 'degrees'}


def numbers(text):
    """The numbers with a key in a text: (key, value with its unit)."""
    found = []
    for match in KEYED.finditer(text):
        number, unit = re.fullmatch(r'([\d.]+)\s?(.*)', match['value']).groups()
        found.append((match['key'], f'{number} {UNITS.get(unit, unit)}'.strip()))
    return found


def problems(pages):
    """The problems of pages, {path: text}: a comment that follows no number, a key with two values or one place."""
    found, places = [], {}
    for path, text in pages.items():
        keyed = numbers(text)
        if len(keyed) != len(COMMENT.findall(text)):
            found.append(f'{path}: a key without a number right before it')
        for key, value in keyed:
            places.setdefault(key, []).append((value, path))
    for key, values in places.items():
        if len({value for value, _ in values}) > 1:
            found.append(f'{key}: {values}')
        if len(values) == 1:
            found.append(f'{key}: only in {values[0][1]}')
    return found


def test_each_key_has_one_value_in_several_places():
    assert problems({path: markdown.read(ROOT, path) for path in markdown.files(ROOT, '.md')}) == []


@pytest.mark.parametrize('first, second, count', [
    ('within 1.4 s<!-- key: a -->.', '| 1.4 s<!-- key: a --> |', 0),
    ('48.2 cm<!-- key: a -->', '48.2 厘米<!-- key: a -->', 0),
    ('5<!-- key: a -->', '5<!-- key: a --> m', 0), ('1.4 s<!-- key: a -->', '1.5 s<!-- key: a -->', 1),
    ('1.4 s<!-- key: a -->', '1.4 ms<!-- key: a -->', 1), ('1.4 s<!-- key: a -->', '', 1),
    ('1.4 s <!-- key: a -->', '1.4 s<!-- key: a -->', 2), ('soon<!-- key: a -->', '', 1)])
def test_a_difference_is_a_problem(first, second, count):
    assert len(problems({'a.md': first, 'b.md': second})) == count
