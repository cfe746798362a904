#!/usr/bin/env python3
"""Simulates the exercise many times without ROS, and prints where it ends: by time, by odometry, by odometry and gyro.

The motions, the base and the filter are those of the nodes.
"""
import rbx1_nav.ros.node.early_interrupt     # Ctrl-C ends it quietly even while the rest is loaded

import argparse
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from functools import partial
from math import atan2, cos, degrees, hypot, sin
import os
import signal
import sys
import time

import numpy
from tqdm import tqdm

from rbx1_nav.config import ConfigError, load_yaml, show, show_name
from rbx1_nav.plotting.runs import PATHS, check_picture, draw
from rbx1_nav.robot.description import read_robot
from rbx1_nav.ros.node import resources
from rbx1_nav.simulation.exercise import METHODS, simulate_many
from rbx1_nav.simulation.surfaces import MAX_SEED, known_surfaces, load_surface
from rbx1_nav.units import rounded, wrap_angle

MOMENT = 1.0    # s: what takes longer gets a progress bar and all processor cores


def read_arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--surface', default='ideal', metavar='NAME',
                        help=f"one of {', '.join(known_surfaces(resources.surfaces()))}, or a YAML file; default: "
                             "ideal")
    parser.add_argument('--method', choices=METHODS, action='append',
                        help='timed: by time alone; odom: by odometry; ekf: by odometry and gyro. Can be given more '
                             'than once; default: all three')
    parser.add_argument('--runs', type=int, default=100, metavar='N', help='runs of each method; default: 100')
    parser.add_argument('--seed', type=int, default=0, metavar='S',
                        help='the runs are drawn from S, S+1, ...; default: 0')
    parser.add_argument('--config', default=resources.path('config', 'turtlebot.yaml'), metavar='FILE',
                        help="ArbotiX YAML file of the base, whose rate is not used; default: the TurtleBot's")
    parser.add_argument('--plot', metavar='FILE', help='draw the ways and the end poses, side by side (PNG, PDF, SVG)')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), metavar='N',
                        help='processes; default: as many as there are processor cores')
    arguments = parser.parse_args()
    for name, low, high in (('runs', 1, 10 ** 6), ('jobs', 1, 10 ** 6), ('seed', 0, MAX_SEED + 1 - arguments.runs)):
        value = getattr(arguments, name)
        if not low <= value <= high:
            parser.error(f'--{name}: {show(value)}: expected an integer from {low} to {high}')
    if os.path.splitext(arguments.surface)[1]:      # a name has none
        arguments.surface = os.path.abspath(arguments.surface)
    if arguments.plot is not None:
        try:
            check_picture(arguments.plot)
        except ConfigError as error:
            parser.error(f'--plot: {show_name(arguments.plot)}: {error}')
    arguments.method = list(dict.fromkeys(arguments.method or METHODS))
    return arguments


def run_all(method, robot, surface, seeds, arguments):
    """The Results of a method, and the wall time they took in s."""
    start = time.monotonic()
    many = partial(simulate_many, method, robot, surface)
    keep = PATHS if arguments.plot else 0
    results = list(many(seeds[:1], keep))
    long = (time.monotonic() - start) * len(seeds) > MOMENT
    with closing(many(seeds[1:], keep - 1, arguments.jobs if long else 1)) as rest:
        results += tqdm(rest, total=len(seeds), initial=1, desc=method, unit='run', disable=None if long else True)
    return results, time.monotonic() - start


def spread(values):
    """Mean and standard deviation, as text."""
    return f'{rounded(numpy.mean(values), 3):8.3f} +- {numpy.std(values):5.3f}'


def spread_of_angles(angles):
    """The same for angles in rad, in degrees: their mean is that of their directions."""
    mean = atan2(sum(map(sin, angles)), sum(map(cos, angles)))
    around = [degrees(wrap_angle(angle - mean)) for angle in angles]
    return f'{rounded(degrees(mean) + numpy.mean(around), 2):8.2f} +- {numpy.std(around):5.2f}'


def report(method, results):
    """Print where the robot is at the end, and where odometry and estimate put it."""
    rows = [('truth', [r.end.truth for r in results]), ('/odom', [r.end.odometry for r in results])]
    if results[0].end.estimate:
        rows.append(('/odom_ekf', [r.end.estimate for r in results]))
    for name, poses in rows:
        x, y, yaw = zip(*poses)
        print(f'{method:6} {name:14}  {spread(x)}  {spread(y)}  {spread_of_angles(yaw)}  '
              f'{spread([hypot(*pose[:2]) for pose in poses])}')
        method = ''
    legs = [r.first_leg for r in results]
    print(f"{'':6} first leg {numpy.mean(legs):.3f} m ({min(legs):.3f} to {max(legs):.3f})")


def load_robot(path):
    """The Robot of an ArbotiX YAML file. Raises ConfigError."""
    try:
        return read_robot(load_yaml(path))
    except ConfigError as error:
        raise ConfigError(f'{show_name(path)}: {error}')


def main():
    """Simulate, print, draw. Returns the exit status."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)               # the reader of a pipe may have seen enough
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(130))         # at once; the other processes follow
    try:
        arguments = read_arguments()
        surface = load_surface(arguments.surface, resources.surfaces())
        seeds = range(arguments.seed, arguments.seed + arguments.runs)
        robot = load_robot(arguments.config)
        print(f'Runs of each method on {arguments.surface}: {arguments.runs}. Mean and spread (1 sigma) at the end:\n'
              f"{'method':6} {'':14}  {'x (m)':>17}  {'y (m)':>17}  {'heading (degrees)':>17}  {'from start (m)':>17}")
        results = {}
        for method in arguments.method:
            results[method], took = run_all(method, robot, surface, seeds, arguments)
            report(method, results[method])
            simulated = sum(r.end.time for r in results[method])
            print(f"{'':6} {simulated:.0f} s of the robot in {took:.2f} s, {simulated / took:.0f} times real time")
        if arguments.plot:
            draw(arguments.plot, arguments.surface, results, seeds)
            print(f'Picture: {arguments.plot}')
    except (OSError, ValueError) as error:     # or a robot that is stuck
        # the output may be what is full: at the end, Python would try it again
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        print(f"simulate.py: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    except BrokenProcessPool:
        print('simulate.py: a process was killed, perhaps because memory ran out: '
              f'expected all of --jobs {arguments.jobs} to run', file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
