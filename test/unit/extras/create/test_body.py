"""The body of the emulated robot: true errors, and surfaces."""
from math import pi, radians

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rbx1_nav.extras.create.emulator.body import BodyErrors
from rbx1_nav.extras.create.protocol import CREATE, CREATE_2, command, drive_direct
from robots import Robot
from sample_surface import SURFACE

factors = st.floats(0.5, 2)


def driven(model, right, left, seconds, **options):
    """Return a robot in full mode that has been driven and is stationary again."""
    robot = Robot(model, **options)
    robot.send(command('start'), command('full'), drive_direct(right, left))
    robot.run(seconds)
    robot.send(drive_direct(0, 0))
    robot.run(1)
    return robot


@settings(max_examples=20)
@given(factors)
def test_wheel_travel_is_what_the_encoders_count_of_the_true_travel(factor):
    robot = driven(CREATE_2, 200, 200, 2, errors=BodyErrors(wheel_travel=factor))
    # the firmware controls the speed by its encoders, so the encoders match the command and the true travel does not
    assert robot.pose.x * factor == pytest.approx(0.4, abs=0.02)
    values = robot.read(101)
    assert values['left_encoder'] == values['right_encoder'] == pytest.approx(
        factor * robot.pose.x * 508.8 / (pi * 0.072), abs=0.5)
    assert robot.read(19)['distance'] == pytest.approx(1000 * factor * robot.pose.x, abs=0.5)


@settings(max_examples=20)
@given(factors)
def test_wheel_base_is_the_true_distance_of_the_wheels(factor):
    robot = driven(CREATE, 100, -100, 2, errors=BodyErrors(wheel_base=factor))
    assert robot.pose.yaw * factor == pytest.approx(0.2 / 0.13 * 2 / 2, abs=0.05)
    assert radians(robot.read(20)['angle']) == pytest.approx(robot.pose.yaw * factor, abs=radians(0.5))


@given(st.floats(0.5, 1.5), st.sampled_from([75.0, 150.0, 300.0]))
def test_gyro_sensitivity_is_what_the_signal_shows_of_the_true_rate(factor, gyro_range):
    robot = Robot(CREATE, errors=BodyErrors(gyro_sensitivity=factor), gyro_range=gyro_range)
    robot.send(command('start'), command('full'), drive_direct(-65, 65))    # -0.5 rad/s
    adc = robot.read(33)['analog_input']
    assert radians(-(adc - 512) / 512 * gyro_range) == pytest.approx(-0.5 * factor, abs=radians(gyro_range / 512))


def test_on_a_surface_the_robot_rolls_out_slips_and_its_gyro_is_noisy():
    robot = Robot(CREATE, SURFACE)
    robot.send(command('start'), command('full'))
    rest = {robot.read(33)['analog_input'] for _ in range(50)}
    assert len(rest) > 1
    robot.send(drive_direct(300, 300))
    robot.run(2)
    robot.send(drive_direct(0, 0))
    at_stop = robot.pose.x
    robot.run(2)
    counted = robot.read(19)['distance'] / 1000
    assert robot.pose.x > at_stop + 0.01
    assert counted * (1 - robot.body.wheels.floor.run.slip_straight) == pytest.approx(robot.pose.x, abs=1e-3)
