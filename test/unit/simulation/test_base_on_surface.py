"""On a surface, the base slips, coasts after its last command, and reports what its encoders count."""
from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.command_gate import CommandGate
from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.gyro import IdealGyro
from rbx1_nav.simulation.simulated_base import SimulatedBase
from rbx1_nav.simulation.wheels import Wheels
from sample_surface import RUN, SURFACE

WIDTH = 0.26


def make_base(timeout=1.0):
    return SimulatedBase(Wheels(WIDTH, Floor(SURFACE, RUN), 0.02), CommandGate(Limits(10, 10), round(timeout * SECOND)),
                         IdealGyro())


def drive(base, linear, angular, seconds):
    """Drive at 50 Hz, and coast to a standstill."""
    step = SECOND // 50
    end = base.now + round(seconds * SECOND)
    while base.now < end:
        base.command(base.now, linear, angular)
        base.advance(base.now + step)
    base.command(base.now, 0.0, 0.0)
    for _ in range(100):
        base.advance(base.now + step)


def test_odometry_counts_the_slip_and_the_robot_moves_without_it():
    base = make_base()
    drive(base, 0.2, 0.0, 5)
    tick = 1 / SURFACE.ticks_meter
    assert base.wheels.truth.pose.x == pytest.approx(base.odometry.pose.x * 0.98, abs=tick)
    base.reset()
    drive(base, 0.0, 1.0, pi)
    assert base.wheels.truth.pose.yaw == pytest.approx(base.odometry.pose.yaw * 0.97, abs=2 * tick / WIDTH)
    assert base.at_rest


def test_a_robot_rolls_on_after_its_last_command_and_comes_to_a_standstill():
    base = make_base(timeout=0.5)
    base.command(0, 0.2, 0.0)
    assert base.advance(SECOND // 2)
    at_timeout = base.wheels.truth.pose.x
    base.advance(SECOND)
    assert base.wheels.truth.pose.x > at_timeout
    base.advance(2 * SECOND)
    rest = base.wheels.truth.pose
    base.advance(3600 * SECOND)
    assert base.wheels.truth.pose == rest and base.at_rest and base.velocity == (0.0, 0.0)


@given(st.lists(st.integers(0, 3 * SECOND), min_size=1, max_size=20))
def test_the_true_pose_does_not_depend_on_when_it_is_asked_for(moments):
    often, once = make_base(), make_base()
    for base in (often, once):
        base.command(0, 0.2, 0.0)
    for now in sorted(moments):
        often.advance(now)
    once.advance(max(moments))
    # unlike on the ideal surface, rounding depends on the steps
    assert often.wheels.truth.pose == pytest.approx(once.wheels.truth.pose, abs=1e-9)
    assert (often.left, often.right) == pytest.approx((once.left, once.right), abs=1e-9)


def test_a_clock_that_jumps_back_lets_the_robot_roll_to_a_standstill():
    base = make_base()
    base.command(10 * SECOND, 0.2, 0.0)
    base.advance(11 * SECOND)
    x = base.wheels.truth.pose.x
    base.advance(5 * SECOND)
    base.advance(60 * SECOND)
    base.advance(61 * SECOND)
    # no farther than when braking at the acceleration limit throughout, plus the lag
    assert base.at_rest and 0 < base.wheels.truth.pose.x - x < 0.2 ** 2 / 2 / SURFACE.accel_limit + 0.2 * SURFACE.lag


def test_reset_puts_the_robot_back_and_stops_its_motors():
    base = make_base()
    drive(base, 0.2, 0.3, 1)
    base.command(base.now, 0.2, 0.3)
    base.advance(base.now + SECOND)
    base.reset()
    base.advance(base.now + SECOND)
    assert base.odometry.pose == base.wheels.truth.pose == ORIGIN and base.at_rest
