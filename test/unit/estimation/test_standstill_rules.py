"""The rules of a standstill at their limits: rest, the first bias, another bias, carried, and the noise of the gyro."""
from math import inf, pi, radians, sqrt

import pytest

from rbx1_nav.estimation.standstill import CARRIED, STANDSTILL, Part, Standstill
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.units import SECOND

TIME = 0.125        # s, of each step: longer than a part, and exact as a float
LIMIT = 0.25        # rad/s, the largest bias
DEGREE = radians(1)


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

def test_the_wheels_are_at_rest_when_the_pose_has_not_changed_for_half_a_second():
    standstill = Standstill(LIMIT)
    assert [standstill.rests(stamp, ORIGIN) for stamp in (5 * SECOND, 5 * SECOND + SECOND // 2 - 1,
                                                          5 * SECOND + SECOND // 2)] == [False, False, True]
    assert not standstill.rests(6 * SECOND, Pose(0.01, 0.0, 0.0))
    assert not standstill.rests(7 * SECOND, ORIGIN)


@pytest.mark.parametrize('axis', range(3))
@pytest.mark.parametrize('change, rests', [(0.99e-4, True), (-0.99e-4, True), (1.01e-4, False), (-1.01e-4, False)])
def test_a_change_of_a_tenth_of_a_millimetre_or_milliradian_is_rounding(axis, change, rests):
    pose = [1.0, 2.0, 3.0]
    standstill = Standstill(LIMIT)
    standstill.rests(0, Pose(*pose))
    pose[axis] += change
    assert standstill.rests(SECOND, Pose(*pose)) == rests


def test_a_slow_motion_adds_up():
    standstill = Standstill(LIMIT)
    assert [standstill.rests(number * SECOND, Pose(0.6e-4 * number, 0.0, 0.0)) for number in range(4)] == [
        False, True, False, True]


def test_a_whole_turn_of_the_yaw_is_rest():
    standstill = Standstill(LIMIT)
    standstill.rests(0, Pose(0.0, 0.0, pi))
    assert standstill.rests(SECOND, Pose(0.0, 0.0, -pi))


# the first bias

@pytest.mark.parametrize('rate', [LIMIT, -LIMIT, 0.0])
def test_the_first_bias_is_a_rate_within_the_limit_that_is_steady_for_a_fifth_of_a_second(rate):
    assert rest([rate])[1].calls == []
    standstill, recorder = rest([rate, rate], variance=1e-4)
    # the mean of two parts with a variance of 1e-4 rad^2 each
    assert recorder.calls == [('bias', rate, pytest.approx(2e-4 / 0.25 ** 2))]
    assert standstill.case == STANDSTILL


def test_parts_are_at_least_a_tenth_of_a_second():
    standstill, recorder = Standstill(LIMIT), Recorder()
    learned = []
    for _ in range(10):
        standstill.add(Part(0.05, 0.005, 1e-6), recorder)
        learned.append(len(recorder.calls))
    # two parts of two steps, each of which is used when the robot is still at rest after it; then each other step
    assert learned == [0, 0, 0, 0, 1, 1, 2, 2, 3, 3]
    assert recorder.calls[0] == ('bias', pytest.approx(0.1), pytest.approx(4e-6 / 0.2 ** 2))
    assert recorder.calls[1] == ('bias', pytest.approx(0.1), pytest.approx(2e-6 / 0.1 ** 2))


@pytest.mark.parametrize('noise', [0.0, 1e-6])
@pytest.mark.parametrize('sign', [-1, 1])
@pytest.mark.parametrize('beyond', [-1e-6, 1e-6])
def test_a_rate_is_steady_within_1_degree_per_second_and_5_deviations_of_its_noise(noise, sign, beyond):
    change = sign * (DEGREE + 5 * sqrt(noise) / TIME + beyond)
    standstill, recorder = rest([0.1, 0.1 + change], variance=noise)
    if beyond < 0:
        assert [call[0] for call in recorder.calls] == ['bias']
    else:
        # a hand has turned the robot by the first part; the second may still be the bias
        assert recorder.calls == [('carried', pytest.approx(0.1 * TIME), TIME)] and standstill.case == CARRIED


def test_a_rate_above_the_limit_is_a_hand_and_not_part_of_a_steady_rate():
    above = LIMIT + 1e-3
    standstill, recorder = rest([above, LIMIT])
    assert recorder.calls == [('carried', above * TIME, TIME)] and standstill.case == CARRIED
    standstill, recorder = rest([above, LIMIT, LIMIT])
    assert recorder.calls[1:] == [('bias', LIMIT, 0.0)] and standstill.case == STANDSTILL


# a bias that is known

@pytest.mark.parametrize('noise', [0.0, 1e-6])
@pytest.mark.parametrize('sign', [-1, 1])
@pytest.mark.parametrize('beyond', [-1e-6, 1e-6])
def test_a_bias_may_have_changed_by_1_degree_per_second_noise_and_2_deviations(noise, sign, beyond):
    rate = 0.05 + sign * (DEGREE + 5 * sqrt(noise) / TIME + 2 * 0.003 + beyond)
    standstill, recorder = rest([rate], variance=noise, bias=0.05, sigma=0.003)
    if beyond < 0:
        assert recorder.calls == [('bias', pytest.approx(rate), pytest.approx(noise / TIME ** 2))]
        assert standstill.case == STANDSTILL
    else:
        # turned by what exceeds the bias
        assert recorder.calls == [('carried', pytest.approx((rate - 0.05) * TIME), TIME)]
        assert standstill.case == CARRIED


def test_a_bias_above_the_limit_is_not_learned():
    assert rest([LIMIT], bias=LIMIT)[1].calls == [('bias', LIMIT, 0.0)]
    assert rest([LIMIT + 1e-3], bias=LIMIT)[1].calls == [('carried', pytest.approx(1e-3 * TIME), TIME)]


@pytest.mark.parametrize('parts, learned', [(79, False), (80, True)])
def test_another_rate_is_the_bias_after_10_seconds(parts, learned):
    standstill, recorder = rest([0.125] * parts, variance=1e-6, bias=0.0)
    # if it is the bias, the robot was not carried
    assert [call[0] for call in recorder.calls] == ['carried'] * parts + ['carried', 'doubt', 'bias'] * learned
    if learned:
        assert sum(call[1] for call in recorder.calls[:-2]) == pytest.approx(0.0)
        assert recorder.calls[-1] == ('bias', 0.125, pytest.approx(80 * 1e-6 / 10.0 ** 2))
    assert standstill.case == (STANDSTILL if learned else CARRIED)


def test_a_rate_that_changes_in_between_is_not_the_bias():
    _, recorder = rest([0.125] * 40 + [0.2] + [0.125] * 79, bias=0.0)
    assert {call[0] for call in recorder.calls} == {'carried'}


def test_after_another_bias_was_learned_the_time_counts_anew():
    standstill, recorder = rest([0.125] * 80, bias=0.0)
    assert standstill.leave(recorder).time == TIME
    assert recorder.calls[-1][0] == 'bias'


# driving off

@pytest.mark.parametrize('parts, doubted', [(7, False), (8, True)])
def test_a_rate_that_was_steady_for_1_second_makes_the_bias_uncertain(parts, doubted):
    standstill, recorder = rest([0.125] * parts, bias=0.0)
    # the last step has not been used
    assert standstill.leave(recorder) == (TIME, 0.0, 0.0)
    assert recorder.calls[parts:] == [('doubt', 0.125)] * doubted
    assert standstill.case is None and standstill.leave(recorder) == (0.0, 0.0, 0.0)
    assert len(recorder.calls) == parts + doubted


def test_the_end_of_a_standstill_contains_the_parts_that_were_not_used():
    standstill, recorder = rest([], bias=0.0, time=0.0625, variance=1e-6)
    assert standstill.leave(recorder) == (0.0625, 0.0, 1e-6)
    for rate in 0.5, 1.0:
        standstill.add(Part(0.0625, 0.0625 * rate, 1e-6), recorder)
    assert standstill.leave(recorder) == (0.125, 0.09375, 2e-6) and recorder.calls == []


# the noise of the gyro

def test_the_noise_is_measured_from_10_differences():
    for parts, limit in ((10, inf), (11, 2 * 0.01 ** 2 / 4)):
        # rates of +-0.01 rad/s differ by 0.02 rad/s; a density D makes a variance of D * (8 / s + 8 / s)
        standstill, _ = rest([0.01 * (-1) ** number for number in range(parts)], bias=0.0)
        assert standstill.max_density == pytest.approx(limit)
    assert standstill.density == pytest.approx(0.02 ** 2 / 16)


def test_the_noise_is_the_mean_of_the_last_100_differences():
    first = [0.01 * (-1) ** number for number in range(41)]
    # after 40 differences, 40 without noise
    assert rest(first + [0.01] * 40, bias=0.0)[0].density == pytest.approx(0.01 ** 2 / 4 / 2)
    first = [0.01 * (-1) ** number for number in range(201)]
    # then each one has a weight of a hundredth
    assert rest(first + [0.01] * 2, bias=0.0)[0].density == pytest.approx(0.01 ** 2 / 4 * 0.99 ** 2)


def test_a_gyro_without_noise_is_as_quiet_as_a_good_one():
    standstill, _ = rest([0.01] * 20, bias=0.0)
    # 0.005 degrees/s after 1 s
    assert standstill.density == 0.0 and standstill.max_density == pytest.approx(2 * radians(0.005) ** 2)


def test_a_hand_is_no_noise():
    standstill, _ = rest([0.01, 0.01, 0.2, 0.012, 0.012], bias=0.01)
    assert standstill.samples == 2 and standstill.density == 0.0


def test_the_noise_is_kept_from_one_standstill_to_the_next():
    standstill, recorder = rest([0.01] * 20, bias=0.0)
    before = standstill.max_density, standstill.samples
    standstill.leave(recorder)
    for _ in range(2):
        standstill.add(Part(TIME, 0.015 * TIME, 0.0), recorder)
    # the first rate has none to be compared with
    assert (standstill.max_density, standstill.samples) == before
