"""Wheels on a surface: motors that lag and fall short, slip, and ticks."""
from math import pi

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rbx1_nav.control.gate import CommandGate
from rbx1_nav.model.gyro import IdealGyro
from rbx1_nav.model.robot import Limits
from rbx1_nav.simulated_base import SimulatedBase
from rbx1_nav.units import SECOND
from rbx1_nav.model.kinematics import ORIGIN
from rbx1_nav.model.surfaces import Run, Surface
from rbx1_nav.model.wheels import Encoder, IdealWheels, Motor, Wheels

WIDTH = 0.26
SURFACE = Surface('test', lag=0.1, accel_limit=1.0, drag_straight=0.01, drag_turning=0.02,
                  slip_straight=0.02, slip_straight_spread=0.01, slip_turning=0.03, slip_turning_spread=0.01,
                  ticks_meter=4100, gyro_noise=0.002, gyro_bias=0.01, gyro_scale_error=0.003, gyro_measurement_range=2.6)
RUN = Run(0.02, 0.03, 0.0, 0.0)

speeds = st.floats(-1, 1)
motors = st.builds(Motor, st.floats(0.01, 1), st.floats(0.1, 5), st.floats(1e-3, 0.1))


def twin(motor):
    """Another motor, in the same state."""
    other = Motor(motor.lag, motor.accel_limit, motor.drag)
    other.speed = motor.speed
    return other


@given(motors, speeds, speeds, st.floats(0, 3), st.floats(0, 1))
@example(Motor(1.0, 1.0, 0.0625), 1.0, 0.0625, 1.0, 0.5)    # a command of just the drag
def test_it_does_not_matter_in_how_many_steps_a_motor_is_asked(motor, speed, command, duration, fraction):
    motor.speed = speed
    split = twin(motor)
    whole = motor.travel(command, duration)
    parts = split.travel(command, duration * fraction) + split.travel(command, duration - duration * fraction)
    assert parts == pytest.approx(whole, abs=1e-9)
    # a speed that has just come to 0 may be 0 in one and the last crumb in the other
    assert split.speed == pytest.approx(motor.speed, abs=1e-9)


@given(motors, speeds, speeds)
def test_the_closed_form_solves_the_equation_of_motion(motor, speed, command):
    motor.speed = speed
    v, step, travel = speed, 1e-5, 0.0
    for _ in range(2000):
        drag = motor.drag if (v or command) > 0 else -motor.drag
        pull = max(-motor.accel_limit, min(motor.accel_limit, (command - v - drag) / motor.lag))
        before, v = v, v + pull * step
        if before * v < 0 or before == 0 and abs(command) <= motor.drag:
            v = 0.0
        travel += (before + v) / 2 * step
    # Euler's error is of the order of the step; where the speed crosses 0 the drag turns round within one step
    assert motor.travel(command, 0.02) == pytest.approx(travel, abs=2e-5)
    assert motor.speed == pytest.approx(v, abs=2e-3)


@given(motors, speeds, st.lists(st.tuples(speeds, st.floats(0, 0.5)), max_size=20))
def test_a_motor_never_accelerates_more_than_its_limit_nor_goes_faster_than_it_is_told(motor, speed, commands):
    motor.speed, most = speed, abs(speed)
    for command, duration in commands:
        before = motor.speed
        most = max(most, abs(command))
        travel = motor.travel(command, duration)
        assert abs(motor.speed - before) <= motor.accel_limit * duration + 1e-12
        assert abs(motor.speed) <= most and abs(travel) <= most * duration + 1e-12


@given(motors, st.sampled_from([1e-300, 1.0, 1e6]), st.sampled_from([1e-300, 1.0, 1e9]))
def test_no_speed_and_no_duration_takes_for_ever(motor, command, duration):
    for _ in range(3):
        motor.travel(command, duration)
        motor.travel(-command, duration)


@given(motors, st.floats(0.2, 1))
def test_it_stays_behind_its_command_by_the_drag(motor, command):
    motor.travel(command, 100)
    assert motor.speed == pytest.approx(command - motor.drag)


@given(motors, st.floats(0, 1))
def test_what_is_less_than_the_drag_moves_nothing_that_stands(motor, part):
    assert motor.travel(-motor.drag * part, 10) == 0 and motor.speed == 0


@given(motors, speeds)
def test_without_a_command_it_comes_to_rest_and_stays_there(motor, speed):
    motor.speed = speed
    # braking takes at most speed / limit, and then at most lag * log(limit * lag / drag + 1), both under 10 s here
    motor.travel(0.0, 20)
    assert motor.speed == 0 and motor.travel(0.0, 20) == 0


@given(st.lists(st.floats(-1, 1), max_size=30), st.floats(10, 10000))
def test_an_encoder_counts_whole_ticks_and_loses_none(ways, ticks_meter):
    encoder = Encoder(ticks_meter)
    counted = 0.0
    for way in ways:
        count = encoder.count(way)
        counted += count
        assert count * ticks_meter == pytest.approx(round(count * ticks_meter), abs=1e-6)
    # to half a tick; what floats lose in sums over up to 30 m besides
    assert abs(counted - sum(ways)) <= 0.5 / ticks_meter + 1e-12


def make_base(timeout=1.0):
    return Base(Wheels(WIDTH, SURFACE, RUN, 0.02), Limits(10, 10), round(timeout * SECOND))


def drive(base, linear, angular, seconds, step=SECOND // 50):
    end = base.now + round(seconds * SECOND)
    while base.now < end:
        base.command(base.now, linear, angular)
        base.advance(base.now + step)
    base.command(base.now, 0.0, 0.0)
    for _ in range(100):
        base.advance(base.now + step)


def test_slip_is_what_odometry_counts_and_the_robot_does_not_do():
    base = make_base()
    drive(base, 0.2, 0.0, 5)
    tick = 1 / SURFACE.ticks_meter
    assert base.wheels.truth.pose.x == pytest.approx(base.odometry.pose.x * 0.98, abs=tick)
    base.reset()
    drive(base, 0.0, 1.0, pi)
    assert base.wheels.truth.pose.yaw == pytest.approx(base.odometry.pose.yaw * 0.97, abs=2 * tick / WIDTH)
    assert base.standing


def test_the_speed_that_is_told_is_counted():
    base = make_base()
    base.command(0, 0.2, 0.0)
    seen = set()
    for tick in range(1, 50):
        base.advance(tick * SECOND // 50)
        linear, angular = base.velocity
        seen.add(round(linear * 0.02 * 2 * SURFACE.ticks_meter, 6))
        assert abs(linear - base.wheels.straight.speed) < 0.04 and angular == 0
    assert all(count == int(count) for count in seen) and len(seen) > 2


def test_a_robot_rolls_out_after_its_last_command_and_then_stands():
    base = make_base(timeout=0.5)
    base.command(0, 0.2, 0.0)
    assert base.advance(SECOND // 2)
    at_timeout = base.wheels.truth.pose.x
    base.advance(SECOND)
    assert base.wheels.truth.pose.x > at_timeout
    base.advance(2 * SECOND)
    rest = base.wheels.truth.pose
    base.advance(3600 * SECOND)
    assert base.wheels.truth.pose == rest and base.standing and base.velocity == (0.0, 0.0)


@given(st.lists(st.integers(0, 3 * SECOND), min_size=1, max_size=20))
def test_when_it_is_asked_does_not_matter_to_the_truth(moments):
    asked, alone = make_base(), make_base()
    for base in (asked, alone):
        base.command(0, 0.2, 0.0)
    for now in sorted(moments):
        asked.advance(now)
    alone.advance(max(moments))
    # unlike its pose on an ideal floor, the speed after a stop may be a crumb (see above)
    assert asked.wheels.truth.pose == pytest.approx(alone.wheels.truth.pose, abs=1e-9)
    assert (asked.left, asked.right) == pytest.approx((alone.left, alone.right), abs=1e-9)


def test_a_clock_that_goes_back_lets_it_roll_out():
    base = make_base()
    base.command(10 * SECOND, 0.2, 0.0)
    base.advance(11 * SECOND)
    x = base.wheels.truth.pose.x
    base.advance(5 * SECOND)
    base.advance(60 * SECOND)
    base.advance(61 * SECOND)
    # no farther than with the limit all the way down, and the lag after it
    assert base.standing and 0 < base.wheels.truth.pose.x - x < 0.2 ** 2 / 2 / SURFACE.accel_limit + 0.2 * SURFACE.lag


def test_reset_puts_the_robot_back_and_stops_its_motors():
    base = make_base()
    drive(base, 0.2, 0.3, 1)
    base.command(base.now, 0.2, 0.3)
    base.advance(base.now + SECOND)
    base.reset()
    base.advance(base.now + SECOND)
    assert base.odometry.pose == base.wheels.truth.pose == ORIGIN and base.standing


def test_a_robot_that_stands_knows_it_and_one_that_went_far_knows_less():
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


def test_a_speed_over_a_shorter_time_is_known_less_well():
    often, seldom = (Wheels(WIDTH, SURFACE, RUN, window) for window in (0.005, 0.02))
    for wheels in (often, seldom):
        for _ in range(10):
            wheels.travel(0.2, 0.0, 0.005)
    # but for the millimetre that both have
    assert often.uncertainty.linear - 1e-6 == pytest.approx(16 * (seldom.uncertainty.linear - 1e-6))


def test_on_no_surface_truth_is_what_is_counted_bit_for_bit():
    base = Base(IdealWheels(WIDTH), Limits(10, 10), SECOND)
    drive(base, 0.2, 0.7, 2, step=SECOND // 49)
    assert base.wheels.truth.pose == base.odometry.pose != ORIGIN
