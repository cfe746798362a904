#!/usr/bin/env python3
"""Drive randomly on random floors, and compare the filter with its two sensors. See README.md."""
import argparse
import math
import random

import numpy

from base_cases import Case
import bases
from floors import squared_errors
from replay import reckon
import simulated

SLIP, UNEQUAL, BIAS = 0.3, 0.05, 6.0    # largest slips; difference of the wheels; bias of the gyro, degrees/s
SIGMAS = 5.0            # an error of more standard deviations than this must have been announced
MARGIN = 2.0            # degrees: smaller differences from the sensors do not count


def make_floor(floor, seed, width):
    """(Surface, bias in degrees/s): a random floor with a fraction of the noise of another floor. width: m."""
    rng = random.Random(f'floor {seed}')
    noise = rng.random()
    return floor._replace(
        slip_straight=rng.uniform(-SLIP, SLIP), slip_turning=rng.uniform(-SLIP, SLIP),
        curvature=rng.uniform(-UNEQUAL, UNEQUAL) / width,
        **{key: noise * getattr(floor, key) for key in ('heading_noise_turning', 'heading_noise_straight',
                                                        'distance_noise')}), rng.uniform(-BIAS, BIAS)


def run(task):
    """(seed, rest, warnings, rms heading errors of filter, gyro and wheels (degrees), largest error in sigmas)."""
    robot, floor, bias, seed, duration = task
    rest = 3.0 * (seed % 2)
    case = Case('random', '', bias=bias, rest=rest, path='random')
    record = bases.drive(robot, case, floor, seed, duration)
    warnings = []
    estimates = bases.run_filter(record, warnings.append)
    start = round(rest * case.odom_rate) + 1
    step = round(bases.SAMPLE * case.odom_rate)

    def errors(poses):
        return [squared_errors(*pair)[0] for pair in zip(poses[start::step], record.truth[start::step])]
    squares = errors([estimate.pose for estimate in estimates])
    sigmas = [math.degrees(math.sqrt(estimate.covariance[2][2])) for estimate in estimates[start::step]]
    worst = max(math.sqrt(square) / sigma for square, sigma in zip(squares, sigmas))
    means = [numpy.mean(each) for each in (squares, errors(reckon(record, bases.rest_of(rest))),
                                           errors([odom.pose for odom, _ in record.odom]))]
    return seed, rest, warnings, [math.sqrt(mean) for mean in means], worst


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--floors', type=int, default=50, metavar='N', help='default: 50')
    parser.add_argument('--drives', type=int, default=10, metavar='N', help='on each floor; default: 10')
    parser.add_argument('--duration', type=float, default=120, metavar='S', help='of a drive; default: 120')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    arguments = parser.parse_args()
    robot, lab = simulated.robot(), simulated.floor('create_lab_floor')
    tasks = []
    for number in range(arguments.floors):
        floor, bias = make_floor(lab, number, robot.base_width)
        tasks += [(robot, floor, bias, number * arguments.drives + drive, arguments.duration)
                  for drive in range(arguments.drives)]
    worse = silent = announced = 0
    for seed, rest, warnings, (heading, gyro, wheels), sigmas in simulated.in_processes(arguments.jobs, run, tasks):
        is_worse = heading > 2 * max(gyro, wheels) + MARGIN
        is_silent = sigmas > SIGMAS and not warnings
        worse, silent = worse + is_worse, silent + is_silent
        announced += sigmas > SIGMAS and not is_silent
        if is_worse or is_silent:
            print(f'seed {seed}, rest {rest:g} s: heading {heading:.2f}, gyro {gyro:.2f}, wheels {wheels:.2f} '
                  f'degrees; {sigmas:.1f} sigma; {warnings or "no warning"}')
    print(f'{len(tasks)} drives: {worse} worse than twice the worse sensor; beyond {SIGMAS:g} sigma: {silent} without '
          f'a warning, {announced} with one')


if __name__ == '__main__':
    main()
