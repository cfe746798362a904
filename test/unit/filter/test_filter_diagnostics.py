"""The state of the filter and of each sensor on /diagnostics."""
from math import radians
from threading import Lock
from types import SimpleNamespace

from diagnostic_updater import DiagnosticStatusWrapper
import pytest
import rospy

from rbx1_nav.filter.filter_status import CONTRADICTION, JUMPED, OK, WARN, Diagnostics
from rbx1_nav.filter.pose_errors import BIAS

NO_ESTIMATE, NO_MESSAGE, TIMED_OUT, USED = (
    (WARN, 'No estimate yet'), (WARN, 'No message yet'), (WARN, 'Timed out, not used'), (OK, 'Used'))


def make(case=None, timed_out=False, suspect=None, estimated=True):
    """A CombinedOdometry with a bias of 0.5 +- 0.25 degrees/s and a heading within 3 degrees."""
    ekf = SimpleNamespace(bias=radians(0.5), doubted='bias',
                          sigma=lambda index: radians(0.25) if index == BIAS else 9.0)
    return SimpleNamespace(
        filter=ekf if estimated else None, case=case, timed_out={'odom': False, 'imu_data': timed_out}, suspect=suspect,
        estimate=SimpleNamespace(covariance=((7.0, 0, 0), (0, 8.0, 0), (0, 0, radians(3) ** 2))) if estimated else None)


@pytest.mark.parametrize('name, combined, age, state', [
    ('filter', None, 0.25, NO_ESTIMATE), ('filter', make(estimated=False), 0.25, NO_ESTIMATE),
    ('filter', make('standstill'), 0.25, (OK, 'Standstill')),
    ('filter', make('contradiction'), 0.25, CONTRADICTION), ('filter', make(suspect='odom'), 0.25, JUMPED),
    ('filter', make(timed_out=True), 0.25, (WARN, 'A sensor has timed out')),
    ('filter', make(), 0.25, (OK, 'The gyro is not used')),
    ('odom', None, 0.25, NO_MESSAGE), ('odom', make(), None, NO_MESSAGE), ('odom', make(timed_out=True), 0.25, USED),
    ('odom', make(), 1.25, TIMED_OUT), ('odom', make(), -1.25, TIMED_OUT), ('odom', make(), -0.75, USED),
    ('imu_data', make(timed_out=True), 0.25, TIMED_OUT), ('odom', make(suspect='odom'), 0.5, JUMPED),
    ('imu_data', make(suspect='odom'), 0.5, USED), ('imu_data', make('contradiction'), 0.5, CONTRADICTION)])
def test_the_state_of_the_filter_and_of_each_sensor(monkeypatch, name, combined, age, state):
    """age: of the last message, s."""
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time(20))
    tasks = {}
    monkeypatch.setattr('rbx1_nav.filter.filter_status.Updater', lambda: SimpleNamespace(
        setHardwareID=lambda _: None, add=tasks.__setitem__))
    senders = [SimpleNamespace(name=each, missing_time=None, arrived=True) for each in ('odom', 'imu_data')]
    diagnostics = Diagnostics(senders, 1.0, Lock(), lambda: (combined, 7))
    assert diagnostics.rejected == dict(odom=0, imu_data=0, set_pose=0)
    diagnostics.rejected.update(odom=2, imu_data=3, set_pose=4)
    diagnostics.received[name] = None if age is None else rospy.Time.from_sec(20 - age)
    status = tasks[name](DiagnosticStatusWrapper())
    known = combined and combined.filter
    assert (status.level, status.message) == state and {each.key: each.value for each in status.values} == ({
        'Case': (combined and combined.case) or 'none', 'Doubted': 'bias' if known else 'nothing',
        'Gyro bias (degrees/s)': '0.5000 +- 0.2500' if known else 'unknown',
        'Standard deviation of the heading (degrees)': '3.00' if known else 'unknown',
        'Poses published': '7', 'Rejected messages on set_pose': '4'} if name == 'filter' else {
            'Age of the last message (s)': 'never' if age is None else f'{age:.3f}',
            'Rejected messages': '2' if name == 'odom' else '3'})
