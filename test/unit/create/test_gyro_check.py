"""The number of readings after which a gyro counts as broken."""
from math import radians

import pytest

from rbx1_nav.create.driver.gyro_check import FEW_AT_REST, GyroCheck, Step

AT_REST = Step(1 / 30, 0.0, 1e-9, 0.0, at_rest=True, driven=True, touched=False, missing=False)


@pytest.mark.parametrize('before', [0, 1, FEW_AT_REST - 1])
def test_ten_wrong_readings_in_a_row_at_rest(before):
    errors = []
    check = GyroCheck(radians(150), errors.append, errors.append)
    for count in [300] * before + [512] + [300] * (FEW_AT_REST - 1):
        check.update(count, AT_REST, 0.0)
    assert FEW_AT_REST == 10 and not errors
    check.update(300, AT_REST, 0.0)
    assert errors == ['Gyro: 300 counts at rest: expected 425 to 575; using the wheels alone for the heading']
