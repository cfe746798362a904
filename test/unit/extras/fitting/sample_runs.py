"""Recordings of simulated runs, for tests."""
from math import pi

import numpy

from rbx1_nav.base.robot_parameters import read_robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.fitting.recording import Commands, Rates, Recording, Track
from rbx1_nav.simulation.simulated_base import make_base

TICK = SECOND // 50     # ns
ROBOT = read_robot({'controllers': {'base': {'type': 'diff_controller', 'base_width': 0.26}}})
FLOOR = Surface('floor', lag=0.12, accel_limit=0.8, drag_straight=0.008, drag_turning=0.012, slip_straight=0.03,
                slip_straight_spread=0.01, slip_turning=0.05, slip_turning_spread=0.01, ticks_meter=4100,
                gyro_noise=0.003, gyro_bias=0.02, gyro_scale_error=0.02, gyro_measurement_range=2.6, delay=0.15,
                curvature=0.05, turning_loss=0.05, heading_noise_turning=0.05, heading_noise_straight=0.03,
                distance_noise=0.02)
# (m/s, rad/s, ticks)
REST, FORWARD, LEFT, RIGHT = (0.0, 0.0, 100), (0.2, 0.0, 200), (0.0, 1.0, 157), (0.0, -0.7, 157)
ARCS = ((0.3, 0.5, 150), (0.15, -0.6, 200))
EXERCISE = (REST, FORWARD, REST, LEFT, REST, FORWARD, REST, LEFT, REST)
DRIVE = (REST, FORWARD, LEFT, *ARCS, REST, RIGHT, FORWARD, RIGHT, *ARCS, REST)


def record(motions, seed=0, surface=FLOOR, name='run'):
    """Return the Recording of a run, with everything except an end pose measured by hand."""
    base = make_base(ROBOT, surface, seed)
    base.read_gyro()
    now, commands, odometry, truth, gyro = 0, [], [(0.0, 0, 0, 0)], [(0.0, 0, 0, 0)], []
    for linear, angular, ticks in motions:
        for _ in range(ticks):
            base.command(now, linear, angular)
            commands.append((now / SECOND, linear, angular))
            now += TICK
            base.advance(now)
            odometry.append((now / SECOND, *base.odometry.pose))
            truth.append((now / SECOND, *base.wheels.truth.pose))
            gyro.append((now / SECOND, base.read_gyro().rate))
    return Recording(name, Commands(*numpy.transpose(commands)), Track(*numpy.transpose(odometry)),
                     Rates(*numpy.transpose(gyro)), Track(*numpy.transpose(truth)), None)


def wrapped(yaw):
    """Return the equivalent angle between -pi and pi, rad."""
    return (yaw + pi) % (2 * pi) - pi
