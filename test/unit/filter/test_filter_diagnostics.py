"""The state of the filter and of each sensor on /diagnostics."""
from math import radians
from threading import Lock
from types import SimpleNamespace

from diagnostic_updater import DiagnosticStatusWrapper
import numpy
import pytest
import rospy

from rbx1_nav.filter import filter_status
from rbx1_nav.filter.filter import BIAS

OK, WARN = 0, 1     # by the definition of a DiagnosticStatus
CONTRADICT = WARN, 'Wheels and gyro contradict each other'
JUMPED = WARN, 'Odometry ignored: faster than ~max_speed or ~max_turn_rate'
TIMED_OUT = WARN, 'Timed out, not used'


class Updater(dict):
    """The tasks of a diagnostic_updater.Updater, by name."""

    add = dict.__setitem__

    def setHardwareID(self, _):
        pass


def make_combined(case=None, timed_out=False, suspect=None, estimated=True):
    """A CombinedOdometry with a bias of 0.5 +- 0.25 degrees/s and a heading within 3 degrees."""
    ekf = SimpleNamespace(bias=radians(0.5), sigma=lambda index: radians(0.25) if index == BIAS else 9.0)
    estimate = SimpleNamespace(covariance=numpy.diag([7.0, 8.0, radians(3) ** 2]))
    return SimpleNamespace(filter=ekf if estimated else None, estimate=estimate if estimated else None, case=case,
                           timed_out={'odom': False, 'imu_data': timed_out}, suspect=suspect,
                           doubts=SimpleNamespace(doubted='both'))


@pytest.fixture(name='report')
def fixture_report(monkeypatch):
    """A function that returns the (level, text) and the values of a task, 0.25 s after the last message."""
    monkeypatch.setattr(filter_status, 'Updater', Updater)
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time(20))

    def report(name, combined, age=0.25):
        diagnostics = filter_status.Diagnostics(['odom', 'imu_data'], 1.0, Lock(), lambda: (combined, 7))
        diagnostics.rejected.update(odom=2, imu_data=3, set_pose=4)
        if age is not None:
            diagnostics.received[name] = rospy.Time.from_sec(20 - age)
        status = diagnostics.updater[name](DiagnosticStatusWrapper())
        return (ord(status.level) if isinstance(status.level, bytes) else status.level, status.message), {
            each.key: each.value for each in status.values}
    return report


@pytest.mark.parametrize('combined, state', [
    (None, (WARN, 'No estimate yet')), (make_combined(estimated=False), (WARN, 'No estimate yet')),
    (make_combined('standstill'), (OK, 'Standstill')), (make_combined('agreement'), (OK, 'Wheels and gyro agree')),
    (make_combined('contradiction'), CONTRADICT), (make_combined('carried'), (WARN, 'Carried, or turned by hand')),
    (make_combined(timed_out=True), (WARN, 'A sensor has timed out')), (make_combined(suspect='odom'), JUMPED),
    (make_combined(), (OK, 'The gyro is not used'))])
def test_the_state_of_the_filter(report, combined, state):
    found, values = report('filter', combined)
    known = combined is not None and combined.filter is not None
    assert found == state and values == {
        'Case': (combined and combined.case) or 'none', 'Doubted': 'both' if combined else 'nothing',
        'Gyro bias (degrees/s)': '0.5000 +- 0.2500' if known else 'unknown',
        'Standard deviation of the heading (degrees)': '3.00' if known else 'unknown',
        'Poses published': '7', 'Rejected messages on set_pose': '4'}


@pytest.mark.parametrize('name, combined, age, state', [
    ('odom', None, 0.25, (WARN, 'No message yet')), ('odom', make_combined(), None, (WARN, 'No message yet')),
    ('odom', make_combined(), 1.25, TIMED_OUT), ('odom', make_combined(), -1.25, TIMED_OUT),
    ('odom', make_combined(), -0.75, (OK, 'Used')), ('odom', make_combined(timed_out=True), 0.25, (OK, 'Used')),
    ('imu_data', make_combined(timed_out=True), 0.25, TIMED_OUT), ('odom', make_combined(suspect='odom'), 0.5, JUMPED),
    ('imu_data', make_combined(suspect='odom'), 0.5, (OK, 'Used')),
    ('imu_data', make_combined('contradiction'), 0.5, CONTRADICT)])
def test_the_state_of_a_sensor(report, name, combined, age, state):
    assert report(name, combined, age) == (state, {
        'Age of the last message (s)': 'never' if age is None else f'{age:.3f}',
        'Rejected messages': '2' if name == 'odom' else '3'})
