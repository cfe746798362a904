"""Units, and arithmetic on single numbers."""
from math import copysign, cos, inf, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.units import clamp, rounded, wrap_angle


@given(st.floats(allow_nan=False), st.floats(0, inf))
def test_a_clamped_value_is_within_the_limit_and_keeps_its_sign(value, limit):
    clamped = clamp(value, limit)
    assert -limit <= clamped <= limit and copysign(1, clamped) == copysign(1, value)
    if abs(value) <= limit:
        assert clamped == value
    else:
        assert abs(clamped) == limit


@given(st.floats(-100, 100))
def test_a_wrapped_angle_has_the_same_direction(angle):
    wrapped = wrap_angle(angle)
    assert -pi <= wrapped <= pi
    # an angle of 100 rad has a resolution of 1.4e-14
    assert (cos(wrapped), sin(wrapped)) == pytest.approx((cos(angle), sin(angle)), abs=1e-13)


@pytest.mark.parametrize('value, text', [(-0.0, '0.000'), (-0.0004, '0.000'), (-0.0006, '-0.001'), (0.0004, '0.000'),
                                         (-1.2345, '-1.234'), (2.0, '2.000')])
def test_a_rounded_number_has_no_minus_before_a_zero(value, text):
    assert f'{rounded(value, 3):.3f}' == text
