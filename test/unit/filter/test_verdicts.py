"""What wheels and gyro show of each other is logged once, and that the gyro is left each time."""
from types import SimpleNamespace

import pytest

from rbx1_nav.filter.sensor_contradictions import Doubts

LOST = 'odom has turned by -0.40 rad more than imu_data since the last rest: '


class Reports:
    """Reports what a filter has found."""

    def __init__(self):
        self.warnings = []
        self.doubts = Doubts(self.warnings.append)

    def send(self, *found, gyro_left=False):
        """Report each of these; return all warnings."""
        ekf = SimpleNamespace(gyro_left=gyro_left, lost=-0.4, scale_error=0.05, sigma=lambda _: 0.0087)
        for each in found:
            self.doubts.report(each, ekf)
        return self.warnings


@pytest.mark.parametrize('found, text', [
    ('rest', 'the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may drift by 0.5 '
     'degrees/s or more'),
    ('scale', 'imu_data and odom differ by 5 % in all turns: the scale of the gyro or the track width is wrong; the '
     'heading is uncertain'),
    ('bias', LOST + 'the bias has drifted, or one of them is wrong; the heading is uncertain; let it rest')])
def test_what_does_not_pass_is_reported_once(found, text):
    assert Reports().send('', found, '', found, '') == [text]


@pytest.mark.parametrize('found, text', [
    ('gyro', LOST + 'the gyro fails, and is not used until it turns with the wheels'),
    ('dead', 'imu_data has never changed, while odom has turned: the gyro does not measure, and is not used until it '
     'turns with the wheels')])
def test_a_gyro_that_is_left_is_reported_until_it_is_used_again(found, text):
    reports = Reports()
    assert reports.send(found, found, '', gyro_left=True) == [text]
    again = 'odom and imu_data agree again'
    assert reports.send('', '') == [text, again]
    assert reports.send(found, gyro_left=True) == [text, again, text]


def test_a_gyro_that_is_left_already_is_not_reported_for_another_reason():
    assert len(Reports().send('dead', 'gyro', 'gyro', gyro_left=True)) == 1
