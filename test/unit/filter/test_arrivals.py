"""Stamps are checked at their limits, and silent sensors are detected and reported once."""
import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import RejectedMessage
from rbx1_nav.filter.sensor_timeouts import IMU, ODOM, Arrivals

NOW = 1000 * SECOND


def make(timeout=SECOND, clock=None, max_lead=SECOND // 4):
    """Return an Arrivals and the list of its warnings."""
    warnings = []
    return Arrivals(timeout, warnings.append, clock, max_lead), warnings


@pytest.mark.parametrize('offset, expected', [
    (SECOND // 4, ''), (SECOND // 4 + 1, 'not later than now, 1000.000000000'),
    (-60 * SECOND, ''), (-60 * SECOND - 1, 'not much older than now, 1000.000000000')])
@pytest.mark.parametrize('sensor', [ODOM, IMU])
def test_a_stamp_is_near_the_clock(offset, expected, sensor):
    arrivals, _ = make()
    if expected:
        with pytest.raises(RejectedMessage) as error:
            arrivals.add(sensor, NOW, NOW + offset)
        assert str(error.value) == (
            f'header.stamp: {(NOW + offset) / SECOND:.9f}: expected a stamp {expected}; synchronize the clocks of both '
            'computers, or for a bag, set use_sim_time before the nodes start, and play it with --clock')
        assert arrivals.last_stamp == {ODOM: None, IMU: None}
    else:
        assert arrivals.add(sensor, NOW, NOW + offset) is None
        assert arrivals.last_stamp[sensor] == NOW + offset


def test_a_stamp_is_later_than_the_last_one_of_its_sensor():
    arrivals, _ = make()
    assert arrivals.add(ODOM, NOW, NOW) is None
    assert arrivals.add(IMU, NOW, NOW - 5) is None      # the sensors are independent
    for stamp in NOW, NOW - 1:
        with pytest.raises(RejectedMessage, match='expected a stamp later than the last, 1000.000000000'):
            arrivals.add(ODOM, NOW + 1, stamp)
    assert arrivals.add(ODOM, NOW + 1, NOW + 1) == NOW and arrivals.add(IMU, NOW + 1, NOW - 4) == NOW - 5


def test_a_time_out_and_a_recovery_are_each_reported_once():
    arrivals, warnings = make(timeout=SECOND // 2)
    for _ in range(3):
        arrivals.set_timed_out(ODOM)
    assert arrivals.timed_out == {ODOM: True, IMU: False}
    assert warnings == ['odom has timed out: no valid message for more than 0.5 s; not used until it recovers']
    arrivals.add(ODOM, NOW, NOW)
    arrivals.add(ODOM, NOW + 1, NOW + 1)
    assert arrivals.timed_out == {ODOM: False, IMU: False} and warnings[1:] == ['odom has recovered']
    arrivals.set_timed_out(IMU, 'it is upside down')
    assert warnings[2:] == ['imu_data has timed out: it is upside down; not used until it recovers']
    arrivals.restart()
    assert arrivals.timed_out == {ODOM: False, IMU: False}
