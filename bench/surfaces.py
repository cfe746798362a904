#!/usr/bin/env python3
"""Simulate the three methods and the filter on a surface: end poses, errors, consistency, speed. See README.md."""
import argparse
import math
import time

import numpy

from floors import Follower, consistency, squared_errors
import simulated
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import simulate

ORIGIN = 0.0, 0.0, 0.0
TIMED_SEEDS = 20    # runs of each method whose speed is measured


def ends(method, robot, surface, seeds):
    """{name: values} for the end poses: the true end pose, and the odometry error."""
    runs = [simulate(method, robot, surface, seed) for seed in seeds]
    values = {}
    for name, pairs in (('true end', [(run.end.truth, ORIGIN) for run in runs]),
                        ('error of /odom at the end', [(run.end.odometry, run.end.truth) for run in runs])):
        headings, positions = numpy.sqrt([squared_errors(*pair) for pair in pairs]).T
        values[f'{name} (m)'], values[f'{name} (degrees)'] = positions, headings
    return {**values, 'true first leg (m)': [run.first_leg for run in runs]}


def errors(method, robot, surface, seeds):
    """Root mean square errors over all ticks of all runs, and the final consistency of the filter."""
    followers = {'/odom': Follower(), '/odom_ekf': Follower()}
    nees = []
    for seed in seeds:
        run = simulate(method, robot, surface, seed, filtered=True, keep=True)
        for _, truth, *poses in run.path:
            for follower, pose in zip(followers.values(), poses):
                follower.compare(pose, truth)
        nees.append(consistency(run.end.estimate, run.end.truth, run.covariance))
    values = {}
    for topic, follower in followers.items():
        values[f'heading RMSE of {topic} (degrees)'] = math.sqrt(follower.heading / follower.ticks)
        values[f'position RMSE of {topic} (m)'] = math.sqrt(follower.position / follower.ticks)
    return {**values, 'mean normalized estimation error squared': numpy.mean(nees)}


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
    parser.add_argument('--filter-seeds', type=int, default=200, help="runs for the filter's errors; default: 200")
    arguments = parser.parse_args()
    robot, surface = simulated.robot(), simulated.floor(arguments.surface)
    for method in METHODS:
        spreads = ends(method, robot, surface, range(arguments.seeds))
        spreads['times real time'] = list(speed(method, robot, surface, range(min(arguments.seeds, TIMED_SEEDS))))
        for name, values in spreads.items():
            print(f'{method}: {name:42} minimum {min(values):.4g}  median {numpy.median(values):.4g}  '
                  f'maximum {max(values):.4g}', flush=True)
        for name, value in errors(method, robot, surface, range(arguments.filter_seeds)).items():
            print(f'{method}: {name:42} {value:.4g}', flush=True)


if __name__ == '__main__':
    main()
