#!/usr/bin/env python3
"""Simulate the three methods on a surface: end poses, errors of the odometry, speed. See README.md."""
import argparse
import math
import time

import numpy

from floors import Follower, squared_errors
import simulated
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import simulate

ORIGIN = 0.0, 0.0, 0.0
TIMED_SEEDS = 20    # runs of each method whose speed is measured


def ends(runs):
    """{name: values} for the end poses of runs: the true end pose, and the odometry error."""
    values = {}
    for name, pairs in (('true end', [(run.end.truth, ORIGIN) for run in runs]),
                        ('error of /odom at the end', [(run.end.odometry, run.end.truth) for run in runs])):
        headings, positions = numpy.sqrt([squared_errors(*pair) for pair in pairs]).T
        values[f'{name} (m)'], values[f'{name} (degrees)'] = positions, headings
    return {**values, 'true first leg (m)': [run.first_leg for run in runs]}


def odometry_errors(method, robot, surface, seeds):
    """Root mean square errors of the odometry (degrees, m) over all ticks of all runs."""
    follower = Follower()
    for seed in seeds:
        for snapshot in simulate(method, robot, surface, seed, keep=True).path:
            follower.compare(snapshot.odometry, snapshot.truth)
    return math.sqrt(follower.heading / follower.ticks), math.sqrt(follower.position / follower.ticks)


def speed(method, robot, surface, seeds):
    """Simulated time divided by wall time for each run, on one core."""
    for seed in seeds:
        start = time.perf_counter()
        simulated_time = simulate(method, robot, surface, seed).end.time
        yield simulated_time / (time.perf_counter() - start)


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--surface', default='low_ply_carpet')
    parser.add_argument('--seeds', type=int, default=100, help='runs of each method; default: 100')
    parser.add_argument('--odom-seeds', type=int, default=200, help='runs for the errors of /odom; default: 200')
    arguments = parser.parse_args()
    robot, surface = simulated.robot(), simulated.floor(arguments.surface)
    for method in METHODS:
        spreads = ends([simulate(method, robot, surface, seed) for seed in range(arguments.seeds)])
        spreads['times real time'] = list(speed(method, robot, surface, range(min(arguments.seeds, TIMED_SEEDS))))
        for name, values in spreads.items():
            print(f'{method}: {name:35} minimum {min(values):.4g}  median {numpy.median(values):.4g}  '
                  f'maximum {max(values):.4g}', flush=True)
        print('%s: RMSE of /odom: %.4g degrees, %.4g m' % (
            method, *odometry_errors(method, robot, surface, range(arguments.odom_seeds))), flush=True)


if __name__ == '__main__':
    main()
