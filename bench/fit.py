#!/usr/bin/env python3
"""Fit surfaces to simulated recordings of random floors, and count what the fit reports. See README.md."""
import argparse
from math import radians
import os
import random
import re
import sys

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
FOLDER = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, os.path.join(FOLDER, '..', 'test', 'unit', 'extras', 'fitting'))

import numpy

from sample_runs import EXERCISE, FLOOR, REST, record
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.robot_parameters import load_robot
from rbx1_nav.base.surfaces import KEYS, load_surface
from rbx1_nav.extras.fitting.comparison import mahalanobis
from rbx1_nav.extras.fitting.prediction import SPREADS
from rbx1_nav.extras.fitting.surface_fit import WholeFit
from rbx1_nav.extras.many_runs.cases import Case, simulate_rows
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS
from rbx1_nav.node import resources

WIDTH = 0.26    # m
RUNS = 4        # recordings of a fit
FLOORS = 10     # of the coverage
ENDS = 1000     # simulated end poses per floor
TAPE = 0.01, 0.01, radians(2)   # m, m, rad: errors of an end pose measured by hand
# motors and floors from these ranges
LOW = dict(lag=0.05, accel_limit=0.4, drag_straight=1e-4, drag_turning=1e-4, slip_straight=-0.05, slip_turning=0.0,
           delay=0.0, curvature=-0.05, turning_loss=0.02, heading_noise_turning=0.02, heading_noise_straight=0.02,
           distance_noise=0.01, slip_straight_spread=0.0, slip_turning_spread=0.0)
HIGH = dict(lag=0.2, accel_limit=1.0, drag_straight=0.015, drag_turning=0.02, slip_straight=0.05, slip_turning=0.1,
            delay=0.3, curvature=0.05, turning_loss=0.09, heading_noise_turning=0.12, heading_noise_straight=0.09,
            distance_noise=0.06, slip_straight_spread=0.02, slip_turning_spread=0.02)


def make_floor(chosen, **values):
    """A random floor with these values."""
    return FLOOR._replace(**{**{key: chosen.uniform(LOW[key], HIGH[key]) for key in LOW}, **values})


def drive(chosen):
    """A random drive of about a minute: legs, turns on the spot, arcs and rests."""
    motions = [REST]
    for _ in range(12):
        motions += [chosen.choice([(0.2, 0.0), (0.0, 1.0), (0.0, -0.7), (0.3, 0.5), (0.15, -0.6)])
                    + (chosen.randint(60, 220),)]
        if chosen.random() < 0.4:
            motions.append(REST)
    return (*motions, REST)


def drive_on(floor, chosen, name='run'):
    """The Recording of a random drive."""
    return record(drive(chosen), chosen.randrange(10 ** 6), floor, name)


def fit(start, recordings):
    """(FitResult, {key: Value})."""
    result = WholeFit(recordings, WIDTH, start, TAPE).run()
    return result, {value.key: value for value in result.values}


def clean(chosen, start):
    """Random drives on one floor: whether the fit warns of anything."""
    floor = make_floor(chosen)
    result, values = fit(start, [drive_on(floor, chosen, f'run{number}') for number in range(RUNS)])
    return bool(result.warnings), floor, values


def mixed(chosen, start):
    """Drives on two floors with delays of 0.25 and 0.08 s: whether the fit reports the delay and groups the files."""
    floors = [make_floor(chosen, delay=delay) for delay in (0.25, 0.08)]
    result, values = fit(start, [drive_on(floors[number % 2], chosen, f'run{number}')._replace(truth=None)
                                 for number in range(RUNS)])
    return any(re.match(r'delay 0.0\S+ in run1, run3 and 0.2\S+ in run0, run2[;:]', text)
               for text in result.warnings), floors[0], values


def limit(chosen, start):
    """An acceleration limit just above what the fastest stop needs: whether the fit keeps the value undetermined."""
    floor = make_floor(chosen)
    floor = floor._replace(accel_limit=1.05 * (0.3 + floor.drag_straight) / floor.lag)
    _, values = fit(start, [drive_on(floor, chosen)._replace(truth=None) for _ in range(RUNS)])
    return values['accel_limit'].error is None, floor, values


def unused(chosen, start):
    """The exercise, in which the robot never turns while it drives: whether the fit leaves turning_loss alone."""
    floor = make_floor(chosen)
    _, values = fit(start, [record(EXERCISE, chosen.randrange(10 ** 6), floor) for _ in range(RUNS)])
    return values['turning_loss'][1:3] == (start.turning_loss, None), floor, values


def measure_by_hand(chosen, floor):
    """The Recording of the exercise, with its end pose in place of the truth."""
    recording = record(EXERCISE, chosen.randrange(10 ** 6), floor)
    end = Pose(*(chosen.gauss(values[-1], error) for values, error in zip(recording.truth[1:], TAPE)))
    return recording._replace(truth=None, end=end)


def coverage(number, recordings, start, by_hand):
    """Shares (percent) of the end poses of timed runs on a random floor with large spreads that are inside the 50 % and
    the 90 % region of runs on a surface fitted to so many recordings, and inside the regions of the floor itself."""
    chosen = random.Random(f'coverage {number}')
    floor = make_floor(chosen, **{key: chosen.uniform(0.02, 0.1) for key in SPREADS})
    result, _ = fit(start, [measure_by_hand(chosen, floor) if by_hand else drive_on(floor, chosen)
                            for _ in range(recordings)])
    robot = load_robot(resources.path('config', 'turtlebot.yaml'))._replace(base_width=WIDTH)
    ends = []
    for first, surface in ((0, floor), (ENDS, result.surface), (2 * ENDS, floor)):
        rows = simulate_rows((Case('timed', robot, surface, PARAMETERS), range(first, first + ENDS)))
        ends.append(numpy.array(rows, dtype=float)[:, :2])
    return [round(100 * (mahalanobis(simulated, ends[0])
                         < numpy.quantile(mahalanobis(simulated, simulated), part)).mean())
            for simulated in ends[1:] for part in (0.5, 0.9)]


CASES = {'clean': clean, 'mixed': mixed, 'limit': limit, 'unused': unused}


def main():
    """Fit and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--case', choices=CASES, action='append', help='default: all')
    parser.add_argument('--tries', type=int, default=20, help='of each case; default: 20')
    parser.add_argument('--coverage', type=int, metavar='N', help='only the coverage of fits to N recordings')
    parser.add_argument('--by-hand', action='store_true', help='of recordings with end poses measured by hand')
    arguments = parser.parse_args()
    start = load_surface('low_ply_carpet', resources.surfaces())
    if arguments.coverage:
        shares = [coverage(number, arguments.coverage, start, arguments.by_hand) for number in range(FLOORS)]
        for name, values in ('mean', numpy.mean(shares, axis=0)), ('lowest', numpy.min(shares, axis=0)):
            print('%s: fitted %.0f / %.0f, known %.0f / %.0f' % (name, *values))
        return
    within = {}     # {key: whether the true value is within two standard errors}
    for name in arguments.case or CASES:
        said = 0
        for number in range(arguments.tries):
            found, floor, values = CASES[name](random.Random(f'{name} {number}'), start)
            said += found
            if name == 'clean':
                for key, value in values.items():
                    if value.error is not None and not key.startswith('gyro'):
                        within.setdefault(key, []).append(abs(value.value - getattr(floor, key)) <= 2 * value.error)
            sys.stderr.write(f'{name} {number}: {found}\n')
        print(f'{name}: {CASES[name].__doc__.split(": ")[1]} {said} of {arguments.tries}', flush=True)
    for key in (key for key in KEYS if key in within):
        print(f'{key}: within two standard errors {sum(within[key])} of {len(within[key])}')


if __name__ == '__main__':
    main()
