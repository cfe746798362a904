"""On a surface without the optional keys, the path is the same as before these keys were introduced."""
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.base.kinematics import Odometry
from rbx1_nav.base.surfaces import read_surface
from rbx1_nav.simulation.floor import draw_run
from rbx1_nav.simulation.motors import Motor
from rbx1_nav.simulation.simulated_base import make_wheels_and_gyro

ALL = dict(lag=0.1, accel_limit=1.0, ticks_meter=4100, gyro_noise=0.1, gyro_bias=0.5, gyro_scale_error=0.003,
           gyro_measurement_range=150)
SURFACES = {
    'carpet': read_surface(dict(ALL, drag_straight=0.0115, drag_turning=0.0185, slip_straight=0.02, slip_turning=0.03,
                                slip_straight_spread=0.01, slip_turning_spread=0.01), 'carpet'),
    'floor': read_surface(dict(ALL, drag_straight=0.002, drag_turning=0.003, slip_straight=0.002, slip_turning=0.005,
                               slip_straight_spread=0.001, slip_turning_spread=0.002), 'floor')}
WIDTH = 0.26        # m


@given(st.sampled_from(sorted(SURFACES)), st.integers(0, 10 ** 6),
       st.lists(st.tuples(st.floats(-1, 1), st.floats(-3, 3), st.floats(0, 1)), max_size=20))
def test_the_path_is_that_of_motors_and_slip_to_the_last_bit(surface, seed, commands):
    surface = SURFACES[surface]
    run = draw_run(surface, seed)
    wheels, _ = make_wheels_and_gyro(WIDTH, surface, seed, 0.02)
    straight = Motor(surface.lag, surface.accel_limit, surface.drag_straight)
    turning = Motor(surface.lag, surface.accel_limit, surface.drag_turning)
    truth = Odometry(WIDTH)
    for linear, angular, duration in commands:
        wheels.travel(linear, angular, duration)
        truth.move(straight.travel(linear, duration) * (1 - run.slip_straight),
                   2 * turning.travel(angular * WIDTH / 2, duration) / WIDTH * (1 - run.slip_turning))
        assert wheels.truth.pose == truth.pose
        assert wheels.true_velocity() == (straight.speed * (1 - run.slip_straight),
                                          2 * turning.speed / WIDTH * (1 - run.slip_turning))
