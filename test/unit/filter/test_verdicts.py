"""What wheels and gyro show of each other is reported once, and so is that they agree again."""
from types import SimpleNamespace

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.filter import Sums
from rbx1_nav.filter.sensors import REPORTED, Doubts

SUMS = Sums(0.5, 0.6, -0.3, 0.1)


class Reports:
    """Reports Verdicts, one per second."""

    def __init__(self):
        self.warnings, self.second = [], 0
        self.doubts = Doubts(self.warnings.append)

    def send(self, doubted, disagreement=0.0, **options):
        """Report a Verdict of a filter with these attributes; return the last warning."""
        ekf = SimpleNamespace(**{**dict(rested=True, gyro_left=False, disagreement=disagreement, drift=0.01,
                                        scale_error=0.05, sigma=lambda _: 0.0087), **options})
        self.second += 1
        self.doubts.report((SUMS, doubted) if doubted is not None else None, ekf, self.second * SECOND)
        return self.warnings[-1] if self.warnings else None


@pytest.mark.parametrize('doubted, reason', [
    ('wheels', 'the wheels slip; the heading follows the gyro'),
    ('both', 'one of them is wrong; the heading is uncertain')])
def test_a_disagreement_and_its_end_are_reported_once(doubted, reason):
    reports = Reports()
    assert reports.send(None) is reports.send('') is reports.send(doubted, 0.9 * REPORTED) is None
    text = f'odom turned by 0.60 rad, imu_data by -0.30 rad in 0.5 s: {reason}'
    assert reports.send(doubted, -1.1 * REPORTED) == reports.send(doubted, 9.0) == text
    assert reports.doubts.doubted == f'{doubted} since 4.0 s'
    reports.send('', 0.02)
    assert reports.warnings == [text]
    assert reports.send('', 0.009) == 'odom and imu_data agree again' and reports.doubts.doubted == 'nothing'


def test_wheels_that_only_seemed_to_slip_are_reported_again():
    reports = Reports()
    reports.send('wheels', 9.0)
    text = reports.send('both', 9.0)
    assert 'the heading is uncertain' in text and reports.doubts.doubted == 'both since 2.0 s'
    assert reports.send('wheels', 9.0) == text and reports.doubts.doubted == 'both since 2.0 s'


def test_a_gyro_that_is_left_is_reported_until_it_is_used_again():
    reports = Reports()
    assert reports.send('gyro', gyro_left=True).endswith(
        'the gyro fails, and is not used until it turns with the wheels')
    assert len(reports.warnings) == 1 and reports.doubts.doubted == 'gyro since 1.0 s'
    reports.send('', gyro_left=True)
    assert len(reports.warnings) == 1
    assert reports.send('') == 'odom and imu_data agree again'


@pytest.mark.parametrize('doubted, options, text', [
    ('', dict(rested=False), 'the robot has not been at rest yet, so the bias of the gyro is unknown: the heading may '
     'drift by 0.5 degrees/s or more'),
    ('scale', {}, 'imu_data and odom differ by 5 % in all turns: the scale of the gyro or the track width is wrong; '
     'the heading is uncertain'),
    ('bias', {}, 'the bias of imu_data seems to have drifted since the '
     'last rest, by 0.57 degrees/s: the heading is uncertain; let it rest')])
def test_what_does_not_pass_is_reported_once(doubted, options, text):
    reports = Reports()
    for _ in range(3):
        reports.send(doubted, **options)
    assert reports.warnings == [text] and reports.doubts.doubted == 'nothing'


def test_a_gyro_that_never_changes_is_dead_as_soon_as_the_wheels_turn_fast():
    reports = Reports()
    is_dead = reports.doubts.is_dead
    assert not is_dead(0.009, 0.01) and is_dead(-0.05, 0.01) and not is_dead(0.0, 0.01) and not reports.warnings
    assert is_dead(0.06, 0.01) and is_dead(0.0, 0.01)       # for good, after 0.1 rad
    assert reports.warnings == ['imu_data has never changed, while odom has turned by 0.11 rad: the gyro does not '
                                'measure, and is not used']
