"""The rules of a standstill at their limits: rest, the first bias, another bias, carried, and the noise of the gyro."""
from math import inf, pi

import pytest

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.standstill import CARRIED, STANDSTILL, Part, Standstill

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


# another rate

def test_a_rate_that_is_not_steady_has_turned_the_robot():
    carried = [('carried', pytest.approx(rate * TIME), TIME) for rate in (0.1, 0.2, 0.3)]
    bias = 'bias', 0.2, 0.0
    assert rest([0.1, 0.2, 0.2])[1].calls == [carried[0], bias]
    # a rate above the limit is neither steady nor a bias
    assert rest([0.2, 0.3, 0.2, 0.2])[1].calls == [carried[1], carried[2], bias]
    standstill, recorder = rest([0.2], bias=0.05)
    assert recorder.calls == [('carried', pytest.approx(0.15 * TIME), TIME)] and standstill.case == CARRIED


@pytest.mark.parametrize('known', [dict(bias=0.0, variance=1e-4), dict(bias=0.0, sigma=0.1)])
def test_a_rate_that_differs_by_the_noise_or_the_uncertainty_of_the_bias_is_the_bias(known):
    # 0.01 rad in 0.125 s, and 0.1 rad/s, are 1 sigma: 0.2 rad/s is less than 5 or 2 of them
    assert rest([0.2], **known)[1].calls == [('bias', 0.2, pytest.approx(known.get('variance', 0.0) / TIME ** 2))]


def test_a_rate_that_is_steady_for_10_s_is_another_bias_and_has_not_turned_the_robot():
    _, recorder = rest([0.2] * 80, bias=0.05)
    calls, last = recorder.calls[:81], recorder.calls[81:]
    assert sum(angle for _, angle, _ in calls) == pytest.approx(0.0, abs=1e-12)     # rounding
    assert sum(duration for *_, duration in calls) == 10.0
    assert last == [('doubt', pytest.approx(0.2)), ('bias', pytest.approx(0.2), 0.0)]


def test_the_noise_is_measured_from_differences_of_rates_that_may_be_the_bias():
    standstill, recorder = Standstill(LIMIT), Recorder(bias=0.0, sigma=1.0)
    for time, rate in (0.125, 0.1), (0.25, 0.2), (0.25, -0.1), (0.125, 0.3), (0.125, 0.0), (0.125, 0.0):
        standstill.add(Part(time, rate * time), recorder)
    # noise with a density D makes a difference of D / time + D / time; 0.3 rad/s is no bias, and the next is the first
    assert standstill.density == pytest.approx((0.1 ** 2 / (8 + 4) + 0.3 ** 2 / (4 + 4)) / 2)
    assert standstill.max_density == inf
    for number in range(20):
        standstill.add(Part(0.125, 0.02 * (-1) ** number * 0.125), recorder)
    # twice as much as the noise, after enough differences
    assert standstill.max_density == pytest.approx(2 * standstill.density) and standstill.samples == 22


# driving off

def test_a_rate_that_was_steady_for_longer_than_a_second_may_be_the_bias():
    for count, doubts in (4, []), (12, [('doubt', pytest.approx(0.2))]):
        standstill, recorder = rest([0.2] * count, bias=0.0)
        assert [call for call in recorder.calls if call[0] != 'carried'] == []
        standstill.leave(recorder)
        assert recorder.calls[count:] == doubts and standstill.case is None


def test_the_end_of_a_standstill_contains_the_parts_that_were_not_used():
    standstill, recorder = rest([], bias=0.0, time=0.0625, variance=1e-6)
    assert standstill.leave(recorder) == (0.0625, 0.0, 1e-6)
    for rate in 0.5, 1.0:
        standstill.add(Part(0.0625, 0.0625 * rate, 1e-6), recorder)
    assert standstill.leave(recorder) == (0.125, 0.09375, 2e-6) and recorder.calls == []
