"""The rate, the heading and the variances of a TurtleBot's gyro follow from its counts, its offset and gaps."""
from math import radians

import pytest

from rbx1_nav.create.driver.analog_gyro import AnalogGyro, Step
from rbx1_nav.create.driver.settings import read_settings

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


def make_gyro(correction=1.0):
    """Return (gyro, its log)."""
    log = []
    return AnalogGyro(read_settings({'gyro_scale_correction': correction})[0], log.append, log.append), log


def calibrated(count=512, times=100):
    """Return a gyro with an offset."""
    gyro, _ = make_gyro()
    feed(gyro, count, times, rest=True)
    assert gyro.offset == count
    return gyro


def test_the_offset_needs_ten_readings_at_rest():
    gyro, _ = make_gyro()
    assert feed(gyro, 512, 100) is None     # in motion
    assert feed(gyro, 512, 9, rest=True) is None and gyro.offset is None
    assert feed(gyro, 512, 1, rest=True) and gyro.offset == 512


@pytest.mark.parametrize('correction', [1.0, 1.35])
@pytest.mark.parametrize('count', [112, 500, 700])
def test_the_rate_is_what_create_node_computes(count, correction):
    gyro, _ = make_gyro(correction)
    feed(gyro, 500, 20, rest=True)
    reading = gyro.update(count, step())
    assert reading.rate == pytest.approx(-(count - 500) / 500 * radians(150) * correction)
    assert reading.rate_variance == pytest.approx((radians(150) * correction / 500) ** 2)       # one count


def test_readings_that_jump_for_more_than_1_s_are_a_new_offset():
    gyro = calibrated()
    feed(gyro, 540, 16, rest=True)
    assert gyro.offset == 512
    feed(gyro, 512, 1, rest=True)       # the second starts again
    feed(gyro, 540, 16, rest=True)
    assert gyro.offset == 512
    assert feed(gyro, 540, 1, rest=True) is None and gyro.offset is None
    feed(gyro, 540, 10, rest=True)
    assert gyro.offset == 540


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


def test_a_new_gyro_has_the_variance_of_a_good_measurement():
    gyro, _ = make_gyro()
    assert gyro._variance == 1e-6        # 1 mrad
    feed(gyro, 512, 3, variance=0.25, turn=0.5)
    # without an offset, the heading is that of the wheels
    assert gyro.yaw == 1.5 and gyro._variance == pytest.approx(0.75 + 1e-6)


def test_a_reading_that_shows_no_velocity_leaves_the_heading_to_the_wheels():
    gyro = calibrated()
    yaw, variance = gyro.yaw, gyro._variance
    assert gyro.update(1023, step(turn=0.2, variance=0.01)) is None
    assert gyro.yaw == pytest.approx(yaw + 0.2) and gyro._variance == pytest.approx(variance + 0.01)


def test_at_rest_a_wrong_reading_counts_only_while_the_robot_is_touched():
    gyro = calibrated()
    assert gyro.update(600, step(rest=True)) is None
    assert gyro.update(600, step(rest=True, touched=True)).rate == pytest.approx(-88 * SCALE)


def test_in_a_gap_the_heading_follows_the_wheels():
    gyro = calibrated()
    yaw, variance = gyro.yaw, gyro._variance
    reading = gyro.update(412, step(elapsed=0.5, turn=0.3, variance=0.02, missing=True))
    assert reading.rate == pytest.approx(100 * SCALE)
    assert gyro.yaw == pytest.approx(yaw + 0.3) and gyro._variance == pytest.approx(variance + 0.02)


def test_after_a_fault_the_offset_is_measured_again():
    gyro = calibrated()
    feed(gyro, 900, 10, rest=True)
    assert gyro.problem
    feed(gyro, 530, 17, rest=True)
    assert gyro.offset == 530 and not gyro.problem
