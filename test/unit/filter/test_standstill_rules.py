"""The rules of a standstill at their limits: rest, the first bias, another bias, carried, and the noise of the gyro."""
from math import pi

import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.standstill import STANDSTILL, Part, Standstill

TIME = 0.125        # s, of each step: longer than a part, and exact as a float
LIMIT = 0.25        # rad/s, the largest bias


class Recorder:
    """Stands for the filter, and records what it is told."""

    def __init__(self, bias=None, sigma=0.0):
        self.bias, self.deviation, self.rested = bias or 0.0, sigma, bias is not None
        self.calls = []

    def learn_bias(self, rate, variance):
        self.calls.append(('bias', rate, variance))
        if not self.rested:
            self.bias, self.rested = rate, True

    def sigma(self, _):
        return self.deviation

    def carry(self, angle, duration):
        self.calls.append(('carried', angle, duration))

    def doubt_bias(self, rate):
        self.calls.append(('doubt', rate))


def rest(rates, variance=0.0, time=TIME, **known):
    """Return a Standstill and its Recorder, after steps at rest with these rates (rad/s), and one more step."""
    standstill, recorder = Standstill(LIMIT), Recorder(**known)
    for rate in [*rates, 0.0]:
        standstill.add(Part(time, rate * time, variance), recorder)
    return standstill, recorder


# the wheels

def test_a_slow_motion_adds_up():
    standstill = Standstill(LIMIT)
    assert [standstill.follow(number * SECOND, Pose(0.6e-4 * number, 0.0, 0.0)) for number in range(4)] == [
        False, True, False, True]


def test_a_whole_turn_of_the_yaw_is_rest():
    standstill = Standstill(LIMIT)
    standstill.follow(0, Pose(0.0, 0.0, pi))
    assert standstill.follow(SECOND, Pose(0.0, 0.0, -pi))


# the first bias

@pytest.mark.parametrize('rate', [LIMIT, -LIMIT, 0.0])
def test_the_first_bias_is_a_rate_within_the_limit_that_is_steady_for_a_fifth_of_a_second(rate):
    assert rest([rate])[1].calls == []
    standstill, recorder = rest([rate, rate], variance=1e-4)
    # the mean of two parts with a variance of 1e-4 rad^2 each
    assert recorder.calls == [('bias', rate, pytest.approx(2e-4 / 0.25 ** 2))]
    assert standstill.case == STANDSTILL
    # a bias that is known becomes uncertain if another rate is steady for long
    assert ('doubt', rate) in rest([rate] * 200, bias=0.02)[1].calls


# driving off

def test_the_end_of_a_standstill_contains_the_parts_that_were_not_used():
    standstill, recorder = rest([], bias=0.0, time=0.0625, variance=1e-6)
    assert standstill.leave(recorder) == (0.0625, 0.0, 1e-6)
    for rate in 0.5, 1.0:
        standstill.add(Part(0.0625, 0.0625 * rate, 1e-6), recorder)
    assert standstill.leave(recorder) == (0.125, 0.09375, 2e-6) and recorder.calls == []
