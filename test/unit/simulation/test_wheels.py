"""Wheels on a surface: motors with lag, limited acceleration and drag, and encoders that count whole ticks."""
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from rbx1_nav.simulation.motors import Motor
from rbx1_nav.simulation.wheels import Encoder

speeds = st.floats(-1, 1)
motors = st.builds(Motor, st.floats(0.01, 1), st.floats(0.1, 5), st.floats(1e-3, 0.1))


def twin(motor):
    """Return another motor in the same state."""
    other = Motor(motor.lag, motor.accel_limit, motor.drag)
    other.speed = motor.speed
    return other


@given(motors, speeds, speeds, st.floats(0, 3), st.floats(0, 1))
@example(Motor(1.0, 1.0, 0.0625), 1.0, 0.0625, 1.0, 0.5)    # a command equal to the drag
def test_the_travel_of_a_motor_does_not_depend_on_the_number_of_steps(motor, speed, command, duration, fraction):
    motor.speed = speed
    split = twin(motor)
    whole = motor.travel(command, duration)
    parts = split.travel(command, duration * fraction) + split.travel(command, duration - duration * fraction)
    assert parts == pytest.approx(whole, abs=1e-9)
    # after a stop, the speed of one motor may be exactly 0, and the speed of the other a rounding error
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
    # the error of Euler's method is of the order of the step; the drag changes its sign within one step
    assert motor.travel(command, 0.02) == pytest.approx(travel, abs=2e-5)
    assert motor.speed == pytest.approx(v, abs=2e-3)


@given(motors, speeds, st.lists(st.tuples(speeds, st.floats(0, 0.5)), max_size=20))
def test_a_motor_exceeds_neither_its_acceleration_limit_nor_the_commanded_speed(motor, speed, commands):
    motor.speed, highest = speed, abs(speed)
    for command, duration in commands:
        before = motor.speed
        highest = max(highest, abs(command))
        travel = motor.travel(command, duration)
        assert abs(motor.speed - before) <= motor.accel_limit * duration + 1e-12
        assert abs(motor.speed) <= highest and abs(travel) <= highest * duration + 1e-12


@given(motors, st.sampled_from([1e-300, 1.0, 1e6]), st.sampled_from([1e-300, 1.0, 1e9]))
def test_no_speed_or_duration_causes_an_endless_loop(motor, command, duration):
    for _ in range(3):
        motor.travel(command, duration)
        motor.travel(-command, duration)


@given(motors, st.floats(0.2, 1))
def test_the_final_speed_is_the_command_less_the_drag(motor, command):
    motor.travel(command, 100)
    assert motor.speed == pytest.approx(command - motor.drag)


@given(motors, st.floats(0, 1))
def test_a_command_below_the_drag_does_not_start_a_motor(motor, fraction):
    assert motor.travel(-motor.drag * fraction, 10) == 0 and motor.speed == 0


@given(motors, speeds)
def test_without_a_command_a_motor_stops_and_stands_still(motor, speed):
    motor.speed = speed
    # braking takes at most speed / limit, and then at most lag * log(limit * lag / drag + 1), both below 10 s here
    motor.travel(0.0, 20)
    assert motor.speed == 0 and motor.travel(0.0, 20) == 0


@given(st.lists(st.floats(-1, 1), max_size=30), st.floats(10, 10000))
def test_an_encoder_counts_whole_ticks_and_loses_none(travels, ticks_meter):
    encoder = Encoder(ticks_meter)
    counted = 0.0
    for travel in travels:
        count = encoder.count(travel)
        counted += count
        assert count * ticks_meter == pytest.approx(round(count * ticks_meter), abs=1e-6)
    # half a tick, and rounding errors of sums of up to 30 m
    assert abs(counted - sum(travels)) <= 0.5 / ticks_meter + 1e-12
