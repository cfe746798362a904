#!/usr/bin/env python3
"""Simulate the three methods and the filter on a surface: end poses, errors, consistency, speed. See README.md."""
import argparse
import json
import math
import time

import numpy
import yaml

from floors import Follower, consistency
from rbx1_nav.base.description import read_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import simulate
from rbx1_nav.node import resources

TIMED_SEEDS = 20    # runs of each method whose speed is measured


def distance(pose, other=(0.0, 0.0)):
    """The distance between two poses, m."""
    return math.hypot(pose[0] - other[0], pose[1] - other[1])


def turned(pose, other=(0.0, 0.0, 0.0)):
    """The angle between two headings, 0 to 180 degrees."""
    return abs(math.degrees(math.remainder(pose[2] - other[2], 2 * math.pi)))


def ends(robot, surface, seeds):
    """(name, values) for the end poses of each method: the true end pose, and the odometry error."""
    for method in METHODS:
        runs = [simulate(method, robot, surface, seed) for seed in seeds]
        yield f'{method}: true end, from the start (m)', [distance(r.end.truth) for r in runs]
        yield f'{method}: true end, to the left (m)', [r.end.truth.y for r in runs]
        yield f'{method}: true end, angle (degrees)', [turned(r.end.truth) for r in runs]
        yield f'{method}: true first leg (m)', [r.first_leg for r in runs]
        yield f'{method}: error of /odom at the end (m)', [distance(r.end.truth, r.end.odometry) for r in runs]
        yield f'{method}: error of /odom at the end (degrees)', [turned(r.end.truth, r.end.odometry) for r in runs]


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
    for title, field in ('heading RMSE (degrees)', 'heading'), ('position RMSE (m)', 'position'):
        for topic, follower in followers.items():
            values[f'{topic} {title}'] = math.sqrt(getattr(follower, field) / follower.ticks)
    return {**values, 'mean normalized estimation error squared': numpy.mean(nees)}


def speed(method, robot, surface, seeds):
    """Simulated time divided by wall time for each run, on one core."""
    for seed in seeds:
        start = time.perf_counter()
        simulated = simulate(method, robot, surface, seed).end.time
        yield simulated / (time.perf_counter() - start)


def main():
    """Measure, print, and write JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--surface', default='low_ply_carpet')
    parser.add_argument('--seeds', type=int, default=100, help='runs of each method; default: 100')
    parser.add_argument('--filter-seeds', type=int, default=200, help="runs for the filter's errors; default: 200")
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    surface = load_surface(arguments.surface, resources.surfaces())
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))

    figures = {}

    def report(name, **values):
        figures[name] = {key: float(value) for key, value in values.items()}
        print('%-50s %s' % (name, '  '.join('%s %.4g' % pair for pair in values.items())), flush=True)
    for name, values in ends(robot, surface, range(arguments.seeds)):
        report(name, min=min(values), median=numpy.median(values), max=max(values))
    for method in METHODS:
        for name, value in errors(method, robot, surface, range(arguments.filter_seeds)).items():
            report(f'{method}: {name}', value=value)
    for method in METHODS:
        values = list(speed(method, robot, surface, range(min(arguments.seeds, TIMED_SEEDS))))
        report(f'{method}: times real time, one core', min=min(values), median=numpy.median(values), max=max(values))
    start = time.perf_counter()
    for seed in range(10000):
        simulate('timed', robot, surface, seed)
    report('10,000 timed runs, one core (s)', value=time.perf_counter() - start)
    if arguments.json:
        with open(arguments.json, 'w', encoding='utf-8') as file:
            json.dump(figures, file, indent=1)


if __name__ == '__main__':
    main()
