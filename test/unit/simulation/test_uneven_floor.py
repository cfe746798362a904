"""Wheels on a nonuniform floor: curvature, the loss of speed in a turn, and noise."""
from math import cos, hypot, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.floor_noise import Roughness
from rbx1_nav.simulation.slip import RandomErrors
from rbx1_nav.simulation.wheels import Wheels
from sample_surface import SURFACE

WIDTH = 0.26
NO_SLIP = RandomErrors(0.0, 0.0, 0.0, 0.0)
EVEN = SURFACE._replace(slip_straight=0.0, slip_straight_spread=0.0, slip_turning=0.0, slip_turning_spread=0.0,
                        ticks_meter=1e6)
# motors without drag, far from their limit: both modes follow their commands equally, so a motion is one arc
LINEAR = EVEN._replace(drag_straight=0.0, drag_turning=0.0, accel_limit=1e3, delay=0.23, curvature=-0.04,
                       turning_loss=0.1)
SEEDS = range(20)

speeds = st.floats(-1, 1)


def make_wheels(surface, seed=0):
    return Wheels(WIDTH, Floor(surface, NO_SLIP, Roughness(surface, seed)), 0.02)


def counted(wheels):
    """Return (straight in m, turn in rad) from the wheels' travel, not rounded."""
    return (wheels.left.total + wheels.right.total) / 2, (wheels.right.total - wheels.left.total) / WIDTH


def drive(wheels, linear, angular, duration, step=0.05):
    for _ in range(round(duration / step)):
        wheels.travel(linear, angular, step)


@given(st.lists(st.floats(0.001, 0.5), max_size=40))
def test_the_end_does_not_depend_on_the_length_of_the_steps(steps):
    commands = [(0.2, 0.5, 3.0), (0.0, 0.0, 4.0), (0.0, -1.0, 2.0), (0.0, 0.0, 4.0), (-0.3, 0.4, 1.0), (0.0, 0.0, 4.0)]
    whole, parts = make_wheels(LINEAR), make_wheels(LINEAR)
    steps = iter(steps)
    for linear, angular, duration in commands:
        whole.travel(linear, angular, duration)
        while duration > 0:
            step = min(duration, next(steps, duration))
            parts.travel(linear, angular, step)
            duration -= step
    # the remaining speed after a stop of 4 s is below 1e-15 m/s
    assert parts.truth.pose == pytest.approx(whole.truth.pose, abs=1e-9)
    assert hypot(*whole.truth.pose[:2]) > 0.1


@given(st.floats(-2, 2), st.floats(-1, 1).filter(lambda speed: abs(speed) > 0.1))
def test_curvature_turns_the_robot_by_each_metre_forwards_and_back(curvature, speed):
    wheels = make_wheels(EVEN._replace(curvature=curvature))
    drive(wheels, speed, 0.0, 3)
    straight, turn = counted(wheels)
    assert turn == 0 and wheels.truth.pose.yaw == pytest.approx(curvature * straight, abs=1e-12)
    linear, angular = wheels.true_velocity()
    assert angular == pytest.approx(curvature * linear, abs=1e-12)


def test_turning_loss_shortens_the_way_by_each_radian():
    wheels, lossless = make_wheels(LINEAR), make_wheels(LINEAR._replace(turning_loss=0.0))
    for each in (wheels, lossless):
        each.travel(0.2, -0.5, 10)
    # 0.2 m/s minus 0.1 m * 0.5 rad/s; the encoder counts do not change
    assert wheels.true_velocity() == pytest.approx((0.15, -0.5 - 0.04 * 0.2), abs=1e-9)
    assert lossless.true_velocity() == pytest.approx((0.2, -0.5 - 0.04 * 0.2), abs=1e-9)
    assert counted(wheels) == counted(lossless)
    assert wheels.truth.pose.yaw == lossless.truth.pose.yaw


@given(st.lists(st.tuples(speeds, speeds, st.floats(0, 1)), max_size=20), st.floats(0, 1))
def test_turning_loss_never_drives_the_robot_against_its_wheels(commands, loss):
    wheels = make_wheels(EVEN._replace(turning_loss=loss))
    for command in commands:
        before, pose = counted(wheels)[0], wheels.truth.pose
        wheels.travel(*command)
        straight, (linear, _) = counted(wheels)[0] - before, wheels.true_velocity()
        x, y, yaw = wheels.truth.pose
        middle = (yaw + pose.yaw) / 2
        # the chord of an arc of at most 1 rad points forward if the arc does
        forward = (x - pose.x) * cos(middle) + (y - pose.y) * sin(middle)
        assert forward * straight >= -1e-12 and abs(forward) <= abs(straight) + 1e-9
        assert linear * wheels.straight.speed >= 0


def ends(surface, linear, angular, duration):
    """Return the Wheels of all SEEDS after a motion."""
    runs = []
    for seed in SEEDS:
        runs.append(make_wheels(surface, seed))
        drive(runs[-1], linear, angular, duration)
    return runs


def test_encoders_do_not_see_the_noise():
    rough = ends(EVEN._replace(distance_noise=0.05, heading_noise_turning=0.1), 0.2, 0.5, 1)
    assert {counted(wheels) for wheels in rough} == {counted(rough[0])}
    assert len({wheels.truth.pose for wheels in rough}) == len(rough)
