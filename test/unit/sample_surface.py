"""A surface for tests, between carpet and a hard floor, and the random errors of one run on it."""
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.simulation.slip import RandomErrors

SURFACE = Surface('test', lag=0.1, accel_limit=1.0, drag_straight=0.01, drag_turning=0.02,
                  slip_straight=0.02, slip_straight_spread=0.01, slip_turning=0.03, slip_turning_spread=0.01,
                  ticks_meter=4100, gyro_noise=0.002, gyro_bias=0.01, gyro_scale_error=0.003,
                  gyro_measurement_range=2.6)
RUN = RandomErrors(slip_straight=0.02, slip_turning=0.03, gyro_bias=0.0, gyro_scale_error=0.0)
