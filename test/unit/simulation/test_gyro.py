"""The gyro has the errors of its surface."""
from math import radians
from statistics import mean, pstdev

import pytest

from rbx1_nav.base.covariances import MEASURED
from rbx1_nav.simulation.gyro import Gyro, IdealGyro
from rbx1_nav.simulation.slip import RandomErrors
from sample_surface import SURFACE

RUN = RandomErrors(0.0, 0.0, radians(0.5), 0.01)
STEP = 0.02     # s


def readings(gyro, rate, number, at_rest=False, start=0.0):
    return [gyro.read(start + rate * STEP * (i + 1), STEP, at_rest) for i in range(number)]


def test_an_ideal_gyro_has_no_errors():
    gyro = IdealGyro()
    measured = readings(gyro, 1.5, 10)
    assert [reading.rate for reading in measured] == pytest.approx([1.5] * 10)
    assert measured[-1].yaw == pytest.approx(0.3)
    assert measured[-1].rate_variance > 0 and measured[-1].yaw_variance > 0
    gyro.reset()
    assert gyro.read(0.02, STEP, False).rate == pytest.approx(1.0)


def test_readings_have_bias_scale_error_and_noise():
    measured = readings(Gyro(SURFACE, RUN, 1), 1.0, 5000)
    rates = [reading.rate for reading in measured]
    # 1 sigma of the mean of 5000 is noise / 70, of their spread 1 %: the limits are 5 sigma
    assert mean(rates) == pytest.approx(1.01 + radians(0.5), abs=SURFACE.gyro_noise / 14)
    assert pstdev(rates) == pytest.approx(SURFACE.gyro_noise, rel=0.05)
    assert measured[0].rate_variance == pytest.approx(SURFACE.gyro_noise ** 2)


@pytest.mark.parametrize('rate', [4.0, -4.0])
def test_readings_are_limited_to_the_measurement_range(rate):
    measured = readings(Gyro(SURFACE, RUN, 1), rate, 5)
    assert {abs(reading.rate) for reading in measured} == {SURFACE.gyro_measurement_range}
    assert all(reading.rate * rate > 0 for reading in measured)


def test_the_heading_is_calibrated_at_standstill_before_the_first_motion_only():
    gyro = Gyro(SURFACE, RUN, 1)
    at_rest = readings(gyro, 0.0, 200, at_rest=True)
    assert {reading.yaw for reading in at_rest} == {0.0}
    moved = readings(gyro, 1.0, 100)[-1]
    # 2 s at 1 rad/s, 1 % too much; the noise of the calibration and of 100 readings is 0.6 mrad
    assert moved.yaw == pytest.approx(2.02, abs=0.003)
    at_rest_again = readings(gyro, 0.0, 100, at_rest=True, start=2.0)
    assert at_rest_again[-1].yaw != at_rest_again[0].yaw
    assert at_rest_again[-1].yaw_variance > moved.yaw_variance > at_rest[0].yaw_variance


def test_the_noise_depends_on_the_seed_only():
    one, same, other = ([reading.rate for reading in readings(Gyro(SURFACE, RUN, seed), 0.0, 5)] for seed in (1, 1, 2))
    assert one == same != other


@pytest.mark.parametrize('rest', [0, 100])
def test_the_variance_of_the_heading_is_the_sum_of_noise_bias_and_scale_error(rest):
    gyro = Gyro(SURFACE, RUN, 1)
    readings(gyro, 0.0, rest, at_rest=True)
    moved = readings(gyro, 1.0, 100)
    time, turned = 100 * STEP, abs(moved[-1].yaw)
    density = SURFACE.gyro_noise ** 2 * STEP     # rad^2/s: white noise, one reading per step
    bias = min(density / (rest * STEP), SURFACE.gyro_bias ** 2) if rest else SURFACE.gyro_bias ** 2
    expected = density * time + bias * time ** 2 + (SURFACE.gyro_scale_error * turned) ** 2 + MEASURED
    assert moved[-1].yaw_variance == pytest.approx(expected, rel=1e-4)


def test_the_scale_error_in_the_variance_grows_in_both_directions():
    surface = SURFACE._replace(gyro_noise=1e-9, gyro_bias=0.0)
    gyro = Gyro(surface, RandomErrors(0.0, 0.0, 0.0, 0.0), 1)
    readings(gyro, 1.0, 100)
    back = readings(gyro, -1.0, 100, start=2.0)[-1]
    # 2 rad to the left and 2 rad to the right; the noise of 1e-9 rad/s adds less than 1e-8 rad
    assert back.yaw == pytest.approx(0.0, abs=1e-7)
    assert back.yaw_variance == pytest.approx(1e-6 + (0.003 * 4) ** 2, rel=1e-6)
