#!/usr/bin/env python3
"""Runs the exercise many times without ROS, and says where it ended: by time, by odometry, by odometry and gyro.

The same maneuver, base and filter as in the nodes; only nobody waits for a clock.
"""
import argparse
from functools import partial
from math import atan2, cos, degrees, hypot, pi, remainder, sin
import os
import signal
import sys
import time

from matplotlib.figure import Figure
import numpy
from tqdm import tqdm
import yaml

from rbx1_nav import resources
from rbx1_nav.config import ConfigError, read_config
from rbx1_nav.simulation import METHODS, simulate_many
from rbx1_nav.surface import known_surfaces, load_surface, read_seed

MOMENT = 1.0    # s: what takes longer gets a progress bar, and all processor cores
PATHS = 20      # trajectories in a picture; more would hide each other
TITLES = {'timed': 'by time', 'odom': 'by odometry', 'ekf': 'by odometry and gyro'}


def read_arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('--surface', default='ideal', metavar='NAME',
                        help='one of %s, or a YAML file; default: ideal' % ', '.join(known_surfaces(resources.surfaces())))
    parser.add_argument('--method', choices=METHODS, action='append',
                        help='timed: by time alone; odom: by odometry; ekf: by odometry and gyro. Can be given more '
                             'than once; default: all three')
    parser.add_argument('--runs', type=int, default=100, metavar='N', help='runs of each method; default: 100')
    parser.add_argument('--seed', type=int, default=0, metavar='S',
                        help='the runs are drawn from S, S+1, ...; default: 0')
    parser.add_argument('--config', default=resources.path('config', 'turtlebot.yaml'), metavar='FILE',
                        help="ArbotiX YAML file of the base, its rate apart: a tick is 1/50 s; default: the TurtleBot's")
    parser.add_argument('--plot', metavar='FILE', help='draw the ways and the end poses, side by side (PNG, PDF, SVG)')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), metavar='N',
                        help='processes; default: as many as there are processor cores')
    arguments = parser.parse_args()
    for name in ('runs', 'jobs'):
        if not 1 <= getattr(arguments, name) <= 10 ** 6:
            parser.error('--%s: %d: expected 1 to a million' % (name, getattr(arguments, name)))
    if os.path.splitext(arguments.surface)[1]:      # a name has none
        arguments.surface = os.path.abspath(arguments.surface)
    if arguments.plot:
        known = sorted(Figure().canvas.get_supported_filetypes())
        if os.path.splitext(arguments.plot)[1][1:] not in known:
            parser.error('--plot: %s: expected a name that ends in one of .%s' % (arguments.plot, ', .'.join(known)))
        if not os.path.isdir(os.path.dirname(os.path.abspath(arguments.plot))):
            parser.error('--plot: %s: expected a folder that exists' % arguments.plot)
    arguments.method = list(dict.fromkeys(arguments.method or METHODS))
    return arguments


def run_all(method, config, surface, seeds, arguments):
    """The Results of a method, and the wall time they took in s."""
    start = time.monotonic()
    many = partial(simulate_many, method, config, surface)
    keep = PATHS if arguments.plot else 0
    results = list(many(seeds[:1], keep))
    long = (time.monotonic() - start) * len(seeds) > MOMENT
    rest = many(seeds[1:], keep - 1, arguments.jobs if long else 1)
    results += tqdm(rest, total=len(seeds), initial=1, desc=method, unit='run', disable=None if long else True)
    return results, time.monotonic() - start


def spread(values):
    """Mean and standard deviation, as text."""
    return '%8.3f +- %5.3f' % (numpy.mean(values), numpy.std(values))


def spread_of_angles(angles):
    """The same for angles in rad, in degrees: their mean is that of their directions."""
    mean = atan2(sum(map(sin, angles)), sum(map(cos, angles)))
    around = [degrees(remainder(angle - mean, 2 * pi)) for angle in angles]
    return '%8.2f +- %5.2f' % (degrees(mean) + numpy.mean(around), numpy.std(around))


def report(method, results):
    """Print where the robot is at the end, and where it believes that it is."""
    rows = [('truth', [r.end.truth for r in results]), ('/odom says', [r.end.odometry for r in results])]
    if results[0].end.estimate:
        rows.append(('/odom_ekf says', [r.end.estimate for r in results]))
    for name, poses in rows:
        x, y, yaw = zip(*poses)
        print('%-6s %-14s  %s  %s  %s  %s' % (method, name, spread(x), spread(y), spread_of_angles(yaw),
                                             spread([hypot(*pose[:2]) for pose in poses])))
        method = ''
    legs = [r.first_leg for r in results]
    print('%-6s first leg %.3f m (%.3f to %.3f)' % ('', numpy.mean(legs), min(legs), max(legs)))


def draw(file, surface, results):
    """A picture: for each method a column, above the ways to scale, below the end poses from near by."""
    figure = Figure(figsize=(5.6 * len(results), 9), constrained_layout=True)
    panels = figure.subplots(2, len(results), squeeze=False)
    number = len(next(iter(results.values())))
    figure.suptitle('Out and back on %s, %d %s' % (surface, number, 'run' if number == 1 else 'runs'))
    for (above, below), (method, runs) in zip(panels.T, results.items()):
        poses = numpy.array([r.end.truth for r in runs])
        x, y = poses[:, 0], poses[:, 1]
        yaw = numpy.degrees(numpy.angle(numpy.exp(1j * poses[:, 2])))
        draw_ways(above, [r.path for r in runs if r.path])
        draw_arrow(above, (0.0, 0.0, 0.0), 'black')
        draw_arrow(above, runs[0].end.truth, 'firebrick')
        above.set_title('%s: %.1f cm from the start, %.1f degrees off' % (
            TITLES[method], 100 * numpy.hypot(x, y).mean(), abs(yaw).mean()))
        few = number <= 500
        points = below.scatter(x, y, c=yaw, s=12 if few else 3, alpha=0.8 if few else 0.4, linewidths=0)
        figure.colorbar(points, ax=below, format='%.4g').solids.set(alpha=1)
        # square, around them all, and never so near that rounding shows
        half = max(0.005, 0.6 * numpy.ptp(x), 0.6 * numpy.ptp(y))
        below.set(title='where they end; colour: heading (degrees)', xlabel='x (m)', ylabel='y (m)', aspect='equal',
                  xlim=((x.min() + x.max()) / 2 - half, (x.min() + x.max()) / 2 + half),
                  ylim=((y.min() + y.max()) / 2 - half, (y.min() + y.max()) / 2 + half))
        below.grid(True, alpha=0.5)
    figure.savefig(file, dpi=90, bbox_inches='tight')


def draw_ways(axes, paths):
    """True ways, on a floor with a grid of 0.5 m as in RViz."""
    for path in paths:
        x, y, _ = zip(*[snapshot.truth for snapshot in path])
        axes.plot(x, y, color='tab:blue', linewidth=0.8, alpha=0.5)
    axes.set(xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=(-0.35, 1.25), ylim=(-0.45, 0.85),
             xticks=[0, 0.5, 1], yticks=[0, 0.5])
    axes.grid(True, alpha=0.5)


def draw_arrow(axes, pose, color):
    """The robot at a pose."""
    x, y, yaw = pose
    axes.plot(x, y, marker='o', color=color, zorder=4)
    axes.quiver(x, y, 0.2 * cos(yaw), 0.2 * sin(yaw), color=color, angles='xy', scale_units='xy', scale=1,
                width=0.012, zorder=4)


def read_robot(path):
    """The Config of an ArbotiX YAML file. Raises ConfigError, OSError, yaml.YAMLError."""
    with open(path, encoding='utf-8') as file:
        values = yaml.safe_load(file)
    try:
        return read_config(values)
    except ConfigError as error:
        raise ConfigError('%s: %s' % (path, error))


def main():
    """Simulate, print, draw. Returns the exit status."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)               # whoever reads may have seen enough
    signal.signal(signal.SIGTERM, signal.default_int_handler)   # as Ctrl-C: no process is left behind
    try:
        arguments = read_arguments()
        surface = load_surface(arguments.surface, resources.surfaces())
        seeds = range(read_seed(arguments.seed), read_seed(arguments.seed + arguments.runs - 1) + 1)
        config = read_robot(arguments.config)
        print('Runs of each method on %s: %d. Mean and spread (1 sigma) at the end:\n'
              '%-6s %-14s  %17s  %17s  %17s  %17s' % (arguments.surface, arguments.runs, 'method', '', 'x (m)', 'y (m)',
                                                      'heading (degrees)', 'from start (m)'))
        results = {}
        for method in arguments.method:
            results[method], took = run_all(method, config, surface, seeds, arguments)
            report(method, results[method])
            simulated = sum(r.end.time for r in results[method])
            print('%-6s %.0f s of the robot in %.2f s, %.0f times real time' % ('', simulated, took, simulated / took))
        if arguments.plot:
            draw(arguments.plot, arguments.surface, results)
            print('Picture: %s' % arguments.plot)
    except (OSError, ValueError, yaml.YAMLError) as error:     # or a robot that is stuck
        print('simulate.py: %s' % ' '.join(str(error).split()), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == '__main__':
    sys.exit(main())
