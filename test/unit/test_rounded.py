"""Numbers are printed without a minus before a zero."""
from hypothesis import given, strategies
import pytest

from rbx1_nav.units import rounded


@pytest.mark.parametrize('value, text', [(-0.0, '0.000'), (-0.0004, '0.000'), (-0.0006, '-0.001'), (0.0004, '0.000'),
                                         (-1.2345, '-1.234'), (2.0, '2.000')])
def test_a_table_of_numbers(value, text):
    assert '%.3f' % rounded(value, 3) == text


@given(strategies.floats(-1e6, 1e6))
def test_nothing_else_changes(value):
    assert '%.3f' % rounded(value, 3) in ('%.3f' % value, ('%.3f' % value).lstrip('-'))
    assert not ('%.3f' % rounded(value, 3)).startswith('-0.000')
