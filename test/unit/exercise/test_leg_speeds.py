"""A leg determines each speed, its stops and its errors from the poses of the robot."""
from itertools import accumulate
from math import pi, remainder, sqrt

import pytest

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.exercise.legs import Phase, Straight, StuckError, Turn


def forward(goal=1.0, speed=0.2, min_speed=0.05, rate=50):
    return Straight('forward', goal, speed, min_speed, rate)


def left(goal=3.0, speed=1.0, min_speed=0.2, rate=50):
    return Turn('turn left', goal, speed, min_speed, rate)


def at(leg, to_go):
    """Return the speed of a leg whose robot is this far from the goal, after a start at the origin."""
    leg.next_speed(ORIGIN)
    done = leg.goal - to_go
    return leg.next_speed(Pose(done, 0.0, 0.0) if leg.unit == 'm' else Pose(0.0, 0.0, done))


def drive(leg, distances):
    """Return the speeds of a leg whose robot moves by these distances (m), one at each tick."""
    return [leg.next_speed(Pose(x, 0.0, 0.0)) for x in accumulate(distances)]


@pytest.mark.parametrize('to_go, speed, expected', [
    # the travel time to the goal is at least 0.5 s
    (0.99, 0.2, 0.2), (0.11, 0.2, 0.2), (0.09, 0.2, 0.18), (0.05, 0.2, 0.1), (0.03, 0.2, 0.06), (0.026, 0.2, 0.052),
    # braking at 0.4 m/s^2
    (0.9, 2.0, sqrt(2 * 0.4 * 0.9)), (0.5, 2.0, sqrt(0.4)), (0.21, 2.0, sqrt(0.168)), (0.19, 2.0, 0.38)])
def test_a_straight_leg_slows_down_in_time(to_go, speed, expected):
    assert at(forward(speed=speed), to_go) == pytest.approx(expected)


@pytest.mark.parametrize('to_go, speed, expected', [
    (2.9, 1.0, 1.0), (0.51, 1.0, 1.0), (0.4, 1.0, 0.8), (0.15, 1.0, 0.3),
    # braking at 2 rad/s^2
    (2.25, 9.0, 3.0), (1.21, 9.0, 2.2), (0.81, 9.0, 1.62)])
def test_a_turn_slows_down_in_time(to_go, speed, expected):
    assert at(left(speed=speed), to_go) == pytest.approx(expected)


# the trial stop

def test_a_short_leg_begins_with_the_trial_stop():
    leg = forward(goal=0.02)
    # the robot coasts after an earlier motion, and is then driven to the goal
    assert drive(leg, [0.0, 0.005, 0.001]) == [0.0, 0.05, 0.05] and leg.state is not Phase.FINISHED
    assert leg.next_speed(Pose(0.0197, 0.0, 0.0)) == 0.0 and leg.state is Phase.FINISHED


# The robot coasts 10 mm after a trial stop at 23 mm. In the last part it is stationary at 13 mm, and then moves by
# 4 mm. It would coast 10 mm * 4 mm / travel per tick before the trial stop. So it stops at 9 mm if that travel is
# between 4 and 4.7 mm, because 40 / 4.7 = 8.5, and half of the slowest travel is 0.5 mm.

@pytest.mark.parametrize('before, finished', [
    ([0.03] + [0.0045] * 5, True), ([0.0] + [0.0049] * 5, False),
    # the travel per tick is the mean over 0.1 s, which are five ticks
    ([0.0045, 0.03] + [0.0045] * 5, True), ([0.0045, 0.0] + [0.0049] * 5, False),
    ([0.03, 0.0065, 0.004, 0.004, 0.004, 0.004], True), ([0.0, 0.0069, 0.0044, 0.0044, 0.0044, 0.0044], False)])
def test_the_stopping_distance_is_proportional_to_the_speed_over_a_tenth_of_a_second(before, finished):
    leg = forward()
    start = 0.977 - sum(before)
    assert drive(leg, [0.0, start, *before])[-1] == 0.0     # the trial stop
    assert leg.state is not Phase.FINISHED
    assert leg.next_speed(Pose(0.987, 0.0, 0.0)) == 0.05
    leg.next_speed(Pose(0.991, 0.0, 0.0))
    assert (leg.state is Phase.FINISHED) is finished


# no progress

def ticks_until_stuck(leg, travel, limit):
    """Return how many ticks of equal travel (m or rad) a leg accepts, at most `limit`."""
    for tick in range(limit):
        done = tick * travel
        try:
            leg.next_speed(Pose(done, 0.0, 0.0) if leg.unit == 'm' else Pose(0.0, 0.0, remainder(done, 2 * pi)))
        except StuckError:
            return tick
    return limit


def test_progress_is_a_slowest_tick_in_5_s():
    # 1 mm or 4 mrad in 5 s, which are 250 ticks
    for leg, least in (forward, 0.001 / 250), (left, 0.004 / 250):
        assert ticks_until_stuck(leg(), 1.05 * least, 2000) == 2000
        assert ticks_until_stuck(leg(), 0.95 * least, 2000) == 250


def test_a_robot_that_is_stopped_on_its_path_is_stuck_5_s_later():
    leg = forward()
    for tick in range(200):
        leg.next_speed(Pose(0.002 * tick, 0.0, 0.0))
    with pytest.raises(StuckError, match='^forward: no progress for 5 s, 0.602 of 1.000 m to go$'):
        for tick in range(251):
            leg.next_speed(Pose(0.398, 0.0, 0.0))
    assert tick == pytest.approx(250, abs=1)     # the tick of the last progress may count or not
