#!/usr/bin/env python3
"""Simulates the exercise many times without ROS and prints the end poses: timed, with odometry, with odometry and gyro.

It uses the same motions, base and filter as the nodes.
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import argparse
import ast
from concurrent.futures.process import BrokenProcessPool
import os
import signal
import sys

from tqdm import tqdm

from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import KEYS, known_surfaces, load_surface
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.animation import animate, check_animation
from rbx1_nav.extras.many_runs.cases import Combination, combine, read_sweep, units
from rbx1_nav.extras.many_runs.executor import add_arguments
from rbx1_nav.extras.many_runs.plots import PATHS, check_picture, draw
from rbx1_nav.extras.many_runs.runs_file import RunsFile
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS
from rbx1_nav.extras.many_runs.sweep import Sweep
from rbx1_nav.node import resources
from rbx1_nav.node.config import ConfigError, show, show_name
from rbx1_nav.node.files import check_writable
from rbx1_nav.node.parameters import split_usage
from rbx1_nav.simulation.slip import MAX_SEED


def read_arguments() -> argparse.Namespace:
    """Return the checked command-line arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--surface', action='append', metavar='NAME',
                        help=f"one of {', '.join(known_surfaces(resources.surfaces()))}, or a YAML file; default: "
                             'ideal. Can be given more than once')
    parser.add_argument('--method', choices=METHODS, action='append',
                        help='; '.join(f'{each.name}: {each.text}' for each in METHODS.values())
                        + '. Can be given more than once; default: all')
    parser.add_argument('--set', action='append', default=[], metavar='KEY=VALUE,...',
                        help=f"values of {', '.join([*PARAMETERS, *KEYS])}. Can be given more than once: all "
                             'combinations are simulated')
    parser.add_argument('--runs', type=int, default=100, metavar='N', help='number of runs per method; default: 100')
    parser.add_argument('--seed', type=int, default=0, metavar='S',
                        help='seed of the first run; the next runs use S+1, S+2, ...; default: 0')
    parser.add_argument('--config', default=resources.path('config', 'turtlebot.yaml'), metavar='FILE',
                        help="ArbotiX YAML file of the base; its rate is ignored; default: the TurtleBot's")
    parser.add_argument('--output', metavar='FILE',
                        help='write a row for each run (CSV); the same command continues an interrupted file')
    parser.add_argument('--plot', metavar='FILE', help='draw the paths and the end poses, side by side (PNG, PDF, SVG)')
    parser.add_argument('--animate', metavar='FILE',
                        help='draw the first run of each method as an animated picture, side by side (GIF, PNG)')
    add_arguments(parser)
    arguments = parser.parse_args()
    for name, low, high in (('runs', 1, 10 ** 6), ('jobs', 1, 10 ** 6), ('seed', 0, MAX_SEED + 1 - arguments.runs)):
        value = getattr(arguments, name)
        if not low <= value <= high:
            parser.error(f'--{name}: {show(value)}: expected an integer from {low} to {high}')
    # the name of a surface has no extension
    arguments.surface = [os.path.abspath(name) if os.path.splitext(name)[1] else name
                         for name in dict.fromkeys(arguments.surface or ['ideal'])]
    for name, check in (('plot', check_picture), ('animate', check_animation)):
        path = getattr(arguments, name)
        try:
            if path is not None:
                check(path)
        except ConfigError as error:
            parser.error(f'--{name}: {show_name(path)}: {error}')
    arguments.method = list(dict.fromkeys(arguments.method or METHODS))
    return arguments


def read_combinations(arguments: argparse.Namespace) -> tuple[list[Combination], list[str]]:
    """Return (Combinations of the sweep, titles of its columns). Raises ConfigError."""
    script = os.path.join(os.path.dirname(os.path.realpath(__file__)), 'odom_out_and_back.py')
    with open(script, encoding='utf-8') as file:
        _, declared = split_usage(ast.get_docstring(ast.parse(file.read())) or '')
    values = read_sweep(arguments.set, declared)
    surfaces = {name: load_surface(name, resources.surfaces()) for name in arguments.surface}
    combinations = combine(surfaces, values)
    if len(combinations) > 1 and (arguments.plot or arguments.animate):
        raise ConfigError(f"--{'plot' if arguments.plot else 'animate'}: expected one combination, not "
                          f'{len(combinations)}')
    return combinations, units(list(values), declared)


def simulate_all(sweep: Sweep, arguments: argparse.Namespace, file: RunsFile | None) -> None:
    """Simulate, print and draw."""
    print(sweep.title(), flush=True)
    results, truths, paths = {}, {}, PATHS if arguments.plot else int(bool(arguments.animate))
    for each in sweep.run(arguments.jobs, arguments.scheduler, file, bool(arguments.plot), paths):
        with tqdm.external_write_mode():        # above the progress bar
            if len(sweep.combinations) > 1 and each.method == sweep.methods[0]:
                print(f'{each.combination.title()}:')
            print('\n'.join(each.summary.lines(each.method)), flush=True)
        results[each.method], truths[each.method] = each.paths, each.truths
    title = sweep.combinations[0].title()
    if arguments.plot:
        draw(arguments.plot, title, results, sweep.seeds, truths)
        print(f'Picture: {arguments.plot}')
    if arguments.animate:
        animate(arguments.animate, f'{title}, seed {arguments.seed}',
                {method: each[0] for method, each in results.items()})
        print(f'Animation: {arguments.animate}')


def main() -> int:
    """Simulate, print and draw; return the exit status."""
    sweep: Sweep | None = None
    file: RunsFile | None = None

    def missing() -> str:
        if not (sweep and file):
            return ''
        return f'{arguments.output} lacks {sweep.total - sweep.done} of {sweep.total} runs'

    def interrupt(*_: object) -> None:      # immediately; the other processes follow
        if file:
            os.write(sys.stderr.fileno(), f'simulate.py: interrupted: {missing()}\n'.encode())
        os._exit(130)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)
    try:
        arguments = read_arguments()
        combinations, titles = read_combinations(arguments)
        robot = load_robot(arguments.config)
        if robot.unknown:
            print(f"simulate.py: ignoring unknown parameters: {', '.join(robot.unknown)}", file=sys.stderr)
        sweep = Sweep(combinations, arguments.method, robot, range(arguments.seed, arguments.seed + arguments.runs))
        file = sweep.open_file(arguments.output, titles) if arguments.output is not None else None
        simulate_all(sweep, arguments, file)
    except (OSError, ValueError, RuntimeError, ImportError) as error:   # also a robot that is stuck, and a worker's
        text = ' '.join(str(error).split())
        if isinstance(error, BrokenProcessPool):
            text = ('a process was killed, perhaps because memory ran out: '
                    f'expected all of --jobs {arguments.jobs} to run')
        # the device of the output may be full, and Python would try to write to it again at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        print('; '.join(filter(None, [f'simulate.py: {text}', missing()])), file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
