#!/usr/bin/env python3
"""Measure the three methods on a surface, and the filter, offline: ends, errors, consistency, speed. See README.md."""
import argparse
import json
import math
import time

import numpy
import yaml

from rbx1_nav.ros import resources
from rbx1_nav.model.robot import read_robot
from rbx1_nav.simulation import METHODS, simulate, simulate_many
from rbx1_nav.model.surfaces import load_surface


def distance(pose, other=(0.0, 0.0)):
    """Between two poses, m."""
    return math.hypot(pose[0] - other[0], pose[1] - other[1])


def turned(pose, other=(0.0, 0.0, 0.0)):
    """Between two headings, degrees, the short way round."""
    return abs(math.degrees(math.remainder(pose[2] - other[2], 2 * math.pi)))


def ends(config, surface, seeds):
    """Where the robot is at the end by each method, and what the odometry says there."""
    for method in METHODS:
        runs = list(simulate_many(method, config, surface, seeds))
        yield method + ': true end, from the start (m)', [distance(r.end.truth) for r in runs]
        yield method + ': true end, to the left (m)', [r.end.truth.y for r in runs]
        yield method + ': true end, angle (degrees)', [turned(r.end.truth) for r in runs]
        yield method + ': true first leg (m)', [r.first_leg for r in runs]
        yield method + ': /odom off the truth (m)', [distance(r.end.truth, r.end.odometry) for r in runs]
        yield method + ': /odom off the truth (degrees)', [turned(r.end.truth, r.end.odometry) for r in runs]


def errors(method, config, surface, seeds):
    """Root mean square errors over all ticks of all runs, and the consistency at their ends."""
    squares, number, consistency = numpy.zeros(4), 0, []
    for seed in seeds:
        run = simulate(method, config, surface, seed, filtered=True, keep=True)
        for _, truth, odometry, estimate in run.path:
            squares += [turned(truth, odometry) ** 2, turned(truth, estimate) ** 2,
                        distance(truth, odometry) ** 2, distance(truth, estimate) ** 2]
        number += len(run.path)
        error = numpy.subtract(run.end.estimate, run.end.truth)
        error[2] = math.remainder(error[2], 2 * math.pi)
        consistency.append(error @ numpy.linalg.solve(run.covariance, error))
    return {**dict(zip(('/odom heading RMSE (degrees)', '/odom_ekf heading RMSE (degrees)',
                        '/odom position RMSE (m)', '/odom_ekf position RMSE (m)'), (squares / number) ** 0.5)),
            'mean normalised estimation error squared': numpy.mean(consistency)}


def speed(method, config, surface, seeds):
    """Simulated time over wall time of each run, on one core."""
    for seed in seeds:
        start = time.perf_counter()
        simulated = simulate(method, config, surface, seed).end.time
        yield simulated / (time.perf_counter() - start)


def main():
    """Measure, print, and write JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--surface', default='low_ply_carpet')
    parser.add_argument('--seeds', type=int, default=20, help='runs of each method; default: 20')
    parser.add_argument('--filter-seeds', type=int, default=200, help="runs for the filter's errors; default: 200")
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    surface = load_surface(arguments.surface, resources.surfaces())
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))

    figures = {}

    def tell(name, **values):
        figures[name] = {key: float(value) for key, value in values.items()}
        print('%-50s %s' % (name, '  '.join('%s %.4g' % pair for pair in values.items())), flush=True)
    for name, values in ends(config, surface, range(arguments.seeds)):
        tell(name, min=min(values), median=numpy.median(values), max=max(values))
    for method in METHODS:
        for name, value in errors(method, config, surface, range(arguments.filter_seeds)).items():
            tell('%s: %s' % (method, name), value=value)
    for method in METHODS:
        values = list(speed(method, config, surface, range(arguments.seeds)))
        tell(method + ': times real time, one core', min=min(values), median=numpy.median(values), max=max(values))
    start = time.perf_counter()
    for _ in simulate_many('timed', config, surface, range(10000)):
        pass
    tell('10,000 timed runs, one core (s)', value=time.perf_counter() - start)
    if arguments.json:
        with open(arguments.json, 'w', encoding='utf-8') as file:
            json.dump(figures, file, indent=1)


if __name__ == '__main__':
    main()
