#!/usr/bin/env python3
"""Simulate the exercise with and without steering on the legs (examples/answers/steering.py). See README.md."""
import argparse
from functools import partial
import importlib.util
from math import pi
import os

import numpy

import simulated
from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.exercise.legs import Straight, out_and_back_by_odometry
from rbx1_nav.extras.many_runs import simulated_run
from rbx1_nav.extras.many_runs.summary import HEADER, Summary

ANSWER = os.path.join(os.path.dirname(os.path.realpath(__file__)), '..', 'examples', 'answers', 'steering.py')


def load_answer():
    """The module of the answer, which drives only if it is run as a script."""
    spec = importlib.util.spec_from_file_location('steering_answer', ANSWER)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Steered(Straight):
    """A straight leg that is steered to the line between the start and the goal of the exercise."""

    direction = 0.0     # rad
    steering = None     # steering() of the answer

    def velocity(self, speed):
        """(linear, angular) for a speed, m/s and rad/s."""
        return speed, self.steering(self.last, ORIGIN, self.direction)


def steered_legs(steering, **arguments):
    """The legs of the exercise, the straight ones Steered."""
    legs = out_and_back_by_odometry(**arguments)
    for leg, direction in zip((leg for leg in legs if isinstance(leg, Straight)), (0.0, pi)):
        leg.__class__ = Steered
        leg.direction, leg.steering = direction, steering
    return legs


def across(results):
    """A line with the components of the error, and how much of the one across the legs the estimate shows."""
    truth = numpy.array([r.end.truth for r in results])
    x, y = (numpy.sqrt((truth[:, axis] ** 2).mean()) for axis in (0, 1))
    line = f'x rms {x:.4f} m, y rms {y:.4f} m, {100 * y ** 2 / (x ** 2 + y ** 2):.0f} % of the square across the legs'
    if results[0].end.estimate:
        estimated = numpy.array([r.end.estimate.y for r in results])
        line += (f'; y and its estimate: correlation {numpy.corrcoef(truth[:, 1], estimated)[0, 1]:.3f}, '
                 f'difference rms {numpy.sqrt(((truth[:, 1] - estimated) ** 2).mean()):.4f} m')
    return line


def simulate(method, runs, steering=None):
    """The results of runs on low_ply_carpet, with the seeds from 0. steering: of the answer; None: straight ahead."""
    robot, carpet = simulated.robot(), simulated.floor('low_ply_carpet')
    simulated_run.out_and_back_by_odometry = (
        partial(steered_legs, steering) if steering else out_and_back_by_odometry)
    try:
        return [simulated_run.simulate(method, robot, carpet, seed) for seed in range(runs)]
    finally:
        simulated_run.out_and_back_by_odometry = out_and_back_by_odometry


def main():
    """Simulate and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--runs', type=int, default=100, help='runs of each method, seeds from 0; default: 100')
    arguments = parser.parse_args()
    print(HEADER)
    for title, steering in ('Straight ahead', None), ('Steered', load_answer().steering):
        for method in 'odom', 'ekf':
            results = simulate(method, arguments.runs, steering)
            summary = Summary()
            truths, odometry, estimates = zip(*((run.end.truth, run.end.odometry, run.end.estimate) for run in results))
            summary.add(numpy.array(truths), numpy.array(odometry), numpy.array(estimates) if estimates[0] else None,
                        numpy.array([run.first_leg for run in results]))
            print('\n'.join([f'{title}:', *summary.lines(method), across(results)]))


if __name__ == '__main__':
    main()
