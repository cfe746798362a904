"""On the ideal surface, each command counts for exactly as long as it is in force."""
from math import inf, nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.command_gate import CommandGate, RejectedCommand
from rbx1_nav.base.kinematics import ORIGIN, arc
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND
from rbx1_nav.simulation.gyro import IdealGyro
from rbx1_nav.simulation.simulated_base import SimulatedBase
from rbx1_nav.simulation.wheels import IdealWheels


def make_base(timeout=1.0, limits=Limits(inf, inf)):
    return SimulatedBase(IdealWheels(0.26), CommandGate(limits, round(timeout * SECOND)), IdealGyro())


@given(st.lists(st.integers(0, 3 * SECOND), min_size=1, max_size=20))
def test_the_pose_does_not_depend_on_when_it_is_asked_for(moments):
    often, once = make_base(), make_base()
    for base in (often, once):
        base.command(0, 0.2, 0.5)
    for now in sorted(moments):
        often.advance(now)
        expected = arc(ORIGIN, 0.2 * min(now, SECOND) / SECOND, 0.5 * min(now, SECOND) / SECOND)
        assert often.odometry.pose == pytest.approx(expected, abs=1e-12)
    once.advance(max(moments))
    assert often.odometry.pose == pytest.approx(once.odometry.pose, abs=1e-12)


def test_a_timeout_stops_the_base_exactly_then_even_if_noticed_late():
    base = make_base(timeout=0.5)
    base.command(0, 0.2, 0.0)
    assert not base.advance(SECOND // 2 - 1)
    assert base.advance(3600 * SECOND)
    assert base.odometry.pose.x == pytest.approx(0.1, abs=1e-12)
    assert not base.gate.moving and not base.advance(3601 * SECOND)


@given(st.lists(st.tuples(st.integers(-10 ** 13, 10 ** 13), st.booleans()), max_size=30))
def test_on_every_clock_a_command_moves_the_base_by_at_most_timeout_times_speed(steps):
    base, now, commands = make_base(), 10 ** 14, 0
    for step, command in steps:
        now += step
        if command:
            base.command(now, 0.2, 0.0)
            commands += 1
        else:
            base.advance(now)
        assert 0 <= base.odometry.pose.x <= 0.2 * commands + 1e-9


def test_a_clock_that_jumps_back_ends_the_command():
    base = make_base()
    base.command(10 * SECOND, 0.2, 0.0)
    base.advance(5 * SECOND)
    base.advance(6 * SECOND)
    assert base.odometry.pose == ORIGIN and not base.gate.moving


@pytest.mark.parametrize('command', [(nan, 0.0), (0.2, inf), (-inf, nan), (0.2, 0.0, (0.0, nan)), (1e308, 1e308)])
def test_a_rejected_command_stops_the_base_at_its_arrival(command):
    base = make_base()
    base.command(0, 0.2, 0.0)
    with pytest.raises(RejectedCommand):
        base.command(SECOND // 2, *command)
    base.advance(SECOND)
    assert base.odometry.pose.x == pytest.approx(0.1)
    assert base.gate.rejected == 1 and not base.gate.moving


def test_reset_puts_the_base_at_the_origin_at_a_standstill():
    base = make_base()
    base.command(0, 0.2, 1.0)
    base.advance(SECOND // 2)
    base.reset()
    base.advance(SECOND)
    assert base.odometry.pose == ORIGIN


def test_the_true_pose_is_that_of_the_odometry_bit_for_bit():
    base, step = make_base(), SECOND // 49
    while base.now < 2 * SECOND:
        base.command(base.now, 0.2, 0.7)
        base.advance(base.now + step)
    base.command(base.now, 0.0, 0.0)
    for _ in range(100):
        base.advance(base.now + step)
    assert base.wheels.truth.pose == base.odometry.pose != ORIGIN


def test_the_total_travel_of_each_wheel():
    base = make_base()
    base.command(0, 0.2, 1.0)
    base.advance(SECOND // 2)
    base.command(base.now, -0.1, 0.0)
    base.advance(SECOND)
    # 0.2 m/s minus and plus 1 rad/s * 0.13 m for 0.5 s, and then 0.05 m back
    assert (base.left, base.right) == pytest.approx((0.035 - 0.05, 0.165 - 0.05))


def test_the_gyro_measures_the_mean_rate_since_the_last_reading():
    base = make_base()
    base.command(SECOND, 0.0, 0.5)
    assert base.read_gyro() is None
    base.advance(SECOND + SECOND // 2)
    assert base.read_gyro()[::2] == pytest.approx((0.5, 0.25))
    assert base.read_gyro() is None     # no time has passed
    base.command(base.now, 0.0, 0.0)
    base.advance(2 * SECOND)
    assert base.read_gyro()[::2] == pytest.approx((0.0, 0.25))
    base.advance(SECOND)                # the clock jumped back
    assert base.read_gyro() is None
    base.advance(3 * SECOND)
    assert base.read_gyro().rate == 0.0
