#!/usr/bin/env python3
"""Compare the filter with robot_pose_ekf's arithmetic for every true and every assumed floor. See README.md."""
import argparse

import yaml

from floors import UNKNOWN, Follower, KnownHeading, figures, limits, misses, markdown, report, table
from robot_pose_ekf import RobotPoseEkf
from rbx1_nav.base.description import read_robot
from rbx1_nav.base.surfaces import known_surfaces, load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.exercise.legs import StuckError
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.executor import add_arguments, in_order, open_place
from rbx1_nav.extras.many_runs.simulated_run import EXERCISE, feed, simulate
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors
from rbx1_nav.node import resources

PATH = 2 * EXERCISE['goal_distance']    # m, out and back
CHUNK = 5       # seeds per task of a process
NOTHING = 0, 0, 0.0, 0.0, 0.0   # the arguments of figures() before the first run


def run(robot, surface, assumed, method, seed):
    """One run: the Errors of the filter for each of `assumed` (name: Priors), of the port, and of KnownHeading.

    `assumed` must contain one floor if the method is ekf, because the robot then follows the filter. Raises StuckError.
    """
    prior = next(iter(assumed.values())) if METHODS[method].pose == 'estimate' else None
    filters = {} if prior else {name: CombinedOdometry(each, SECOND) for name, each in assumed.items()}
    port = RobotPoseEkf()
    best = KnownHeading(surface.slip_straight if surface else 0.0)
    followers, port_follower, best_follower = {name: Follower() for name in assumed}, Follower(), Follower()

    def listen(snapshot, messages):
        odom = messages.odom
        port.update(odom.stamp / SECOND, odom.pose, messages.pose_variances, *messages.orientation)
        port_follower.compare(port.state, snapshot.truth)
        best.update(odom.pose, snapshot.truth)
        best_follower.compare(best.pose, snapshot.truth)
        for name, follower in followers.items():
            if prior:
                pose = snapshot.estimate
            else:
                feed(filters[name], messages)
                pose = filters[name].pose
            follower.compare(pose, snapshot.truth)

    result = simulate(method, robot, surface, seed, prior=prior, listen=listen)
    return ({name: follower.errors(result.covariance if prior else filters[name].estimate.covariance)
             for name, follower in followers.items()}, port_follower.errors(), best_follower.errors())


def add(one, other):
    """The element-wise sum of two lists of arguments of figures()."""
    return [before + more for before, more in zip(one, other)]


def run_some(task):
    """Runs with several seeds: (true floor, method), {assumed: [arguments of figures()]}."""
    robot, true, surface, assumed, method, seeds = task
    sums = {name: list(NOTHING) for name in assumed}
    for seed in seeds:
        try:
            errors, port, known = run(robot, surface, assumed, method, seed)
        except StuckError:
            sums = {name: add(before, (0, 1, 0.0, 0.0, 0.0)) for name, before in sums.items()}
        else:
            sums = {name: add(before, (1, 0, errors[name], port, known)) for name, before in sums.items()}
    return (true, method), sums


def tasks(robot, surfaces, assumed, methods, seeds):
    """The arguments of run_some() for all runs."""
    for true, surface in surfaces.items():
        count = seeds if surface else 1     # nothing is drawn on the ideal floor
        for method in methods:
            # a robot that follows the filter drives a different path with each prior
            follows = METHODS[method].pose == 'estimate'
            for group in [{name: prior} for name, prior in assumed.items()] if follows else [assumed]:
                for start in range(0, count, CHUNK):
                    yield robot, true, surface, group, method, range(start, min(start + CHUNK, count))


def measure(robot, surfaces, assumed, methods, seeds, jobs, scheduler=None):
    """One dict per true floor, method and assumed floor."""
    totals = {}
    with open_place(jobs, scheduler, robot, None) as place:
        for key, sums in in_order(place, run_some, tasks(robot, surfaces, assumed, methods, seeds)):
            for name, values in sums.items():
                totals[(*key, name)] = add(totals.get((*key, name), NOTHING), values)
    slips = {name: priors(surface).slip_straight for name, surface in surfaces.items()}
    for (true, method, name), sums in totals.items():
        row = dict(true=true, assumed=name, method=method)
        if not sums[0]:
            yield dict(row, runs=0, stuck=sums[1], limits={}, misses=['stuck'])
            continue
        row.update(figures(*sums))
        row['limits'] = limits(true, name, row, abs(slips[true] - assumed[name].slip_straight) * PATH)
        row['misses'] = misses(row, row['limits'])
        yield row


def main():
    """Measure, print, and write JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=200, metavar='N', help='runs of each combination; default: 200')
    parser.add_argument('--true', action='append', metavar='NAME', help='only this true floor; can be repeated')
    parser.add_argument('--assumed', action='append', metavar='NAME', help='only this assumed floor; can be repeated')
    parser.add_argument('--method', action='append', choices=METHODS, help='only this method; can be repeated')
    add_arguments(parser, 1)
    parser.add_argument('--markdown', action='store_true', help='print the table of bench/filter_tables.md')
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    for name in 'seeds', 'jobs':
        if getattr(arguments, name) < 1:
            parser.error('--%s: %d: expected an integer above 0' % (name, getattr(arguments, name)))
    folder = resources.surfaces()
    surfaces = {name: load_surface(name, folder) for name in known_surfaces(folder)}
    assumed = {**{name: priors(surface) for name, surface in surfaces.items()}, UNKNOWN: UNKNOWN_FLOOR}
    for name, known in ('true', surfaces), ('assumed', assumed):
        for value in getattr(arguments, name) or ():
            if value not in known:
                parser.error(f"--{name}: {value}: expected one of {', '.join(known)}")
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))
    methods = [method for method in METHODS if method in (arguments.method or METHODS)]
    order = [(true, name, method) for true in surfaces for name in assumed for method in methods]
    rows = sorted(measure(robot, {name: surfaces[name] for name in arguments.true or surfaces},
                          {name: assumed[name] for name in arguments.assumed or assumed},
                          methods, arguments.seeds, arguments.jobs, arguments.scheduler),
                  key=lambda row: order.index((row['true'], row['assumed'], row['method'])))
    report(rows, (markdown if arguments.markdown else table)(rows), arguments.json)


if __name__ == '__main__':
    import filter     # the workers of a cluster import its functions by this name
    filter.main()
