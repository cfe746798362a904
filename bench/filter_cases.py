#!/usr/bin/env python3
"""Measure the filter where gyros drift, robots creep or turn slowly, and sensors fail. See README.md."""
import argparse
from itertools import accumulate
import math
import random
from typing import NamedTuple

import numpy

from floors import consistency
import simulated
from rbx1_nav.base.kinematics import Odometry, Pose
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from rbx1_nav.simulation.simulated_base import make_base

REST = 3.0              # s before the first motion, unless a case has another one
STOP = 5.0              # s at the end
SAMPLE = 0.5            # s between two poses that are compared with the truth
SIGMAS = 3.0            # an error of more standard deviations must have been announced
CREEP = 0.0002          # m/s
FLOORS = dict(lab='create_lab_floor', hard='hard_floor', carpet='low_ply_carpet')


class Case(NamedTuple):
    """A run. A path is a list of (s, m/s, rad/s); the errors count from the end of the rest to the end of the path."""
    name: str
    floor: str = 'lab'
    path: tuple = ()            # (): random arcs
    time: float = 300.0         # s, of a random path
    warm: tuple = (0.0, 60.0)   # degrees/s that the bias rises by after the rest, and the time constant (s)
    drift: float = 0.0          # degrees/s per minute, from the end of the rest on
    rest: float = REST
    rate: int = 30              # Hz, of odometry and gyro
    ticks: int = 0              # per meter; 0: of the floor
    still: str = ''             # what the odometry of a robot at rest does: creep, or dither
    hand: tuple = ()            # (start, end, degrees/s) by which a hand turns the robot
    scale: float = 0.0          # error of the gyro
    dead: bool = False          # whether the gyro reports 0.0
    smooth: bool = False        # whether the motors follow any speed, however low


CIRCLE, TURN = (60, 0.2, 0.35), 3.5     # TURN: s of a quarter turn at 0.45 rad/s
SQUARES = ((5, 0.2, 0), (TURN, 0, 0.45)) * 14
DRIVE = ((30, 0.2, 0.1), (30, 0.2, -0.1))
CASES = {case.name: case for case in (
    *(Case(f'{floor}_{name}', floor, **change) for floor in FLOORS for name, change in (
        ('no_drift', {}), ('warm_0.1', dict(warm=(0.1, 60.0))), ('warm_0.3', dict(warm=(0.3, 60.0))),
        ('drift_0.2', dict(drift=0.2)))),
    *(Case(f'{floor}_first_stop_{time}', floor, time=time, rest=0.0) for floor in ('lab', 'hard')
      for time in (10, 30, 60, 120)),
    *(Case(f'turn_{rate:g}_{ticks}', path=((120, 0, math.radians(rate)),), ticks=ticks, smooth=True)
      for rate in (0.3, 0.8) for ticks in (1000, 2000, 5000)),
    *(Case(f'arc_{ticks}', path=((120, 0.01, math.radians(0.3)),), ticks=ticks, smooth=True)
      for ticks in (1000, 2000, 5000)),
    *(Case(f'still_{still or "still"}_{rate}', 'hard', DRIVE, rest=30.0, rate=rate, still=still, ticks=1000)
      for rate in (10, 30, 50) for still in ('', 'creep', 'dither')),
    Case('turntable', 'hard', ((10, 0.2, 0), (16, 0, 0), *DRIVE), hand=(14, 26, 5.0)),
    Case('turntable_then_off', 'hard', ((10, 0.2, 0), (11, 0, 0), *DRIVE), hand=(14, 26, 5.0)),
    *(Case(f'{floor}_scale_5', floor, (CIRCLE,), scale=0.05) for floor in ('hard', 'carpet')),
    *(Case(f'{floor}_dead', floor, SQUARES, dead=True) for floor in ('hard', 'lab')))}


class Result(NamedTuple):
    """What one run shows; angles in degrees."""
    squared: float      # mean squared error of the heading
    end: float          # error of the heading before the stop
    sigma: float        # standard deviation of the heading there
    nees: float         # mean NEES / 3
    held: bool          # whether the error was within SIGMAS, or there was a warning before
    stopped: float      # error of the heading / standard deviation at the end of the stop
    step: float         # largest change of the heading between two messages, while the robot stands
    jump: float         # mm, largest change of the position
    warnings: int


def legs(case, rng, side):
    """The path of a case, with its rest and its stop."""
    path = list(case.path)
    while not case.path and sum(leg[0] for leg in path) < case.time:
        path.append((rng.uniform(1, 8), rng.uniform(0.06, 0.2), rng.choice((0, rng.uniform(-1, 1)))))
    if not case.path:
        path[-1] = (path[-1][0] - sum(leg[0] for leg in path) + case.time, *path[-1][1:])
    return [(case.rest, 0, 0), *((time, v, w * side) for time, v, w in path), (STOP, 0, 0)]


def run(task):
    """(name of the case, Result) for (Robot, Case, Surface, seed)."""
    robot, case, surface, seed = task
    rng, side = random.Random(f'filter {seed}'), (1, -1)[seed % 2]
    if case.ticks:
        surface = surface._replace(ticks_meter=case.ticks)
    if case.smooth:
        surface = surface._replace(drag_straight=1e-6, drag_turning=1e-6)
    base = make_base(robot._replace(rate=case.rate, limits=Limits(4.0, 8.0)), surface, seed)
    bias = base.gyro.run.gyro_bias
    if case.scale:
        base.gyro.run = base.gyro.run._replace(gyro_scale_error=case.scale)
    path = legs(case, rng, side)
    ends = list(accumulate(leg[0] for leg in path))
    warnings, estimates, truths, step = [], [], [], SECOND // case.rate
    combined = CombinedOdometry(UNKNOWN_FLOOR, SECOND, warn=warnings.append)
    base.read_gyro()
    extra, leg, dithered = Odometry(robot.base_width), 0, 0.0
    for number in range(1, round(ends[-1] * case.rate) + 1):
        now = number * step
        time = now / SECOND
        base.advance(now)
        since = max(0.0, time - case.rest)
        drifted = case.warm[0] * (1 - math.exp(-since / case.warm[1])) + case.drift * since / 60
        base.gyro.run = base.gyro.run._replace(gyro_bias=bias + math.radians(side * drifted))
        standing = not any(path[leg][1:])
        if case.hand and case.hand[0] <= time < case.hand[1] and standing:
            base.wheels.truth.move(0.0, math.radians(case.hand[2]) / case.rate)
        if standing and case.still == 'creep':
            extra.update(CREEP / case.rate, CREEP / case.rate)
        if case.still == 'dither':
            tick = rng.choice((0.0, 1.0)) / case.ticks if standing else 0.0
            extra.update(tick - dithered, 0.0)
            dithered = tick
        reading, pose = base.read_gyro(), base.odometry.pose
        if case.still:
            c, s = math.cos(pose.yaw), math.sin(pose.yaw)
            pose = Pose(pose.x + c * extra.x - s * extra.y, pose.y + s * extra.x + c * extra.y, pose.yaw + extra.yaw)
        rate = 0.0 if case.dead else reading.rate
        combined.add_imu(now, Imu(now, rate, reading.rate_variance))
        combined.add_odom(now, Odom(now, pose, 0.001, 0.03))
        sampled = number % round(SAMPLE * case.rate) == 0 or time > ends[-2] - 0.5
        estimates.append((combined.pose, combined.estimate.covariance if sampled else None, len(warnings)))
        truths.append(base.wheels.truth.pose)
        while leg < len(path) - 1 and time >= ends[leg] - 1e-9:
            leg += 1
        base.command(now, *path[leg][1:])
    return case.name, judge(case, ends, estimates, truths, len(warnings))


def judge(case, ends, estimates, truths, warnings):
    """The Result of a run."""
    def error(index):
        return math.degrees(math.remainder(estimates[index][0].yaw - truths[index].yaw, 2 * math.pi))

    def sigma(index):
        return math.degrees(math.sqrt(estimates[index][1][2][2]))
    first, last = round(ends[0] * case.rate), round(ends[-2] * case.rate) - 1
    step = round(SAMPLE * case.rate)
    samples = range((first // step + 2) * step - 1, last, step)
    held = True
    for index in samples:
        if abs(error(index)) > SIGMAS * sigma(index):
            held = estimates[index][2] > 0
            break
    still = [index for index in range(last + case.rate, len(truths) - 1)]
    poses = [pose for pose, _, _ in estimates]
    return Result(
        float(numpy.mean([error(index) ** 2 for index in samples])), error(last), sigma(last),
        float(numpy.mean([consistency(poses[index], truths[index], estimates[index][1])
                          for index in samples])) / 3, held,
        abs(error(still[-1])) / sigma(still[-1]),
        max(abs(math.degrees(poses[index + 1].yaw - poses[index].yaw)) for index in still),
        max(1e3 * math.hypot(poses[index + 1].x - poses[index].x, poses[index + 1].y - poses[index].y)
            for index in still), warnings)


def measure(names, seeds, jobs):
    """A row for each case."""
    robot = simulated.robot()
    floors = {name: simulated.floor(floor) for name, floor in FLOORS.items()}
    tasks = [(robot, CASES[name], floors[CASES[name].floor], seed) for name in names for seed in range(seeds)]
    results = {}
    for name, result in simulated.in_processes(jobs, run, tasks):
        results.setdefault(name, []).append(result)
    return results


def markdown(results):
    """The table, in Markdown."""
    yield ('| case | heading, rms (degrees) | at the end | claimed | NEES/3 | within 3 sigma, or announced | '
           'at the stop (sigma) | largest step (degrees, mm) | runs with a warning |')
    yield '|---' * 9 + '|'
    for name, rows in results.items():
        count = len(rows)

        def rms(figure):
            return math.sqrt(sum(getattr(row, figure) ** 2 for row in rows) / count)
        yield (f'| {name} | {math.sqrt(sum(row.squared for row in rows) / count):.2f} | {rms("end"):.2f} | '
               f'{rms("sigma"):.2f} | {sum(row.nees for row in rows) / count:.2f} | '
               f'{sum(row.held for row in rows)} of {count} | {max(row.stopped for row in rows):.1f} | '
               f'{max(row.step for row in rows):.2f}, {max(row.jump for row in rows):.1f} | '
               f'{sum(row.warnings > 0 for row in rows)} |')


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=10, metavar='N', help='runs of each case; default: 10')
    parser.add_argument('--case', action='append', choices=CASES, metavar='NAME', help='only this one; can be repeated')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    arguments = parser.parse_args()
    print('\n'.join(markdown(measure(arguments.case or list(CASES), arguments.seeds, arguments.jobs))))


if __name__ == '__main__':
    main()
