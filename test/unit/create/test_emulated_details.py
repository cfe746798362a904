"""Details of the emulated robot's body: its wheels, sensors, battery and encoders."""
from math import pi

import pytest

from rbx1_nav.create.emulator.body import BodyErrors, DroppingTally, Tally
from rbx1_nav.create.protocol import CREATE, CREATE_2, FULL, MODELS, SAFE, command, drive_direct
from robots import robot_in

both = pytest.mark.parametrize('model', list(MODELS.values()), ids=list(MODELS))


def pair(first, second):
    """Return the data bytes of two 16-bit numbers."""
    return [byte for value in (first, second) for byte in value.to_bytes(2, 'big', signed=True)]


# wheels

@both
@pytest.mark.parametrize('velocity, radius, curvature', [
    (200, 1000, 1.0), (200, -1000, -1.0), (200, 2, 500.0), (200, 0, 0.0)])
def test_the_wheels_in_a_curve(model, velocity, radius, curvature):
    robot = robot_in(FULL, model)
    robot.send(command('drive', *pair(velocity, radius)))
    # a wheel on a circle around the same center, limited to 500 mm/s; curvature in 1/m
    difference = velocity * curvature * model.wheel_separation / 2
    assert (robot.body.left, robot.body.right) == pytest.approx(
        [max(-500, min(500, each)) for each in (velocity - difference, velocity + difference)])


@both
def test_a_velocity_beyond_the_limit_is_clamped(model):
    robot = robot_in(FULL, model)
    robot.send(command('drive', *pair(700, 32767)))
    assert robot.read(39) == {'requested_velocity': 500} and robot.body.left == robot.body.right == 500
    robot.send(drive_direct(-600, 499))
    assert (robot.body.right, robot.body.left) == (-500, 499)
    assert robot.read(41) == {'requested_right_velocity': -500} and robot.read(42) == {'requested_left_velocity': 499}
    robot.send(command('safe'))     # only passive mode stops the wheels
    assert robot.body.moving and robot.read(41) == {'requested_right_velocity': -500}


@pytest.mark.parametrize('pwm, speed', [(255, 500), (-255, -500), (51, 100), (300, 500), (0, 0)])
def test_pwm_is_a_fraction_of_255(pwm, speed):
    robot = robot_in(FULL, CREATE_2)
    robot.send(command('drive_pwm', *pair(pwm, -51)))
    assert (robot.body.right, robot.body.left) == pytest.approx((speed, -100))


@pytest.mark.parametrize('right, left, currents, stasis', [
    (100, 100, (150, 150), 1), (100, 0, (0, 150), 0), (0, 100, (150, 0), 0), (0, 0, (0, 0), 0),
    (-100, -100, (150, 150), 0), (100, -90, (150, 150), 0), (100, 1, (150, 150), 1)])
def test_the_motors_of_a_create_2(right, left, currents, stasis):
    """The caster turns while both wheels turn forward."""
    robot = robot_in(FULL, CREATE_2)
    robot.send(drive_direct(right, left))
    assert (robot.read(54)['left_motor_current'], robot.read(55)['right_motor_current']) == currents
    assert robot.read(58) == {'stasis': stasis}


@both
@pytest.mark.parametrize('model_errors', [BodyErrors(wheel_travel=0.5), BodyErrors(wheel_base=2.0)])
def test_true_velocities(model, model_errors):
    robot = robot_in(FULL, model, errors=model_errors)
    robot.send(drive_direct(200, 100))
    factor = model_errors.wheel_travel
    assert robot.body.velocity == pytest.approx((
        0.15 / factor, 0.1 / factor / (model.wheel_separation * model_errors.wheel_base)))


# sensors

@both
def test_a_robot_at_rest(model):
    robot = robot_in(SAFE, model)
    values = robot.read(6)
    shown = {name: value for name, value in values.items() if value}
    others = {'infrared': 255, 'digital_inputs': 15, 'analog_input': 512} if model is CREATE else {}
    assert shown == {'voltage': 16500, 'current': -300, 'temperature': 25, 'charge': 3000, 'capacity': 3000,
                     'mode': SAFE, 'cliff_left_signal': 1500, 'cliff_front_left_signal': 1500,
                     'cliff_front_right_signal': 1500, 'cliff_right_signal': 1500, **others}


@both
def test_a_cliff_is_seen_by_the_two_front_sensors(model):
    robot = robot_in(FULL, model)
    robot.body.cliff = True
    robot.run(0.02)
    values = robot.read(1)
    assert [values[f'cliff_{each}'] for each in ('left', 'front_left', 'front_right', 'right')] == [0, 1, 1, 0]
    values = robot.read(4)
    assert [values[f'cliff_{each}_signal'] for each in ('left', 'front_left', 'front_right', 'right')] == [
        1500, 20, 20, 1500]


@both
def test_bumps_and_wheel_drops(model):
    robot = robot_in(FULL, model)
    for bumped, dropped, bits in (True, False, 3), (False, True, 8), (True, True, 11), (False, False, 0):
        robot.body.bumped, robot.body.wheel_dropped = bumped, dropped
        robot.run(0.02)
        assert robot.read(7) == {'bumps_and_wheel_drops': bits}


@both
def test_the_battery_in_numbers(model):
    robot = robot_in(FULL, model)
    robot.send(drive_direct(100, 0))
    assert robot.read(23) == {'current': -1000}
    robot.body.charge = 1500
    robot.run(0.02)
    assert robot.read(22) == {'voltage': 14750}     # halfway between 13 V and 16.5 V
    robot.body.charge = 3000
    robot.run(360)      # a tenth of an hour at 1 A
    assert robot.body.charge == pytest.approx(2900, abs=0.1)
    robot.send(command('start'))
    robot.body.docked = True
    robot.run(36)       # a hundredth of an hour at 1.5 A
    assert robot.body.charge == pytest.approx(2915, abs=0.1)
    assert robot.read(23) == {'current': 1500} and robot.read(21) == {'charging_state': 2}
    robot.body.charge = 3000
    robot.run(1)
    assert robot.read(23) == {'current': 0} and robot.read(21) == {'charging_state': 3}
    assert robot.read(22) == {'voltage': 16500} and robot.read(25) == {'charge': 3000}
    robot.body.docked = False
    robot.run(1)
    assert robot.read(21) == {'charging_state': 0} and robot.read(34) == {'charging_sources': 0}


@pytest.mark.parametrize('tally, values', [(Tally, [0, 1, 0, 1]), (DroppingTally, [0, 0, 0, 1])])
def test_tallies(tally, values):
    counter, read = tally(), []
    for step in (0.3, 0.3, 0.3, 1.0):
        counter.total += step
        assert counter.pending == (value := counter.take()) and counter.pending == 0
        read.append(value)
    assert read == values


@pytest.mark.parametrize('tally', [Tally, DroppingTally])
@pytest.mark.parametrize('total, value', [(40000, 32767), (-40000, -32768), (32767, 32767), (-32768, -32768)])
def test_a_tally_has_16_bits(tally, total, value):
    counter = tally()
    counter.total = total
    assert counter.take() == value and counter.take() == 0


def test_the_encoders_count_turns_of_the_wheels():
    robot = robot_in(FULL, CREATE_2)
    robot.send(drive_direct(int(-72 * pi), 0))     # one turn of the wheel per second, rounded: 226 of 226.2 mm
    robot.run(9.95)
    robot.send(drive_direct(0, 0))
    counts = robot.read(44)['right_encoder']
    # 508.8 counts per turn; within 15 ms of 10 s
    assert 65536 - counts == pytest.approx(10 * 508.8 * 226 / (72 * pi), abs=10)
    assert robot.read(43) == {'left_encoder': 0}
