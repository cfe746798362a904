"""Contradictions and another floor are reported with both turns, but not again and again."""
from types import SimpleNamespace

from rbx1_nav.estimation.doubts import Doubts
from rbx1_nav.units import SECOND


class Sums:
    """Stands for a filter whose wheels and gyro have turned, and which finds a contradiction or another floor."""

    def __init__(self, contradiction=0.0, floor=False):
        self.agreement = SimpleNamespace(wheels=2.0, gyro=-1.5)
        self.contradiction, self.floor = contradiction, floor
        self.asked = 0

    def doubt_heading(self):
        return self.contradiction

    def doubt_floor(self):
        self.asked += 1
        return self.floor


MEASURED = 'odom turned by 2.00 rad, imu_data by -1.50 rad: '


def make():
    warnings = []
    return Doubts(warnings.append), warnings


def test_sensors_that_agree_are_not_reported():
    doubts, warnings = make()
    doubts.check(Sums(), 10 * SECOND)
    assert not warnings and not doubts.contradicts(10 * SECOND) and not doubts.another_floor


def test_a_contradiction_is_reported_once_while_it_lasts():
    doubts, warnings = make()
    assert not doubts.contradicts(0)
    for time in 10, 14, 18:
        doubts.check(Sums(-3.5), time * SECOND)
    assert warnings == [MEASURED + 'one of them is wrong; the heading is uncertain']
    assert doubts.contradicts(23 * SECOND - 1) and not doubts.contradicts(23 * SECOND)
    doubts.check(Sums(3.5), 23 * SECOND)
    assert len(warnings) == 2 and doubts.contradicts(23 * SECOND)


def test_a_contradiction_at_time_0_is_one():
    doubts, _ = make()
    doubts.check(Sums(3.5), 0)
    assert doubts.contradicts(0)


def test_another_floor_is_reported_once():
    doubts, warnings = make()
    sums = Sums(floor=True)
    for time in 10, 20:
        doubts.check(sums, time * SECOND)
    assert warnings == [MEASURED + 'the slip does not match the assumed floor; the distance is less certain']
    # nor does the distance become less certain again
    assert sums.asked == 1 and doubts.another_floor and not doubts.contradicts(20 * SECOND)


def test_a_contradiction_is_not_taken_for_another_floor():
    doubts, _ = make()
    sums = Sums(3.5, True)
    doubts.check(sums, SECOND)
    assert not sums.asked and not doubts.another_floor
