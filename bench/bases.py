#!/usr/bin/env python3
"""Compare the filter with robot_pose_ekf's arithmetic on the messages of other projects' bases. See README.md."""
import argparse
from bisect import bisect_right
from itertools import accumulate
import math
import random
from typing import NamedTuple

import numpy

from base_cases import CASES
from floors import consistency, markdown_value, misses, report, squared_errors
from replay import reckon, replay, run_port, textbook
import simulated
from rbx1_nav.base.kinematics import ORIGIN
from rbx1_nav.base.robot_parameters import Limits
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.input_checks import Imu, Odom
from rbx1_nav.filter.priors import UNKNOWN_FLOOR
from rbx1_nav.simulation.simulated_base import make_base

LIMITS = Limits(4.0, 8.0)       # m/s, rad/s; no limits for these paths
RUN_UP = 2.0            # s of driving before the first message, if there is no rest
RATIO_SPREAD = 0.1      # 1 sigma of a skid-steer's ratio from motion to motion, as a fraction of the ratio
SAMPLE = 0.5            # s between two poses for which the NEES is calculated
# (s, fraction of the speed, rad/s); one of the paths of a key, depending on the seed
PATHS = {
    # the exercise three times; figures of eight; legs, some of them without a stop
    'legs': (((5, 1, 0), (1, 0, 0), (3.2, 0, 1), (1, 0, 0)) * 6,
             ((10.4, 1, 0.6), (10.4, 1, -0.6), (2, 0, 0)) * 3,
             ((4, 1, 0), (3, 0.5, 0.5), (6, 1, 0), (1.6, 0, 0), (1.6, 0, -1), (3, 1, 0), (5, 1, -0.3), (1.4, 0, 0),
              (4, -0.5, 0), (4.8, 0, 1), (1, 0, 0)) * 2),
    # without a stop
    'circle': (((120, 1, 0.35),),),
    'eights': (((18, 1, 0.35), (18, 1, -0.35)) * 5,),
    'squares': (((5, 1, 0), (1.6, 0.5, 1)) * 27,),
    'straight': (((180, 1, 0),),),
    'spins': (((5, 1, 0), (3.5, 0, 3.6)) * 6,)}
RANDOM = 600            # s, default duration of the random path
FAULT = 10.0, 4.0       # s: begin after the first motion, and duration
SPIN, HAND = 0.3, 0.4   # m/s, rad/s: speed of a wheel without grip; a hand that turns the robot
ESTIMATORS = '', 'port_', 'reckoned_', 'wheels_', 'textbook_'      # prefixes of figures; the first: the filter
COLUMNS = (('heading', 'heading deg', 2), ('port_heading', 'port', 2), ('reckoned_heading', 'reckoned', 2),
           ('wheels_heading', 'wheels', 2), ('textbook_heading', 'textbook', 2),
           ('position', 'position m', 2), ('port_position', 'port', 2),
           ('reckoned_position', 'reckoned', 2), ('wheels_position', 'wheels', 2),
           ('nees', 'NEES/3', 2), ('claimed', 'claimed deg', 1), ('by_bias', 'by bias', 2))  # figure, title, decimals


class Record(NamedTuple):
    """The messages of a run, each list in stamp order, and the truth."""
    odom: list      # (Odom, variances of its pose's x, y (m^2) and yaw (rad^2))
    imu: list       # (Imu, (yaw, variance) of its orientation), the first one for the time since 0
    truth: list     # Pose at the stamp of each Odom
    restarts: list  # numbers of the Odoms at which the odometry restarts at the origin; the truth does, too


def drive(robot, case, surface, seed, duration=RANDOM):
    """The Record of a run. The seed also selects the path and its direction of turning. duration: of a random path,
    s."""
    rng = random.Random('bases %d' % seed)
    if case.ratio != 1:     # equal noise in a true turn, although the wheels turn farther
        surface = surface._replace(heading_noise_turning=surface.heading_noise_turning / math.sqrt(case.ratio))
    base = make_base(robot._replace(rate=case.odom_rate, limits=LIMITS), surface, seed)
    if case.bias is not None:
        base.gyro.run = base.gyro.run._replace(gyro_bias=math.radians(case.bias))
    if case.scale is not None:
        base.gyro.run = base.gyro.run._replace(gyro_scale_error=case.scale)
    # wheels that report twice the turn are commanded to turn twice as fast, so the paths are equal
    side = case.ratio * (1, -1)[seed // len(PATHS) % 2]
    legs = [(case.rest or RUN_UP, *((0, 0) if case.rest else (1, 0.1))), *path_of(case.path, rng, seed, duration)]
    if case.rest:
        legs.append((1, 0, 0))
    begin = legs[0][0] * SECOND     # of the motion whose errors count
    ends = [round(end * SECOND) for end in accumulate(leg[0] for leg in legs)]
    # devices with different rates have separate clocks
    phase = 0.0 if case.imu_rate == case.odom_rate else rng.random()
    stamps = [(round(number * SECOND / case.odom_rate), 1) for number in range(ends[-1] * case.odom_rate // SECOND + 1)]
    stamps += [(round((number + phase) * SECOND / case.imu_rate), 0)
               for number in range(1, ends[-1] * case.imu_rate // SECOND + 2)]
    record, current, before, frozen = Record([], [], [], []), None, 0, None
    base.read_gyro()        # readings start now
    for stamp, is_odom in sorted(stamps):
        base.advance(stamp)
        at_fault = 0 <= stamp - begin - FAULT[0] * SECOND < FAULT[1] * SECOND
        elapsed, before = (stamp - before) / SECOND, stamp
        if case.fault == 'spin' and at_fault:
            base.odometry.update(0.0, SPIN * elapsed)
        elif case.fault == 'carried' and at_fault:
            base.wheels.truth.move(0.0, HAND * elapsed)
        elif case.fault == 'restart' and at_fault and is_odom and not record.restarts:
            restart(base, record)
        if is_odom:
            if not case.rest and stamp <= begin < stamp + SECOND / case.odom_rate:
                record.odom.clear(), record.truth.clear(), record.restarts.clear()
                record.imu[:] = record.imu[-1:]
                restart(base, record)
            record.odom.append(odometry(case, base, stamp))
            record.truth.append(base.wheels.truth.pose)
        else:
            if case.drift:
                bias = case.bias + case.drift * stamp / SECOND / 60
                base.gyro.run = base.gyro.run._replace(gyro_bias=math.radians(bias))
            reading = base.read_gyro()
            rate_variance, yaw_variance = case.imu or (reading.rate_variance, reading.yaw_variance)
            if case.fault == 'frozen' and at_fault:
                frozen = frozen or reading
                reading = frozen
            record.imu.append((Imu(stamp, reading.rate, rate_variance), (reading.yaw, yaw_variance)))
        leg = min(bisect_right(ends, stamp), len(legs) - 1)
        if leg != current and case.ratio != 1:
            ratio = case.ratio * max(0.5, rng.gauss(1, RATIO_SPREAD))
            base.wheels.floor.run = base.wheels.floor.run._replace(slip_turning=1 - 1 / ratio)
        current = leg
        linear, angular = legs[leg][1] * case.speed, legs[leg][2] * side
        if case.fault == 'carried' and at_fault:
            linear = angular = 0.0
        base.command(stamp, linear, angular)
    return record


def path_of(name, rng, seed, duration):
    """The legs of a path."""
    if name != 'random':
        return PATHS[name][seed % len(PATHS[name])]
    legs = []
    while sum(leg[0] for leg in legs) < duration:
        legs.append((rng.uniform(1, 8), rng.uniform(0.3, 1), rng.choice((0, rng.uniform(-1, 1)))))
    return legs


def restart(base, record):
    """Restart the odometry and the truth at the origin."""
    base.gyro._true_yaw -= base.wheels.truth.pose.yaw
    base.odometry.pose = base.wheels.truth.pose = ORIGIN
    record.restarts.append(len(record.odom))


def odometry(case, base, stamp):
    """(Odom, variances of its pose's x, y and yaw) of a base."""
    position, yaw = base.wheels.uncertainty[:2]
    if case.odom:
        position, yaw = case.odom_at_rest if case.odom_at_rest and base.at_rest else case.odom
    return Odom(stamp, base.odometry.pose, position if case.odom else base.wheels.uncertainty.linear,
                yaw if case.odom else base.wheels.uncertainty.angular), (position, position, yaw)


def run_filter(record, warn=lambda text: None):
    """The Estimate of the filter at the stamp of each Odom, or the previous one if there is none."""
    estimates = replay(record, UNKNOWN_FLOOR, 0, warn=warn)
    stamps = sorted(estimates)
    return [estimates[stamps[bisect_right(stamps, odom.stamp) - 1]] for odom, _ in record.odom]


def rest_of(rest):
    """The stamps between which a robot is calibrated that rests for so many seconds at first."""
    return -1, rest * SECOND if rest else -1


def judge(case, record):
    """An array: mean squared errors of each of ESTIMATORS (degrees^2, m^2) over the run, the mean NEES of the filter
    divided by 3, and the mean variance that it claims for its heading (degrees^2)."""
    start = record.restarts[-1] if record.restarts else 0
    estimates, truth = run_filter(record)[start:], record.truth[start:]
    first, step = round(((0 if start else case.rest) + SAMPLE) * case.odom_rate), round(SAMPLE * case.odom_rate)
    values = []
    for poses in ([estimate.pose for estimate in estimates], run_port(record, record.odom[start][0].stamp),
                  reckon(record, rest_of(case.rest), start),
                  [odom.pose for odom, _ in record.odom[start:]],
                  [(0.0, 0.0, yaw) for yaw in textbook(record, start)]):
        pairs = zip(poses[first::step], truth[first::step])
        values += numpy.mean([squared_errors(*pair) for pair in pairs], axis=0).tolist()
    pairs = list(zip(estimates, truth))[first::step]
    nees = numpy.mean([consistency(estimate.pose, true, estimate.covariance) for estimate, true in pairs]) / 3
    claimed = numpy.mean([math.degrees(math.sqrt(estimate.covariance[2][2])) ** 2 for estimate, _ in pairs])
    return numpy.array([*values, nees, claimed])


def run(task):
    """(name of the case, result of judge()) for a task: (robot, Case, Surface, seed)."""
    return task[1].name, judge(task[1], drive(*task))


def figures(name, seeds, sums):
    """The row of a case: root mean squares over the seeds (degrees, m), and the mean NEES / 3."""
    means = [float(value) / seeds for value in sums]
    row = dict(case=name, nees=means[-2], claimed=math.sqrt(means[-1]))
    for prefix, heading, position in zip(ESTIMATORS, means[0::2], means[1::2]):
        row.update({f'{prefix}heading': math.sqrt(heading), f'{prefix}position': math.sqrt(position)})
    return row


def judged(row, unbiased=None):
    """The row with its limits and misses. unbiased: the row of the corresponding case with a bias of 0."""
    case = CASES.get(row['case'])
    if case and not case.rest:
        limits = dict(heading=1.5 * row['textbook_heading'] + 3)
    elif case and (case.fault not in ('', 'restart') or case.path in ('straight', 'spins')):
        limits = dict(heading=1.5 * min(row[f'{each}heading'] for each in ESTIMATORS[1:4]) + 2)
    else:
        limits = {figure: 1.2 * min(row[f'{each}{figure}'] for each in ESTIMATORS[1:4]) + margin
                  for figure, margin in (('heading', 0.5), ('position', 0.02))}
    row = dict(row, limits={**{figure: (0, limit) for figure, limit in limits.items()}, 'nees': (0.1, 5)})
    if unbiased:
        row['by_bias'] = row['heading'] / unbiased['heading']
        row['limits']['by_bias'] = 0, 1.2
    return dict(row, misses=misses(row, row['limits']))


def measure(names, seeds, jobs):
    """One row per case, in the order of `names` (of the cases)."""
    robot, surfaces = simulated.robot(), simulated.floors()
    tasks = [(robot, CASES[name], surfaces[CASES[name].floor], seed) for name in names for seed in range(seeds)]
    sums = dict.fromkeys(names, 0.0)
    for name, values in simulated.in_processes(jobs, run, tasks):
        sums[name] = sums[name] + values
    rows = {name: figures(name, seeds, values) for name, values in sums.items()}
    return [judged(row, rows.get(CASES[name].unbiased)) for name, row in rows.items()]


def markdown(rows):
    """The rows in Markdown. Figures beyond their limits are bold."""
    yield f"| case | {' | '.join(title for _, title, _ in COLUMNS)} |"
    yield f"{'|---' * (len(COLUMNS) + 1)}|"
    for row in rows:
        yield '| %s |' % ' | '.join([row['case'], *(markdown_value(row, name, 1, places) if name in row else '-'
                                                    for name, _, places in COLUMNS)])


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=20, metavar='N', help='runs of each case; default: 20')
    parser.add_argument('--case', action='append', choices=CASES, metavar='NAME',
                        help='only this case, and the one with a bias of 0 that it is compared with; can be repeated')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    arguments = parser.parse_args()
    wanted = set(arguments.case or CASES)
    wanted |= {CASES[name].unbiased for name in wanted}     # limits are relative to these
    rows = measure([name for name in CASES if name in wanted], arguments.seeds, arguments.jobs)
    report(markdown(rows), rows)


if __name__ == '__main__':
    main()
