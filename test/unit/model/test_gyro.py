"""The gyro: its errors are those of its surface, and no others."""
from math import radians
from statistics import mean, pstdev

import pytest

from rbx1_nav.model.gyro import Gyro, IdealGyro
from rbx1_nav.model.surfaces import Run
from test_wheels import SURFACE

RUN = Run(0.0, 0.0, radians(0.5), 0.01)
STEP = 0.02     # s


def readings(gyro, rate, number, standing=False, start=0.0):
    return [gyro.read(start + rate * STEP * (i + 1), STEP, standing) for i in range(number)]


def test_an_ideal_gyro_tells_the_truth():
    gyro = IdealGyro()
    told = readings(gyro, 1.5, 10)
    assert [reading.rate for reading in told] == pytest.approx([1.5] * 10)
    assert told[-1].yaw == pytest.approx(0.3) and told[-1].rate_variance > 0 and told[-1].yaw_variance > 0
    gyro.reset()
    assert gyro.read(0.02, STEP, False).rate == pytest.approx(1.0)


def test_bias_scale_and_noise():
    told = readings(Gyro(SURFACE, RUN, 1), 1.0, 5000)
    rates = [reading.rate for reading in told]
    # the mean of 5000 is good to noise / 70 (1 sigma), their spread to 1 %: five of those
    assert mean(rates) == pytest.approx(1.01 + radians(0.5), abs=SURFACE.gyro_noise / 14)
    assert pstdev(rates) == pytest.approx(SURFACE.gyro_noise, rel=0.05)
    assert told[0].rate_variance == pytest.approx(SURFACE.gyro_noise ** 2)


def test_the_noise_of_a_slower_reading_is_less():
    gyro = Gyro(SURFACE, RUN, 1)
    assert gyro.read(0.0, 4 * STEP, False).rate_variance == pytest.approx(SURFACE.gyro_noise ** 2 / 4)


@pytest.mark.parametrize('rate', [4.0, -4.0])
def test_the_range_cuts_it(rate):
    told = readings(Gyro(SURFACE, RUN, 1), rate, 5)
    assert {abs(reading.rate) for reading in told} == {SURFACE.gyro_measurement_range}
    assert all(reading.rate * rate > 0 for reading in told)


def test_the_heading_is_calibrated_at_rest_before_the_start_and_only_then():
    gyro = Gyro(SURFACE, RUN, 1)
    at_rest = readings(gyro, 0.0, 200, standing=True)
    assert {reading.yaw for reading in at_rest} == {0.0}
    told = readings(gyro, 1.0, 100)[-1]
    # 2 s at 1 rad/s, 1 % too much; the noise of calibration and of 100 readings comes to 0.6 mrad
    assert told.yaw == pytest.approx(2.02, abs=0.003)
    resting = readings(gyro, 0.0, 100, standing=True, start=2.0)
    assert resting[-1].yaw != resting[0].yaw
    assert resting[-1].yaw_variance > told.yaw_variance > at_rest[0].yaw_variance


def test_a_seed_makes_the_same_noise_again():
    one, same, other = ([reading.rate for reading in readings(Gyro(SURFACE, RUN, seed), 0.0, 5)] for seed in (1, 1, 2))
    assert one == same != other
