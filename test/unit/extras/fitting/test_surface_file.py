"""A fitted surface as a file is complete and readable, and its values are within the ranges of surface files."""
from math import isclose

from hypothesis import given, settings, strategies as st
import yaml

from rbx1_nav.base.surfaces import KEYS, Surface, read_surface
from rbx1_nav.extras.fitting.surface_file import surface_text, table
from rbx1_nav.extras.fitting.surface_fit import FitResult, Value

VALUES = {key: st.floats(*KEYS[key].limits) | st.sampled_from(KEYS[key].limits) for key in KEYS}      # in SI units
ERRORS = st.none() | st.floats(1e-9, 1e4)       # as a fraction of the value


@st.composite
def results(draw):
    """Draw a FitResult with arbitrary values, some of them fitted."""
    values = []
    for key in KEYS:
        value, part = draw(VALUES[key]), draw(ERRORS)
        values.append(Value(key, value, part and part * max(abs(value), 1e-6), None if part else 'no gyro'))
    surface = Surface('x', **{value.key: value.value for value in values})
    return FitResult(surface, values, draw(st.sampled_from([[], ['too far off']])), 'floor',
                  draw(st.sampled_from([[], ['a long note ' * 99]])))


@settings(max_examples=30)       # of 19 values each
@given(results())
def test_it_can_be_read_again(result):
    text = surface_text(result, 'low_ply_carpet', ['run1.bag', 'run\n2: x.bag'])
    surface = read_surface(yaml.safe_load(text), 'x')
    for value in result.values:
        # the file keeps two digits of the error, or six digits of a value without an error
        in_file = KEYS[value.key].from_si
        allowed = in_file(value.error) / 10 if value.error else 0.0
        assert isclose(in_file(getattr(surface, value.key)), in_file(value.value), rel_tol=1e-5,
                       abs_tol=max(allowed, 1e-9)), value
    assert max(map(len, text.splitlines())) <= 160


@settings(max_examples=30)       # of 19 values each
@given(results())
def test_each_value_is_explained(result):
    lines = surface_text(result, 'low_ply_carpet', ['run1.bag']).splitlines()
    for value in result.values:
        line, = (each for each in lines if each.startswith(f'{value.key}:'))
        assert ('fitted, +- ' in line) == (value.error is not None) == ('not fitted: no gyro' not in line)
    assert any('too far off' in line for line in lines) == bool(result.warnings)
    printed = table(result, 'low_ply_carpet')
    assert sum(line.split()[0] in KEYS for line in printed if line.split()) == len(KEYS)
