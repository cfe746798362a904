"""The odometry-based exercise: each leg stops when the pose has reached its goal."""
from collections import deque
from math import hypot, inf, pi, remainder

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import ORIGIN, Pose, arc
from rbx1_nav.exercise.legs import Phase, StuckError, is_reachable, out_and_back_by_odometry
from rbx1_nav.simulation.motors import Motor

LEGS = dict(linear_speed=0.2, goal_distance=1.0, angular_speed=1.0, goal_angle=pi, rate=50, min_linear_speed=0.05,
            min_angular_speed=0.2)
HALF_WIDTH = 0.13   # m, half of the TurtleBot's base width


def drive(leg, pose, fraction=1.0):
    """Drive a leg with a robot that moves by a fraction of each command; return its last Pose and all speeds."""
    speeds = []
    while True:
        speed = leg.next_speed(pose._replace(yaw=remainder(pose.yaw, 2 * pi)))
        if leg.state is Phase.FINISHED:
            return pose, speeds
        speeds.append(speed)
        linear, angular = leg.velocity(speed)
        pose = arc(pose, fraction * linear / 50, fraction * angular / 50)


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(-10, 10), st.floats(0.5, 1.0))
def test_a_leg_stops_at_its_goal_from_every_pose_and_with_a_robot_that_slips(x, y, yaw, fraction):
    forward, turn, *_ = out_and_back_by_odometry(**LEGS)
    pose, speeds = drive(forward, Pose(x, y, yaw), fraction)
    # half of the slowest tick's travel: 0.05 m/s and 0.2 rad/s, 1/50 s
    assert hypot(pose.x - x, pose.y - y) == pytest.approx(1.0, abs=0.5001 * 0.001)
    assert min(filter(None, speeds)) >= 0.05 and max(speeds) == 0.2 == speeds[0]
    pose, speeds = drive(turn, pose, fraction)
    assert pose.yaw - yaw == pytest.approx(pi, abs=0.5001 * 0.004)
    assert min(filter(None, speeds)) >= 0.2 and max(speeds) == 1.0 == speeds[0]


def test_a_trial_stop_comes_just_before_the_goal_and_then_the_lowest_speed():
    for leg in out_and_back_by_odometry(**LEGS)[:2]:
        _, speeds = drive(leg, ORIGIN)
        # for the remaining half second
        assert speeds.count(0.0) == 1 and speeds[speeds.index(0.0) + 1:] == [leg.min_speed] * 25


def roll(leg, lag, drag, delay):
    """Drive a leg with motors until they are stationary; return how far the robot went, m or rad."""
    straight, turning = Motor(lag, 1.0, drag), Motor(lag, 1.0, drag)
    pending, pose = deque([(0.0, 0.0)] * delay), ORIGIN

    def tick(speed):
        pending.append(leg.velocity(speed))
        linear, angular = pending.popleft()
        return arc(pose, straight.travel(linear, 0.02), turning.travel(angular * HALF_WIDTH, 0.02) / HALF_WIDTH)

    for rest in 25, 100:    # ticks of the trial stop, and ticks until the robot is certainly stationary
        speed = leg.next_speed(pose)
        while speed:
            pose = tick(speed)
            speed = leg.next_speed(pose)
        for _ in range(rest):
            pose = tick(0.0)
    return pose.x or pose.yaw


@pytest.mark.parametrize('lag', [0.001, 0.05, 0.1])
@pytest.mark.parametrize('drag', [0.0005, 0.002, 0.015])
@pytest.mark.parametrize('delay', [0, 2])
def test_the_robot_comes_to_a_standstill_at_the_goal_however_far_it_rolls_on(lag, drag, delay):
    """lag: s; drag: m/s; delay: ticks from a command to the motors."""
    forward, turn, *_ = out_and_back_by_odometry(**LEGS)
    # half of the travel per tick, 0.5 mm and 0.11 degrees, and a fifth of the coasting, up to 7 mm and 1.6 degrees
    assert roll(forward, lag, drag, delay) == pytest.approx(1.0, abs=0.002)
    assert roll(turn, lag, drag, delay) == pytest.approx(pi, abs=0.008)


@pytest.mark.parametrize('rate', [0.1, 1, 5])
def test_a_slow_rate_does_not_overshoot_the_goal(rate):
    for leg, slowest in zip(out_and_back_by_odometry(**dict(LEGS, rate=rate)), (0.05, 0.2)):
        pose = ORIGIN
        while True:
            speed = leg.next_speed(pose._replace(yaw=remainder(pose.yaw, 2 * pi)))
            if leg.state is Phase.FINISHED:
                break
            pose = arc(pose, *(value / rate for value in leg.velocity(speed)))
        assert abs(leg.goal - leg.done()) <= 0.5001 * slowest / rate


@pytest.mark.parametrize('change', [dict(goal_distance=1e-4), dict(rate=1e-300), dict(goal_angle=inf),
                                    dict(linear_speed=1e-9)])
def test_legs_shorter_than_a_tick_or_longer_than_a_day_are_rejected(change):
    with pytest.raises(ValueError, match='expected from 1 to 100000000'):
        out_and_back_by_odometry(**dict(LEGS, **change))


def test_a_turn_can_be_more_than_a_full_one():
    pose, _ = drive(out_and_back_by_odometry(**dict(LEGS, goal_angle=7.0))[1], ORIGIN)
    assert pose.yaw == pytest.approx(7.0, abs=0.002001)


@pytest.mark.parametrize('fraction', [0.0, -1.0])
def test_a_leg_without_progress_ends_with_an_error(fraction):
    with pytest.raises(StuckError, match='forward: no progress for 5 s, .* of 1.000 m to go'):
        drive(out_and_back_by_odometry(**LEGS)[0], ORIGIN, fraction)


# poses that a robot cannot have reached

@pytest.mark.parametrize('before, after, elapsed, reachable', [
    ((0.0, 0.0, 0.0), (0.004, 0.0, 0.0), 0.02, True), ((0.5, 0.0, 0.0), (0.0, 0.0, 0.0), 0.02, False),
    # full speed for this time, half of it in addition, and 0.1 m
    ((0.5, 0.0, 0.0), (0.89, 0.0, 0.0), 1.0, True), ((0.5, 0.0, 0.0), (0.91, 0.0, 0.0), 1.0, False),
    # no pose for a long time: the robot was stopped
    ((0.5, 0.0, 0.0), (0.91, 0.0, 0.0), 100.0, False), ((0.5, 0.0, 0.0), (0.5, 0.0, 0.0), 100.0, True),
    # a clock that jumped back gives it no time
    ((0.5, 0.0, 0.0), (0.59, 0.0, 0.0), -5.0, True), ((0.5, 0.0, 0.0), (0.61, 0.0, 0.0), -5.0, False),
    # forward is the direction of the heading
    ((1.0, 0.0, pi), (0.7, 0.0, pi), 1.0, True), ((0.7, 0.0, pi), (1.0, 0.0, pi), 1.0, False),
    ((0.0, 0.0, 0.0), (0.0, 0.15, 0.0), 0.1, False),
    # it turns left, also across pi
    ((0.0, 0.0, 3.0), (0.0, 0.0, -2.5), 1.0, True), ((0.0, 0.0, -2.5), (0.0, 0.0, 3.0), 1.0, False),
    ((1.0, 0.0, 2.0), (1.0, 0.0, 0.0), 0.02, False), ((1.0, 0.0, 0.0), (1.0, 0.0, -0.19), 0.02, True)])
def test_a_pose_that_jumps_is_not_reachable(before, after, elapsed, reachable):
    assert is_reachable(Pose(*before), Pose(*after), elapsed, 0.2, 1.0) is reachable
