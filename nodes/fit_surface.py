#!/usr/bin/env python3
"""Fits a surface to recorded runs of a robot and writes it to a file.

A run is a bag with the velocity commands, the odometry and, if there is one, the gyro. The true poses come from a topic
(--truth), or the end poses were measured by hand (--ends). Runs of the UTIAS dataset are read from its text files:
D6R1_Odometry.dat, with D6R1_Groundtruth.dat in the same folder.

The --ends file has one line per bag: its name without folder, and the end pose relative to the start pose, x ahead:

  run1.bag: [0.02, 0.35, -12]   # x (m), y (m), heading (degrees)
  position_error: 0.01          # standard deviation of a measured position, m (default)
  heading_error: 2              # standard deviation of a measured heading, degrees (default)
"""
from __future__ import annotations

import rbx1_nav.node.early_interrupt     # first, so that Ctrl-C during the other imports exits quietly

import argparse
from itertools import zip_longest
import os
import signal
import sys

# the matrices are small, and on a busy machine, threads that wait for each other take many times as long
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')

from tqdm import tqdm

from rbx1_nav.base.robot_parameters import Robot, load_robot
from rbx1_nav.base.surfaces import Surface, known_surfaces, load_surface
from rbx1_nav.extras.fitting.bags import TopicNames, read_bag
from rbx1_nav.extras.fitting.comparison import compare, shares
from rbx1_nav.extras.fitting.end_poses import read_ends
from rbx1_nav.extras.fitting.recording import (
    Recording, check_end, in_force, is_commands_file, read_robot as read_text_files, truth_file)
from rbx1_nav.extras.many_runs.executor import add_arguments, in_order, open_place
from rbx1_nav.extras.many_runs.plots import check_picture, draw_fit
from rbx1_nav.node import resources
from rbx1_nav.node.config import ConfigError, show_name
from rbx1_nav.node.files import check_yaml, write_file

START, CREATE_START = 'low_ply_carpet', 'create_lab_floor'


def read_arguments() -> argparse.Namespace:
    """Return the checked command-line arguments."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('runs', nargs='+', metavar='RUN', help='a bag, or a text file NAME_Odometry.dat')
    truth = parser.add_mutually_exclusive_group()
    truth.add_argument('--truth', metavar='TOPIC', help='topic with the true pose: nav_msgs/Odometry or '
                                                        'geometry_msgs/PoseStamped')
    truth.add_argument('--ends', metavar='FILE', help='YAML file with the end poses of the runs, measured by hand')
    parser.add_argument('--output', required=True, metavar='FILE', help='the surface file to write')
    parser.add_argument('--plot', metavar='FILE', help='draw recorded and simulated paths (PNG, PDF, SVG)')
    parser.add_argument('--start', metavar='SURFACE',
                        help='surface that provides the values that the runs cannot determine: one of '
                             f"{', '.join(known_surfaces(resources.surfaces()))}, or a YAML file; default: {START}, "
                             f'for text files {CREATE_START}')
    parser.add_argument('--config', default=resources.path('config', 'turtlebot.yaml'), metavar='FILE',
                        help="ArbotiX YAML file with the base's width, limits and timeout; default: the TurtleBot's")
    for name, topic in (('cmd-vel', '/cmd_vel'), ('odom', '/odom'), ('imu', '/imu/data')):
        parser.add_argument(f'--{name}', default=topic, metavar='TOPIC', help=f'default: {topic}')
    add_arguments(parser, 1)
    arguments = parser.parse_args()
    for name, check in (('output', check_yaml), ('plot', check_picture)):
        path = getattr(arguments, name)
        try:
            if path is not None:
                check(path)
        except ConfigError as error:
            parser.error(f'--{name}: {show_name(path)}: {error}')
    if not arguments.cmd_vel:
        parser.error("--cmd-vel: '': expected a topic")
    topics = [each.lstrip('/') for each in (arguments.cmd_vel, arguments.odom, arguments.imu, arguments.truth) if each]
    for topic in topics:
        if topics.count(topic) > 1:
            parser.error(f'/{topic}: given twice: expected different topics for commands, odometry, gyro and truth')
    text_files = [path for path in arguments.runs if is_commands_file(path)]
    # without odometry, the drag values are kept, and the values of a carpet would be far from a Create's
    arguments.start = arguments.start or (CREATE_START if text_files else START)
    if os.path.splitext(arguments.start)[1]:        # the name of a surface has no extension
        arguments.start = os.path.abspath(arguments.start)
    if text_files and (arguments.truth or arguments.ends or len(text_files) < len(arguments.runs)):
        parser.error(f'{show_name(text_files[0])}: a text file comes with its ground truth: expected neither bags nor '
                     '--truth nor --ends')
    return arguments


def read_runs(arguments: argparse.Namespace,
              robot: Robot) -> tuple[list[Recording], tuple[float, float, float] | None]:
    """Return (Recordings, errors of the hand-measured end poses or None). Raises ConfigError."""
    if is_commands_file(arguments.runs[0]):
        return [read_text_files(path, truth_file(path)) for path in arguments.runs], None
    ends, errors = read_ends(arguments.ends, arguments.runs) if arguments.ends else ([], None)
    topics = TopicNames(arguments.cmd_vel, arguments.odom, arguments.imu, arguments.truth)
    recordings = [read_bag(path, topics, end) for path, end in zip_longest(arguments.runs, ends)]
    return [check_end(each._replace(commands=in_force(each.commands, robot))) for each in recordings], errors


def load_files(arguments: argparse.Namespace) -> tuple[Robot, Surface]:
    """Return (Robot, starting Surface). Raises ConfigError."""
    robot = load_robot(arguments.config)
    start = load_surface(arguments.start, resources.surfaces())
    if start is None:
        raise ConfigError(f'--start: {show_name(arguments.start)}: the ideal surface: expected one with values')
    return robot, start


def main() -> int:
    """Read the runs, fit, print and write the result; return the exit status."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(130))
    try:
        arguments = read_arguments()
        robot, start = load_files(arguments)
        with tqdm(disable=None, leave=False, bar_format='{desc}...') as bar:    # shown only in a terminal
            bar.set_description('Reading the runs')
            recordings, end_errors = read_runs(arguments, robot)
            # only now, because they import scipy, which takes longer than the checks
            from rbx1_nav.extras.fitting.surface_file import surface_text, table
            from rbx1_nav.extras.fitting.surface_fit import WholeFit
            result = WholeFit(recordings, robot.base_width, start, end_errors).run(
                lambda part: bar.set_description(f'Fitting the {part}'))
            bar.set_description('Simulating the runs on the new surface')
            with open_place(max(1, arguments.jobs), arguments.scheduler, robot, start) as place:
                comparisons = compare(result.surface, recordings, robot.base_width,
                                      compute=lambda function, parts: in_order(place, function, parts))
        print('\n'.join(table(result, arguments.start)))
        count, inside_50, inside_90 = shares(comparisons)
        if count:
            print(f'Of {count} end poses, {inside_50} lie inside the 50 % region of the simulated ones, and '
                  f'{inside_90} inside the 90 % region')
        text = surface_text(result, os.path.basename(arguments.start), [each.name for each in recordings])
        write_file(arguments.output, text.encode())
        print(f'Surface: {arguments.output}')
        if arguments.plot:
            draw_fit(arguments.plot, f'Fitted: {result.description}', comparisons)
            print(f'Picture: {arguments.plot}')
    except (OSError, ValueError, RuntimeError, ImportError) as error:
        # the device of the output may be full, and Python would try to write to it again at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        print(f"fit_surface.py: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
