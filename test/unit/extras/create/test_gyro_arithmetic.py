"""The rate, the heading and the variances of a TurtleBot's gyro follow from its counts, its offset and gaps."""
from math import radians

import pytest

from rbx1_nav.extras.create.analog_gyro import AnalogGyro, Step
from rbx1_nav.extras.create.create_parameters import read_settings

PERIOD = 1 / 16     # s between two readings: sums of this number are exact
SCALE = radians(150) / 512      # rad/s per count


def step(rest=False, elapsed=PERIOD, turn=0.0, variance=0.0, missing=False, touched=False):
    return Step(elapsed, turn, variance, turn, rest, True, touched, missing)


def feed(gyro, count, times, **options):
    """Feed equal steps. Returns the last Reading."""
    reading = None
    for _ in range(times):
        reading = gyro.update(count, step(**options))
    return reading


def make_gyro(correction=1.0, full_range=150):
    return AnalogGyro(read_settings({'gyro_scale_correction': correction, 'gyro_measurement_range': full_range})[0],
                      None, None)


def calibrated(count=512, times=100):
    """Return a gyro with an offset."""
    gyro = make_gyro()
    feed(gyro, count, times, rest=True)
    assert gyro.offset == count
    return gyro


@pytest.mark.parametrize('correction, full_range', [(1.0, 150), (1.35, 150), (1.0, 300)])
@pytest.mark.parametrize('count', [112, 500, 700])
def test_the_rate_is_what_create_node_computes(count, correction, full_range):
    gyro = make_gyro(correction, full_range)
    feed(gyro, 500, 20, rest=True)
    reading = gyro.update(count, step())
    assert reading.rate == pytest.approx(-(count - 500) / 500 * radians(full_range) * correction)
    assert reading.rate_variance == pytest.approx((radians(full_range) * correction / 500) ** 2)       # one count


def test_the_heading_and_its_variance_grow_with_each_reading():
    gyro = calibrated(times=50)
    before = gyro._variance
    reading = feed(gyro, 412, 32)       # 2 s
    turn = 100 * SCALE * 2
    assert reading.yaw == pytest.approx(turn)
    # the noise of each reading and of the offset, and 1 % of the turn
    noise = 32 * SCALE ** 2 * (1 + 1 / 50) * PERIOD ** 2
    assert gyro._variance - before == pytest.approx(noise)
    assert reading.yaw_variance == pytest.approx(before + noise + (0.01 * turn) ** 2)
    # a turn back does not reduce the scale error
    reading = feed(gyro, 612, 32)
    assert reading.yaw == pytest.approx(0, abs=1e-12)       # rounding of floating-point numbers
    assert reading.yaw_variance == pytest.approx(before + 2 * noise + (0.01 * 2 * turn) ** 2)


def test_a_reading_that_shows_no_velocity_leaves_the_heading_to_the_wheels():
    gyro = calibrated()
    yaw, variance = gyro.yaw, gyro._variance
    assert gyro.update(1023, step(turn=0.2, variance=0.01)) is None
    assert gyro.yaw == pytest.approx(yaw + 0.2) and gyro._variance == pytest.approx(variance + 0.01)


def test_in_a_gap_the_heading_follows_the_wheels():
    gyro = calibrated()
    yaw, variance = gyro.yaw, gyro._variance
    reading = gyro.update(412, step(elapsed=0.5, turn=0.3, variance=0.02, missing=True))
    assert reading.rate == pytest.approx(100 * SCALE)
    assert gyro.yaw == pytest.approx(yaw + 0.3) and gyro._variance == pytest.approx(variance + 0.02)
