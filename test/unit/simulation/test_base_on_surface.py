"""On a surface, the base slips, coasts after its last command, and reports what its encoders count."""
from math import pi
import os

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.control.gate import CommandGate
from rbx1_nav.robot.description import Limits, load_robot
from rbx1_nav.robot.kinematics import ORIGIN
from rbx1_nav.simulation import base as simulated
from rbx1_nav.simulation.base import SimulatedBase
from rbx1_nav.simulation.gyro import IdealGyro
from rbx1_nav.simulation.wheels import Wheels
from rbx1_nav.units import SECOND
from sample_surface import RUN, SURFACE

WIDTH = 0.26
TURTLEBOT = os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'turtlebot.yaml')


def make_base(timeout=1.0):
    return SimulatedBase(Wheels(WIDTH, SURFACE, RUN, 0.02), CommandGate(Limits(10, 10), round(timeout * SECOND)),
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


def test_the_reported_speed_is_a_whole_number_of_ticks():
    base = make_base()
    base.command(0, 0.2, 0.0)
    counts = set()
    for tick in range(1, 50):
        base.advance(tick * SECOND // 50)
        linear, angular = base.velocity
        counts.add(round(linear * 0.02 * 2 * SURFACE.ticks_meter, 6))
        assert abs(linear - base.wheels.straight.speed) < 0.04 and angular == 0
    assert all(count == int(count) for count in counts) and len(counts) > 2


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


def test_uncertainty_of_the_pose_grows_with_the_path_and_that_of_the_speed_ends_at_standstill():
    base = make_base()
    before = base.wheels.uncertainty
    base.command(0, 0.2, 1.0)
    base.advance(SECOND)
    moving = base.wheels.uncertainty
    base.advance(3 * SECOND)
    base.advance(4 * SECOND)
    after = base.wheels.uncertainty
    assert moving.linear > after.linear == before.linear and moving.angular > after.angular == before.angular
    assert after.position > before.position and after.yaw > before.yaw


@pytest.mark.parametrize('rate, window', [(50, 0.02), (10, 0.1), (2, 0.1)])
def test_the_reported_speeds_are_means_over_the_time_between_messages_or_a_tenth_of_a_second(rate, window):
    robot = load_robot(TURTLEBOT)._replace(rate=rate, timeout=0)
    base = simulated.make_base(robot, SURFACE._replace(ticks_meter=1e6), 0)
    base.command(0, 0.2, 0.0)
    # three quarters of this time are enough, because steps differ slightly from their nominal length
    base.advance(round(0.7 * window * SECOND))
    assert base.velocity == (0.0, 0.0)
    base.advance(round(0.8 * window * SECOND))
    assert base.velocity[0] > 0
