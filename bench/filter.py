#!/usr/bin/env python3
"""Compare the filter with robot_pose_ekf's arithmetic for every true and every assumed floor. See README.md."""
import argparse

from floors import UNKNOWN, Follower, KnownHeading, figures, limits, markdown, misses, report
from robot_pose_ekf import RobotPoseEkf
import simulated
from rbx1_nav.base.units import SECOND
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import feed, simulate
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors

PATH = 2.0      # m, out and back


def run(task):
    """((true floor, method), {assumed floor: (Errors of the filter, of the port, of KnownHeading)}) of one run.

    task: (Robot, name of the true floor, its Surface, {assumed floor: Priors}, method, seed), with one assumed floor if
    the robot follows the filter. Raises StuckError.
    """
    robot, true, surface, assumed, method, seed = task
    prior = next(iter(assumed.values())) if METHODS[method].filtered else None
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
                feed(filters[name], messages.imu, odom)
                pose = filters[name].pose
            follower.compare(pose, snapshot.truth)

    result = simulate(method, robot, surface, seed, prior=prior, listen=listen)
    return (true, method), {
        name: (follower.errors(result.covariance if prior else filters[name].estimate.covariance),
               port_follower.errors(), best_follower.errors()) for name, follower in followers.items()}


def tasks(surfaces, assumed, seeds):
    """The arguments of run() for all runs."""
    robot = simulated.robot()
    for true, surface in surfaces.items():
        for method in METHODS:
            for group in [{name: prior} for name, prior in assumed.items()] if METHODS[method].filtered else [assumed]:
                # nothing is drawn on the ideal floor
                for seed in range(seeds if surface else 1):
                    yield robot, true, surface, group, method, seed


def measure(seeds, jobs):
    """One dict per true floor, assumed floor and method."""
    surfaces = simulated.floors()
    assumed = {**{name: priors(surface) for name, surface in surfaces.items()}, UNKNOWN: UNKNOWN_FLOOR}
    runs = {}
    for key, errors in simulated.in_processes(jobs, run, tasks(surfaces, assumed, seeds)):
        for name, values in errors.items():
            runs.setdefault((*key, name), []).append(values)
    for true in surfaces:
        for name in assumed:
            unobservable = abs(assumed[true].slip_straight - assumed[name].slip_straight) * PATH
            for method in METHODS:
                row = dict(true=true, assumed=name, **figures(runs[true, method, name]))
                yield dict(row, misses=misses(row, limits(true, name, row, unobservable)))


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=200, metavar='N', help='runs of each combination; default: 200')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    arguments = parser.parse_args()
    rows = list(measure(arguments.seeds, arguments.jobs))
    report(markdown(rows), rows)


if __name__ == '__main__':
    main()
