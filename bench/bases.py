#!/usr/bin/env python3
"""Compare the filter with robot_pose_ekf's arithmetic on the messages of other projects' bases. See README.md."""
import argparse
from bisect import bisect_right
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from itertools import accumulate
import math
import random
from typing import NamedTuple

import numpy
import yaml

from base_cases import CASES
from floors import aligned, consistency, digits, markdown_value, misses, report, squared_errors
from replay import replay
from robot_pose_ekf import RobotPoseEkf
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR
from rbx1_nav.estimation.inputs import Imu, Odom
from rbx1_nav.robot.description import read_robot
from rbx1_nav.ros.node import resources
from rbx1_nav.simulation.base import make_base
from rbx1_nav.simulation.surfaces import load_surface
from rbx1_nav.units import SECOND

REST = 3.0              # s before the first motion
RATIO_SPREAD = 0.1      # 1 sigma of a skid-steer's ratio from motion to motion, as a fraction of the ratio
SAMPLE = 0.5            # s between two poses for which the NEES is calculated
# (s, fraction of the speed, rad/s): the exercise three times; figures of eight; legs, some of them without a stop
PATHS = (((5, 1, 0), (1, 0, 0), (3.2, 0, 1), (1, 0, 0)) * 6,
         ((10.4, 1, 0.6), (10.4, 1, -0.6), (2, 0, 0)) * 3,
         ((4, 1, 0), (3, 0.5, 0.5), (6, 1, 0), (1.6, 0, 0), (1.6, 0, -1), (3, 1, 0), (5, 1, -0.3), (1.4, 0, 0),
          (4, -0.5, 0), (4.8, 0, 1), (1, 0, 0)) * 2)
ESTIMATORS = '', 'port_', 'reckoned_'      # prefixes of their figures; the first is the filter
COLUMNS = (('heading', 'heading deg', 2), ('port_heading', 'port', 2), ('reckoned_heading', 'reckoned', 2),
           ('position', 'position m', 2), ('port_position', 'port', 2), ('reckoned_position', 'reckoned', 2),
           ('nees', 'NEES', 1), ('by_bias', 'by bias', 2))      # figure, title, decimals in Markdown


class Record(NamedTuple):
    """The messages of a run, each list in stamp order, and the truth."""
    odom: list      # (Odom, variances of its pose's x, y (m^2) and yaw (rad^2))
    imu: list       # (Imu, (yaw, variance) of its orientation), the first one for the time since 0
    truth: list     # Pose at the stamp of each Odom


def drive(robot, case, surface, seed):
    """The Record of a run. The seed also selects the path and its direction of turning."""
    rng = random.Random('bases %d' % seed)
    if case.ratio != 1:     # equal noise in a true turn, although the wheels turn farther
        surface = surface._replace(heading_noise_turning=surface.heading_noise_turning / math.sqrt(case.ratio))
    base = make_base(robot._replace(rate=case.odom_rate), surface, seed)
    if case.bias is not None:
        base.gyro.run = base.gyro.run._replace(gyro_bias=math.radians(case.bias))
    if case.scale is not None:
        base.gyro.run = base.gyro.run._replace(gyro_scale_error=case.scale)
    # wheels that report twice the turn are commanded to turn twice as fast, so the paths are equal
    side = case.ratio * (1, -1)[seed // len(PATHS) % 2]
    legs = [(REST, 0, 0), *PATHS[seed % len(PATHS)], (1, 0, 0)]
    ends = [round(end * SECOND) for end in accumulate(leg[0] for leg in legs)]
    # devices with different rates have separate clocks
    phase = 0.0 if case.imu_rate == case.odom_rate else rng.random()
    stamps = [(round(number * SECOND / case.odom_rate), 1) for number in range(ends[-1] * case.odom_rate // SECOND + 1)]
    stamps += [(round((number + phase) * SECOND / case.imu_rate), 0)
               for number in range(1, ends[-1] * case.imu_rate // SECOND + 2)]
    record, current = Record([], [], []), None
    base.read_gyro()        # readings start now
    for stamp, is_odom in sorted(stamps):
        base.advance(stamp)
        if is_odom:
            record.odom.append(odometry(case, base, stamp))
            record.truth.append(base.wheels.truth.pose)
        else:
            if case.drift:
                bias = case.bias + case.drift * stamp / SECOND / 60
                base.gyro.run = base.gyro.run._replace(gyro_bias=math.radians(bias))
            reading = base.read_gyro()
            rate_variance, yaw_variance = case.imu or (reading.rate_variance, reading.yaw_variance)
            record.imu.append((Imu(stamp, reading.rate, rate_variance), (reading.yaw, yaw_variance)))
        leg = min(bisect_right(ends, stamp), len(legs) - 1)
        if leg != current and case.ratio != 1:
            ratio = case.ratio * max(0.5, rng.gauss(1, RATIO_SPREAD))
            base.wheels.run = base.wheels.run._replace(slip_turning=1 - 1 / ratio)
        current = leg
        base.command(stamp, legs[leg][1] * case.speed, legs[leg][2] * side)
    return record


def odometry(case, base, stamp):
    """(Odom, variances of its pose's x, y and yaw) of a base."""
    position, yaw, linear, angular = base.wheels.uncertainty
    if case.odom:
        position, yaw = linear, angular = case.odom_at_rest if case.odom_at_rest and base.at_rest else case.odom
    if not case.twist:
        linear = angular = 0.0
    return Odom(stamp, base.odometry.pose, linear, angular), (position, position, yaw)


def run_filter(record):
    """The Estimate of the filter at the stamp of each Odom, or the previous one if there is none."""
    estimates = replay(record, UNKNOWN_FLOOR, 0)
    stamps = sorted(estimates)
    return [estimates[stamps[bisect_right(stamps, odom.stamp) - 1]] for odom, _ in record.odom]


def yaw_at_odometry(record, yaws):
    """The values of the IMU messages, interpolated at the odometry stamps, as in robot_pose_ekf."""
    return numpy.interp([odom.stamp for odom, _ in record.odom], [imu.stamp for imu, _ in record.imu], yaws)


def run_port(record):
    """The last pose of robot_pose_ekf's arithmetic. The IMU's yaw is integrated after its calibration at rest."""
    port = RobotPoseEkf()
    yaws, variances = (yaw_at_odometry(record, [each[1][index] for each in record.imu]) for index in (0, 1))
    for (odom, pose_variances), yaw, variance in zip(record.odom, yaws, variances):
        port.update(odom.stamp / SECOND, odom.pose, pose_variances, yaw, variance)
    return port.state


def reckon(record):
    """The last pose of dead reckoning: wheel distance along the gyro heading. The mean gyro rate of the first REST
    seconds is subtracted before the integration."""
    stamps = numpy.array([imu.stamp for imu, _ in record.imu]) / SECOND
    rates = numpy.array([imu.rate for imu, _ in record.imu])
    durations = numpy.diff(stamps, prepend=0.0)
    rest = stamps <= REST
    yaws = yaw_at_odometry(record, numpy.cumsum((rates - numpy.average(rates[rest], weights=durations[rest]))
                                                * durations))
    x, y, yaw = numpy.array([odom.pose for odom, _ in record.odom]).T
    reported, turned = (each[:-1] + numpy.diff(each) / 2 for each in (yaw, yaws))
    forward = numpy.diff(x) * numpy.cos(reported) + numpy.diff(y) * numpy.sin(reported)
    return numpy.sum(forward * numpy.cos(turned)), numpy.sum(forward * numpy.sin(turned)), yaws[-1]


def judge(case, record):
    """An array: final squared errors of each of ESTIMATORS (degrees^2, m^2), and the mean NEES of the filter."""
    estimates, truth = run_filter(record), record.truth
    start, step = round((REST + SAMPLE) * case.odom_rate), round(SAMPLE * case.odom_rate)
    nees = numpy.mean([consistency(estimate.pose, true, estimate.covariance)
                       for estimate, true in zip(estimates[start::step], truth[start::step])])
    return numpy.array([*squared_errors(estimates[-1].pose, truth[-1]), *squared_errors(run_port(record), truth[-1]),
                        *squared_errors(reckon(record), truth[-1]), nees])


def run(task):
    """(name of the case, result of judge()) for a task: (robot, Case, Surface, seed)."""
    return task[1].name, judge(task[1], drive(*task))


def figures(name, seeds, sums):
    """The row of a case: root mean square of the final errors over the seeds (degrees, m), and the mean NEES."""
    means = [float(value) / seeds for value in sums]
    row = dict(case=name, seeds=seeds, nees=means[-1])
    for prefix, heading, position in zip(ESTIMATORS, means[0::2], means[1::2]):
        row.update({f'{prefix}heading': math.sqrt(heading), f'{prefix}position': math.sqrt(position)})
    return row


def judged(row, unbiased=None):
    """The row with its limits and misses. unbiased: the row of the corresponding case with a bias of 0."""
    row = dict(row, limits=dict(
        heading=(0, 1.1 * min(row['port_heading'], row['reckoned_heading']) + 0.1), nees=(0.3, 6)))
    if unbiased:
        row['by_bias'] = row['heading'] / unbiased['heading']
        row['limits']['by_bias'] = 0, 1.2
    return dict(row, misses=misses(row, row['limits']))


def measure(robot, names, seeds, jobs):
    """One row per case, in the order of `names` (of the cases)."""
    surfaces = {floor: load_surface(floor, resources.surfaces()) for floor in {CASES[name].floor for name in names}}
    tasks = [(robot, CASES[name], surfaces[CASES[name].floor], seed) for name in names for seed in range(seeds)]
    sums = dict.fromkeys(names, 0.0)
    with ProcessPoolExecutor(jobs) if jobs > 1 else nullcontext() as pool:
        for name, values in (pool.map if pool else map)(run, tasks):
            sums[name] = sums[name] + values
    rows = {name: figures(name, seeds, values) for name, values in sums.items()}
    return [judged(row, rows.get(CASES[name].unbiased)) for name, row in rows.items()]


def table(rows):
    """One line per row."""
    lines = [['case', *(title for _, title, _ in COLUMNS), 'misses']]
    lines += [[row['case'], *(digits(row.get(name, math.nan)) for name, _, _ in COLUMNS),
               ', '.join(row['misses']) or '-'] for row in rows]
    return aligned(lines, 1)


def markdown(rows):
    """The rows in Markdown. Figures beyond their limits are bold."""
    yield f"| case | {' | '.join(title for _, title, _ in COLUMNS)} |"
    yield f"{'|---' * (len(COLUMNS) + 1)}|"
    for row in rows:
        yield '| %s |' % ' | '.join([row['case'], *(markdown_value(row, name, 1, places) if name in row else '-'
                                                    for name, _, places in COLUMNS)])


def main():
    """Measure, print, and write JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--seeds', type=int, default=20, metavar='N', help='runs of each case; default: 20')
    parser.add_argument('--case', action='append', metavar='NAME', help='only this case; can be repeated')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    parser.add_argument('--markdown', action='store_true', help='print the table in Markdown')
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    for name in 'seeds', 'jobs':
        if getattr(arguments, name) < 1:
            parser.error('--%s: %d: expected an integer above 0' % (name, getattr(arguments, name)))
    for name in arguments.case or ():
        if name not in CASES:
            parser.error(f"--case: {name}: expected one of {', '.join(CASES)}")
    wanted = set(arguments.case or CASES)
    wanted |= {CASES[name].unbiased for name in wanted}     # limits are relative to these
    with open(resources.path('config', 'turtlebot.yaml'), encoding='utf-8') as file:
        robot = read_robot(yaml.safe_load(file))
    rows = measure(robot, [name for name in CASES if name in wanted], arguments.seeds, arguments.jobs)
    report(rows, (markdown if arguments.markdown else table)(rows), arguments.json)


if __name__ == '__main__':
    main()
