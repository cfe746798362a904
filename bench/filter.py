#!/usr/bin/env python3
"""Run the filter on every floor with every floor assumed, beside robot_pose_ekf's arithmetic. See README.md."""
import argparse
from collections import namedtuple
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
import json
import math

import numpy
import yaml

from robot_pose_ekf import RobotPoseEkf
from rbx1_nav.control.legs import StuckError
from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.filter import Priors, priors
from rbx1_nav.model.robot import read_robot
from rbx1_nav.model.surfaces import known_surfaces, load_surface
from rbx1_nav.ros import resources
from rbx1_nav.simulation import EXERCISE, METHODS, feed, simulate
from rbx1_nav.units import SECOND

IDEAL, UNKNOWN = 'ideal', 'unknown'
PATH = 2 * EXERCISE['goal_distance']    # m
CHUNK = 5       # seeds per task of a process
COLUMNS = (('heading', 'heading deg', 9), ('port_heading', 'port', 7), ('heading_ratio', 'ratio', 6),
           ('position', 'position m', 10), ('port_position', 'port', 7), ('position_ratio', 'ratio', 6),
           ('nees', 'NEES', 8), ('end_heading', 'end deg', 7), ('end_position', 'end m', 7))

Errors = namedtuple('Errors', 'ticks heading position end_heading end_position nees')
Errors.__doc__ = """Summed up over runs: number of ticks; squared errors of heading (degrees^2) and position (m^2), over all
ticks and at the end; normalised estimation errors squared at the end (0 for the port)."""


def unknown_priors():
    """The Priors where no floor is named."""
    return Priors(slip_straight=0.0, slip_straight_spread=0.05, slip_turning=0.0, slip_turning_spread=0.05,
                  gyro_bias=math.radians(1), gyro_scale_error=0.01, gyro_measurement_range=math.inf)


def squared_errors(pose, truth):
    """Squared errors of the heading (degrees^2) and the position (m^2)."""
    return (math.degrees(math.remainder(pose[2] - truth[2], 2 * math.pi)) ** 2,
            (pose[0] - truth[0]) ** 2 + (pose[1] - truth[1]) ** 2)


def consistency(pose, truth, covariance):
    """The normalised estimation error squared; infinite if the covariance is not one."""
    error = numpy.subtract(pose, truth)
    error[2] = math.remainder(error[2], 2 * math.pi)
    try:
        return float(numpy.sum(numpy.linalg.solve(numpy.linalg.cholesky(covariance), error) ** 2))
    except numpy.linalg.LinAlgError:
        return math.inf


class Follower:
    """Sums up the errors of an estimate in one run."""

    def __init__(self):
        self.ticks = 0
        self.squares = numpy.zeros(2)
        self.last = None

    def compare(self, pose, truth):
        """Compare the estimate after a tick with the truth."""
        self.last = pose, truth
        self.ticks += 1
        self.squares += squared_errors(pose, truth)

    def errors(self, covariance=None):
        """The Errors of the run. covariance: at its end."""
        return numpy.array([self.ticks, *self.squares, *squared_errors(*self.last),
                            0.0 if covariance is None else consistency(*self.last, covariance)])


def run(robot, surface, assumed, method, seed):
    """One run: the Errors of the filter for each of `assumed` (name: Priors), and those of the port.

    The assumed floor must be one if the method is ekf, where the robot follows the filter. Raises StuckError.
    """
    prior = next(iter(assumed.values())) if method == 'ekf' else None
    filters = {} if prior else {name: CombinedOdometry(each, SECOND) for name, each in assumed.items()}
    port = RobotPoseEkf()
    followers, port_follower = {name: Follower() for name in assumed}, Follower()

    def listen(snapshot, messages):
        odom = messages.odom
        port.update(odom.stamp / SECOND, odom.pose, messages.pose_variances, *messages.orientation)
        port_follower.compare(port.state, snapshot.truth)
        for name, follower in followers.items():
            if prior:
                pose = snapshot.estimate
            else:
                feed(filters[name], messages)
                pose = filters[name].estimate.pose
            follower.compare(pose, snapshot.truth)

    result = simulate(method, robot, surface, seed, prior=prior, listen=listen)
    return ({name: follower.errors(result.covariance if prior else filters[name].estimate.covariance)
             for name, follower in followers.items()}, port_follower.errors())


def run_some(task):
    """Runs of some seeds: (true floor, method), {assumed: (runs, Errors of the filter, of the port, stuck runs)}."""
    robot, true, surface, assumed, method, seeds = task
    sums = {name: [0, 0.0, 0.0, 0] for name in assumed}
    for seed in seeds:
        try:
            errors, port = run(robot, surface, assumed, method, seed)
        except StuckError:
            for each in sums.values():
                each[3] += 1
            continue
        for name, each in sums.items():
            each[0] += 1
            each[1] = each[1] + errors[name]
            each[2] = each[2] + port
    return (true, method), sums


def tasks(robot, surfaces, assumed, methods, seeds):
    """The arguments of run_some() for all runs."""
    for true, surface in surfaces.items():
        for method in methods:
            # a robot that follows the filter drives another path with each
            for group in ([{name: prior} for name, prior in assumed.items()] if method == 'ekf' else [assumed]):
                for start in range(0, seeds, CHUNK):
                    yield robot, true, surface, group, method, range(start, min(start + CHUNK, seeds))


def figures(runs, errors, port, stuck):
    """The figures of a true floor, an assumed floor and a method, from the sums of run_some()."""
    errors, port = Errors(*errors), Errors(*port)
    values = dict(runs=runs, stuck=stuck, nees=errors.nees / runs)
    for name, sums in ('', errors), ('port_', port):
        values.update({name + 'heading': math.sqrt(sums.heading / sums.ticks),
                       name + 'position': math.sqrt(sums.position / sums.ticks),
                       name + 'end_heading': math.sqrt(sums.end_heading / runs),
                       name + 'end_position': math.sqrt(sums.end_position / runs)})
    for name in 'heading', 'position':
        values[name + '_ratio'] = values[name] / values['port_' + name] if values['port_' + name] else math.inf
    return values


def limits(true, assumed, values, slip_difference):
    """{figure: (least, greatest)} of a pair of floors. slip_difference: of the true and the assumed slip_straight."""
    heading, position = 1.1 * values['port_heading'] + 0.1, 1.1 * values['port_position'] + 0.002
    if true == assumed:
        if true == IDEAL:
            return dict(heading=(0, 0.1), position=(0, 0.002), nees=(0, 5))
        return dict(heading=(0, heading), position=(0, 0.8 * values['port_position']), nees=(0.7, 5))
    if assumed == UNKNOWN:
        return dict(heading=(0, heading), position=(0, position), nees=(0 if true == IDEAL else 0.7, 5))
    return dict(heading=(0, heading), position=(0, position + abs(slip_difference) * PATH), nees=(0, 10))


def misses(values, bounds):
    """The figures that are beyond their limits, and `stuck` if a run ended before the exercise did."""
    return ([name for name, (least, greatest) in bounds.items() if not least <= values[name] <= greatest]
            + ['stuck'] * (values['stuck'] > 0))


def measure(robot, surfaces, assumed, methods, seeds, jobs):
    """One dict per true floor, method and assumed floor."""
    totals = {}
    with ProcessPoolExecutor(jobs) if jobs > 1 else nullcontext() as pool:
        for key, sums in (pool.map if pool else map)(run_some, tasks(robot, surfaces, assumed, methods, seeds)):
            for name, values in sums.items():
                before = totals.get((*key, name), [0, 0.0, 0.0, 0])
                totals[(*key, name)] = [one + other for one, other in zip(before, values)]
    slips = {name: priors(surface).slip_straight for name, surface in surfaces.items()}
    for (true, method, name), sums in totals.items():
        row = dict(true=true, assumed=name, method=method)
        if not sums[0]:
            yield dict(row, runs=0, stuck=sums[3], limits={}, misses=['stuck'])
            continue
        row.update(figures(*sums))
        row['limits'] = limits(true, name, row, slips[true] - assumed[name].slip_straight)
        row['misses'] = misses(row, row['limits'])
        yield row


def cell(row, name):
    """A figure as text: three digits that count."""
    value = row.get(name, math.nan)
    return '%.3g' % value if value < 100 else '%.0f' % value


def print_table(rows):
    """One line per row, in the order of true floor, assumed floor, method."""
    print('%-15s %-15s %-6s' % ('true', 'assumed', 'method'),
          ' '.join('%*s' % (max(width, len(title)), title) for _, title, width in COLUMNS), ' misses')
    for row in rows:
        print('%-15s %-15s %-6s' % (row['true'], row['assumed'], row['method']),
              ' '.join('%*s' % (max(width, len(title)), cell(row, name)) for name, title, width in COLUMNS),
              ' ' + (', '.join(row['misses']) or '-'))


def markdown(rows, methods):
    """A table with one line per pair of floors; each cell has the methods' values, in bold where one misses its limit."""
    titles = ['true floor', 'assumed', 'heading (degrees)', 'the port', 'position (cm)', 'the port', 'NEES']
    yield '| %s |' % ' | '.join(titles)
    yield '|' + '---|' * len(titles)
    pairs = {}
    for row in rows:
        pairs.setdefault((row['true'], row['assumed']), {})[row['method']] = row
    for (true, assumed), by_method in pairs.items():
        def cells(name, factor=1.0):
            for method in methods:
                row = by_method[method]
                text = '%.*f' % (1 if name == 'nees' else 2, factor * row.get(name, math.nan))
                yield '**%s**' % text if name in row['misses'] or 'stuck' in row['misses'] else text
        yield '| %s |' % ' | '.join([true, assumed] + [
            ', '.join(cells(*column)) for column in (('heading',), ('port_heading',), ('position', 100.0),
                                                     ('port_position', 100.0), ('nees',))])


def main():
    """Measure, print, and write JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=200, metavar='N', help='runs of each kind; default: 200')
    parser.add_argument('--true', action='append', metavar='NAME', help='only this true floor; can be repeated')
    parser.add_argument('--assumed', action='append', metavar='NAME', help='only this assumed floor; can be repeated')
    parser.add_argument('--method', action='append', choices=METHODS, help='only this method; can be repeated')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    parser.add_argument('--markdown', action='store_true', help='print the table of docs/figures.md')
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    for name in 'seeds', 'jobs':
        if getattr(arguments, name) < 1:
            parser.error('--%s: %d: expected an integer above 0' % (name, getattr(arguments, name)))
    folder = resources.surfaces()
    surfaces = {name: load_surface(name, folder) for name in known_surfaces(folder)}
    assumed = {**{name: priors(surface) for name, surface in surfaces.items()}, UNKNOWN: unknown_priors()}
    for name, known in ('true', surfaces), ('assumed', assumed):
        for value in getattr(arguments, name) or ():
            if value not in known:
                parser.error('--%s: %s: expected one of %s' % (name, value, ', '.join(known)))
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))
    methods = [method for method in METHODS if method in (arguments.method or METHODS)]
    order = [(true, name, method) for true in surfaces for name in assumed for method in methods]
    rows = sorted(measure(robot, {name: surfaces[name] for name in arguments.true or surfaces},
                          {name: assumed[name] for name in arguments.assumed or assumed},
                          methods, arguments.seeds, arguments.jobs),
                  key=lambda row: order.index((row['true'], row['assumed'], row['method'])))
    if arguments.markdown:
        print('\n'.join(markdown(rows, methods)))
    else:
        print_table(rows)
    print('%d of %d rows within all limits' % (sum(not row['misses'] for row in rows), len(rows)))
    if arguments.json:
        with open(arguments.json, 'w', encoding='utf-8') as file:
            json.dump(rows, file, indent=1)


if __name__ == '__main__':
    main()
