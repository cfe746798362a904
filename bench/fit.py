#!/usr/bin/env python3
"""Evaluate fit_surface.py with simulated runs on floors that are unknown to it. See README.md."""
import argparse
from math import radians
import random
import time

import numpy
import yaml

from rbx1_nav.base.description import read_robot
from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.surfaces import Surface, load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.exercise.legs import out_and_back
from rbx1_nav.extras.fitting.comparison import ENDS, inner_share, predict, simulate_paths
from rbx1_nav.extras.fitting.recording import Commands, Rates, Recording, Track
from rbx1_nav.extras.fitting.surface_fit import WholeFit
from rbx1_nav.extras.many_runs.simulated_run import EXERCISE, TICK
from rbx1_nav.node import resources
from rbx1_nav.simulation.simulated_base import make_base

RUNS = 10
RATE = 50           # Hz
TAPE = 0.01, 0.01, radians(2)   # 1 sigma: m, m, rad
RANGES = dict(      # of random surfaces: lowest, highest; drawn log-uniformly if both are above 0
    lag=(0.03, 0.3), accel_limit=(0.5, 3.0), drag_straight=(0.002, 0.02), drag_turning=(0.002, 0.03),
    slip_straight=(-0.02, 0.06), slip_straight_spread=(0.003, 0.02), slip_turning=(-0.02, 0.06),
    slip_turning_spread=(0.003, 0.02), ticks_meter=(4100, 4100), gyro_noise=(radians(0.05), radians(0.5)),
    gyro_bias=(radians(0.1), radians(2)), gyro_scale_error=(0.002, 0.02), gyro_measurement_range=(radians(150),) * 2,
    delay=(0.02, 0.3), curvature=(-0.1, 0.1), turning_loss=(0.0, 0.1), heading_noise_turning=(0.02, 0.12),
    heading_noise_straight=(0.01, 0.06), distance_noise=(0.005, 0.04))
WITHIN = 'drag_straight', 'drag_turning', 'delay', 'slip_straight', 'slip_turning'     # 5 %, the last two as a scale
KNOWN = 0.025       # a value is identifiable within 5 % if its relative standard error is at most this
START = 'low_ply_carpet'


def region_share(surface, recording, base_width, end, seed):
    """inner_share() of the true end pose of a run, predicted from its commands alone: for x and y, and for all
    three values. end: x, y (m), yaw (rad, not wrapped)."""
    _, prediction = predict(surface, recording, base_width)
    ends = simulate_paths(surface, prediction, 0, ENDS, numpy.random.default_rng(seed))[:, :, -1]
    return inner_share(ends[:, :2], end[:2]), inner_share(ends, end)


def random_surface(generator):
    """A Surface with values drawn from RANGES."""
    def draw(low, high):
        return low * (high / low) ** generator.random() if low > 0 else generator.uniform(low, high)
    return Surface('random', **{key: draw(*limits) for key, limits in RANGES.items()})


def exercise():
    """[(linear, angular, ticks)] of the tutorial's exercise, including its rests."""
    rest = (0.0, 0.0, RATE)
    motions = [each for motion in out_and_back(**EXERCISE) for each in (motion[1:], rest)]
    return [rest, rest] + motions + [rest]


def drive(generator):
    """[(linear, angular, ticks)] of a drive of 40 s with turns, arcs and straight parts at several speeds."""
    motions, left = [(0.0, 0.0, 2 * RATE)], 36 * RATE
    while left > 0:
        ticks = round(generator.uniform(1, 4) * RATE)
        kind = generator.choice(['straight', 'turn', 'arc', 'rest'])
        linear = generator.choice([0.1, 0.2, 0.3]) if kind in ('straight', 'arc') else 0.0
        angular = generator.choice([-1, 1]) * generator.choice([0.3, 0.6, 1.0]) if kind in ('turn', 'arc') else 0.0
        motions.append((linear, angular, ticks))
        left -= ticks
    return motions + [(0.0, 0.0, 2 * RATE)]


def record(robot, surface, seed, motions, name='run'):
    """(Recording with truth, true end pose)."""
    base = make_base(robot, surface, seed)
    base.read_gyro()
    now, commands, odometry, truth, gyro = 0, [], [(0.0, 0, 0, 0)], [(0.0, 0, 0, 0)], []
    for linear, angular, ticks in motions:
        for _ in range(ticks):
            base.command(now, linear, angular)
            commands.append((now / SECOND, linear, angular))
            now += TICK
            base.advance(now)
            odometry.append((now / SECOND, *base.odometry.pose))
            truth.append((now / SECOND, *base.wheels.truth.pose))
            gyro.append((now / SECOND, base.read_gyro().rate))
    return Recording(name, Commands(*numpy.transpose(commands)), Track(*numpy.transpose(odometry)),
                     Rates(*numpy.transpose(gyro)), Track(*numpy.transpose(truth)), None), base.wheels.truth.pose


def judge_values(robot, start, seeds, odometry=True):
    """Fit random surfaces, and print the deviations of the values from the true ones, in standard errors."""
    errors, parts, longest, left = {}, {key: [] for key in WITHIN}, 0.0, {}
    for seed in seeds:
        generator = random.Random(seed)
        surface = random_surface(generator)
        recordings = [record(robot, surface, 1000 * seed + run, exercise() if run < 3 else drive(generator))[0]
                      for run in range(RUNS)]
        if not odometry:
            recordings = [each._replace(odometry=None) for each in recordings]
        begin = time.process_time()
        result = WholeFit(recordings, robot.base_width, start).run()
        longest = max(longest, time.process_time() - begin)
        for key, value, error, _ in result.values:
            true = getattr(surface, key)
            if error is None:
                left.setdefault(key, []).append(seed)
                continue
            errors.setdefault(key, []).append((value - true) / error)
            if key in WITHIN:
                value, true = (1 - value, 1 - true) if key.startswith('slip') else (value, true)
                if error <= KNOWN * abs(value):
                    parts[key].append(abs(value / true - 1))
        print('surface %d: %.1f s %s' % (seed, time.process_time() - begin, '; '.join(result.warnings)), flush=True)
    for key, some in errors.items():
        some = numpy.array(some)
        print('%-24s %3d fitted, %3.0f %% within 2 standard errors, rms %.2f, median %5.2f; left: %d' % (
            key, len(some), 100 * (abs(some) < 2).mean(), (some ** 2).mean() ** 0.5, numpy.median(some),
            len(left.get(key, []))))
    everything = abs(numpy.concatenate(list(errors.values())))
    print(f'all values: {len(everything)}, {100 * (everything < 2).mean():.1f} % within 2 standard errors')
    for key, some in parts.items():
        if some:
            print('%-24s %3d of %d identifiable, %3.0f %% of them within 5 %%, the worst by %.1f %%' % (
                ('scale, by ' if key.startswith('slip') else '') + key, len(some), len(list(seeds)),
                100 * (numpy.array(some) < 0.05).mean(), 100 * max(some)))
    print(f'longest fit: {longest:.1f} s of CPU time')


def judge_tape(robot, start, seeds, odometry=True):
    """Fit three runs of the exercise with taped end poses; print how often the 90 % region contains a fourth one."""
    shares, with_heading = [], []
    for seed in seeds:
        generator = random.Random(seed)
        surface, normal = random_surface(generator), generator.gauss
        runs = [record(robot, surface, 1000 * seed + run, exercise()) for run in range(4)]
        recordings = [recording._replace(
            truth=None, odometry=recording.odometry if odometry else None,
            end=Pose(*(value + normal(0.0, sigma) for value, sigma in zip(end, TAPE)))) for recording, end in runs]
        result = WholeFit(recordings[:3], robot.base_width, start, TAPE).run()
        fourth = numpy.array(runs[3][1])
        ends = region_share(result.surface, recordings[3], robot.base_width, fourth, seed)
        shares.append(ends[0])
        with_heading.append(ends[1])
    for name, some in (('x, y', shares), ('x, y, heading', with_heading)):
        print('tape%s, %-14s fourth end poses in the 50 %% region: %3.0f of 100, in the 90 %% region: %3.0f of 100 '
              '(%d trials)' % (
                  '' if odometry else ', no odometry', f'{name}:', 100 * (numpy.array(some) < 0.5).mean(),
                  100 * (numpy.array(some) < 0.9).mean(), len(some)), flush=True)


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--surfaces', type=int, default=20, metavar='N', help='random surfaces; default: 20')
    parser.add_argument('--trials', type=int, default=100, metavar='N', help='trials with a tape; default: 100')
    parser.add_argument('--seed', type=int, default=0, metavar='S', help='the first seed; default: 0')
    parser.add_argument('--no-odometry', action='store_true', help='use only commands and truth')
    parser.add_argument('--start', default=START, metavar='NAME', help=f'starting surface; default: {START}')
    arguments = parser.parse_args()
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))
    start = load_surface(arguments.start, resources.surfaces())
    for count, judge in ((arguments.surfaces, judge_values), (arguments.trials, judge_tape)):
        if count:
            judge(robot, start, range(arguments.seed, arguments.seed + count), not arguments.no_odometry)


if __name__ == '__main__':
    main()
