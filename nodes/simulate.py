#!/usr/bin/env python3
"""Simulates the exercise many times without ROS and prints the end poses: timed, with odometry, with odometry and gyro.

It uses the same motions, base and filter as the nodes.
"""
import rbx1_nav.ros.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import argparse
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing
from functools import partial
import os
import signal
import sys
import time

from tqdm import tqdm

from rbx1_nav.config import ConfigError, show, show_name
from rbx1_nav.plotting.animation import animate, check_animation
from rbx1_nav.plotting.runs import PATHS, check_picture, draw
from rbx1_nav.robot.description import load_robot
from rbx1_nav.ros.node import resources
from rbx1_nav.simulation.exercise import METHODS, simulate_many
from rbx1_nav.simulation.summary import HEADER, summary
from rbx1_nav.simulation.surfaces import MAX_SEED, known_surfaces, load_surface

MOMENT = 1.0    # s: longer simulations get a progress bar and all processor cores


def read_arguments():
    """Return the checked command-line arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--surface', default='ideal', metavar='NAME',
                        help=f"one of {', '.join(known_surfaces(resources.surfaces()))}, or a YAML file; default: "
                             "ideal")
    parser.add_argument('--method', choices=METHODS, action='append',
                        help='timed: fixed durations, no feedback; odom: stops at the odometry goal; ekf: stops at the '
                             'estimated goal. Can be given more than once; default: all three')
    parser.add_argument('--runs', type=int, default=100, metavar='N', help='number of runs per method; default: 100')
    parser.add_argument('--seed', type=int, default=0, metavar='S',
                        help='seed of the first run; the next runs use S+1, S+2, ...; default: 0')
    parser.add_argument('--config', default=resources.path('config', 'turtlebot.yaml'), metavar='FILE',
                        help="ArbotiX YAML file of the base; its rate is ignored; default: the TurtleBot's")
    parser.add_argument('--plot', metavar='FILE', help='draw the paths and the end poses, side by side (PNG, PDF, SVG)')
    parser.add_argument('--animate', metavar='FILE',
                        help='draw the first run of each method as an animated picture, side by side (GIF, PNG)')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), metavar='N',
                        help='number of processes; default: the number of processor cores')
    arguments = parser.parse_args()
    for name, low, high in (('runs', 1, 10 ** 6), ('jobs', 1, 10 ** 6), ('seed', 0, MAX_SEED + 1 - arguments.runs)):
        value = getattr(arguments, name)
        if not low <= value <= high:
            parser.error(f'--{name}: {show(value)}: expected an integer from {low} to {high}')
    if os.path.splitext(arguments.surface)[1]:      # the name of a surface has no extension
        arguments.surface = os.path.abspath(arguments.surface)
    for name, check in (('plot', check_picture), ('animate', check_animation)):
        path = getattr(arguments, name)
        try:
            if path is not None:
                check(path)
        except ConfigError as error:
            parser.error(f'--{name}: {show_name(path)}: {error}')
    arguments.method = list(dict.fromkeys(arguments.method or METHODS))
    return arguments


def run_all(method, robot, surface, seeds, arguments):
    """Return the Results of a method, and the wall time that they took (s)."""
    start = time.monotonic()
    many = partial(simulate_many, method, robot, surface)
    keep = PATHS if arguments.plot else int(bool(arguments.animate))
    results = list(many(seeds[:1], keep))
    long = (time.monotonic() - start) * len(seeds) > MOMENT
    with closing(many(seeds[1:], keep - 1, arguments.jobs if long else 1)) as rest:
        results += tqdm(rest, total=len(seeds), initial=1, desc=method, unit='run', disable=None if long else True)
    return results, time.monotonic() - start


def main():
    """Simulate, print and draw; return the exit status."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)               # the reader of a pipe may stop reading early
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(130))         # immediately; the other processes follow
    try:
        arguments = read_arguments()
        surface = load_surface(arguments.surface, resources.surfaces())
        seeds = range(arguments.seed, arguments.seed + arguments.runs)
        robot = load_robot(arguments.config)
        runs, of = (('1 run', f'seed {seeds[0]}') if len(seeds) == 1
                    else (f'{len(seeds)} runs', f'seeds {seeds[0]} to {seeds[-1]}'))
        print(f'{runs} of each method on {arguments.surface}, {of}. Mean and standard deviation of the end poses:\n'
              f'{HEADER}')
        results = {}
        for method in arguments.method:
            results[method], took = run_all(method, robot, surface, seeds, arguments)
            print('\n'.join(summary(method, results[method])))
            simulated = sum(r.end.time for r in results[method])
            print(f"{'':6} {simulated:.0f} s simulated in {took:.2f} s, {simulated / took:.0f} times real time")
        if arguments.plot:
            draw(arguments.plot, arguments.surface, results, seeds)
            print(f'Picture: {arguments.plot}')
        if arguments.animate:
            animate(arguments.animate, f'{arguments.surface}, seed {seeds[0]}',
                    {method: each[0] for method, each in results.items()})
            print(f'Animation: {arguments.animate}')
    except (OSError, ValueError) as error:     # or a robot that is stuck
        # the device of the output may be full, and Python would try to write to it again at exit
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
