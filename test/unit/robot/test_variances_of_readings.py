"""The variances that readings have and may have."""
from rbx1_nav.robot.readings import MEASURED, MIN_VARIANCE


def test_a_good_measurement_is_one_of_a_millimetre_or_milliradian():
    assert MEASURED ** 0.5 == 0.001


def test_no_sensor_is_better_than_a_micrometre_or_microradian():
    assert MIN_VARIANCE ** 0.5 == 1e-6
