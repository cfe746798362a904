#!/usr/bin/env python3
"""Send random messages to the filter, and check each covariance that it would publish. See README.md."""
import argparse
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from functools import partial
import json
import math
import random
import sys

import numpy

from rbx1_nav.base.kinematics import Pose, arc
from rbx1_nav.base.readings import MIN_VARIANCE
from rbx1_nav.base.surfaces import known_surfaces, load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.inputs import MAX_VARIANCE, Imu, Odom, RejectedMessage
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors
from rbx1_nav.node import resources

LEAST_RATIO = -1e-12    # smallest eigenvalue / largest one
LONG = 100      # steps after which a filter counts as long-running
START = 1000 * SECOND   # ns, of the first message
WARNINGS = (('dropouts', 'has timed out'), ('recoveries', 'has recovered'), ('restarts', 'restarting'),
            ('outliers', ': ignored'), ('contradictions', 'one of them is wrong'),
            ('slips', 'the wheels slip'))


def log_uniform(rng, low, high):
    """A random number whose logarithm is uniform."""
    return min(max(math.exp(rng.uniform(math.log(low), math.log(high))), low), high)


class Robot:
    """A robot at random speeds, and the messages that its sensors send, with random faults."""

    def __init__(self, rng):
        self.rng = rng
        self.now = START
        self.pose = Pose(0.0, 0.0, 0.0)
        self.speeds = 0.0, 0.0              # m/s, rad/s
        self.period = log_uniform(rng, 0.01, 0.3)       # s
        self.rate = log_uniform(rng, 1e-3, 0.05)        # probability of each fault per tick
        self.gaps = rng.random() < 0.7
        self.jumps = rng.random() < 0.5
        # half of the gyros always report a constant variance, the others arbitrary ones
        self.variance = self._variance() if rng.random() < 0.5 else None
        self.lags = [rng.choice([0.0, 0.0, 0.0, log_uniform(rng, 1e-3, 3.0)]) for _ in range(2)]   # s, odom and imu
        self.slip, self.bias = rng.gauss(0, 0.1), rng.gauss(0, 0.02)
        self.sensitivity = rng.choice([1.0] * 8 + [-1.0, 0.0])      # of the gyro: some are upside down, or broken
        self.silent = [0, 0]                # ns until which odom and imu are silent
        self.outlier = None                 # a Pose to report once

    def _variance(self):
        return log_uniform(self.rng, MIN_VARIANCE, MAX_VARIANCE)

    def _fault(self):
        return self.rng.random() < self.rate

    def tick(self):
        """The messages of a tick: [(ns of arrival, message)]; a message is an Imu or an Odom."""
        rng = self.rng
        elapsed, gap = self.period, self.gaps and self._fault()
        if gap:
            elapsed += log_uniform(rng, 0.1, 1e7)
        if rng.random() < 0.05:
            self.speeds = rng.choice([0.0, 0.0, 0.3, -0.3, 1.0]), rng.choice([0.0, 0.0, rng.gauss(0, 1.0)])
        self.now += round(elapsed * SECOND)
        # limited within a gap, so that no sum of gaps leaves the range of accepted positions
        moving = min(elapsed, 10.0)
        turned = self.speeds[1] * moving
        self.pose = arc(self.pose, self.speeds[0] * moving, turned / (1 - self.slip))
        if self.jumps and self._fault():
            self._jump()
        for sensor in 0, 1:
            if self._fault():
                self.silent[sensor] = self.now + round(log_uniform(rng, 1.0, 20.0) * SECOND)
        return ([] if self.now < self.silent[0] else self._send(0, self._odom())) + (
            [] if self.now < self.silent[1] else self._send(1, self._imu(turned / elapsed)))

    def _jump(self):
        rng = self.rng
        there = Pose(*(value + rng.choice([-1, 1]) * log_uniform(rng, 0.01, 1e4) for value in self.pose))
        # most are single outliers: _odom() reports them once
        if rng.random() < 0.2:
            self.pose = there
        else:
            self.outlier = there

    def _odom(self):
        pose, self.outlier = self.outlier or self.pose, None
        x, y, yaw = pose
        return Odom(self.now, Pose(x, y, yaw + self.rng.gauss(0, 0.003)))

    def _imu(self, rate):
        variance = self.variance or self._variance()
        noise = self.rng.gauss(0, min(math.sqrt(variance), 0.05))
        return Imu(self.now, rate * self.sensitivity + self.bias + noise, variance)

    def _send(self, sensor, message):
        """Drop, duplicate or delay it."""
        rng, lag = self.rng, self.lags[sensor]
        if self._fault():
            return []
        if self._fault():
            lag += log_uniform(rng, 1e-3, 20.0)
        arrival = self.now + round(lag * SECOND)
        return [(arrival, message)] * (2 if self._fault() else 1)


def make_messages(rng, count):
    """At least `count` messages of a Robot in order of arrival, some of them swapped."""
    robot, messages = Robot(rng), []
    while len(messages) < count:
        messages += robot.tick()
    messages.sort(key=lambda each: each[0])
    for number in range(1, len(messages)):
        if rng.random() < robot.rate:
            (before, one), (after, other) = messages[number - 1:number + 1]
            messages[number - 1:number + 1] = (before, other), (after, one)
    return messages


def judge(poses, covariances):
    """(minimum of smallest / largest eigenvalue, number of the first bad estimate or None, what is bad).

    poses: n x 3; covariances: n x 3 x 3.
    """
    finite = numpy.isfinite(poses).all(axis=1) & numpy.isfinite(covariances).all(axis=(1, 2))
    symmetric = (covariances == covariances.transpose(0, 2, 1)).all(axis=(1, 2))
    values = numpy.linalg.eigvalsh(numpy.where(finite[:, None, None], covariances, numpy.eye(3)))
    positive = values[:, 2] > 0
    ratios = values[:, 0] / numpy.where(positive, values[:, 2], 1.0)
    checks = (('not finite', finite), ('not symmetric', symmetric), ('no eigenvalue above 0', positive),
              ('a negative eigenvalue', ratios >= LEAST_RATIO))
    bad = [(int(numpy.argmin(good)), text) for text, good in checks if not good.all()]
    return float(ratios.min()), *(min(bad) if bad else (None, ''))


def run(floors, count, seed):
    """Run one sequence; returns a dict of counts, the worst ratio, and `failure`, a text ('' if there is none)."""
    rng = random.Random(seed)
    floor = rng.choice(sorted(floors))
    clock = [0]     # ns, of a computer on which simulated time runs at a different rate
    factor = rng.choice([None, 1.0, log_uniform(rng, 0.1, 30.0)])
    counts = Counter(sequences=1)

    def warn(text):
        counts.update(name for name, part in WARNINGS if part in text)
    combined = CombinedOdometry(floors[floor], round(rng.choice([1.0, 1.0, log_uniform(rng, 0.1, 10.0)]) * SECOND),
                                rng.random() < 0.95, warn, factor and (lambda: clock[0]))
    estimate = ekf = None
    poses, covariances, numbers, steps = [], [], [], 0
    failure = ''
    for number, (now, message) in enumerate(make_messages(rng, count)):
        clock[0] = round((now - START) / (factor or 1.0))
        counts['messages'] += 1
        try:
            if isinstance(message, Imu):
                combined.add_imu(now, message)
            else:
                combined.add_odom(now, message)
        except RejectedMessage:
            counts['rejected'] += 1
        except Exception as error:
            failure = 'message %d: %s: %s' % (number, type(error).__name__, error)
            break
        if combined.estimate is not None and combined.estimate is not estimate:
            steps = steps + 1 if combined.filter is ekf else 1
            estimate, ekf = combined.estimate, combined.filter
            poses.append(estimate.pose)
            covariances.append(estimate.covariance)
            numbers.append(number)
            counts['late estimates'] += steps > LONG
            counts['longest'] = max(counts['longest'], steps)
    counts['estimates'] = len(poses)
    ratio, at, what = judge(numpy.array(poses), numpy.array(covariances)) if poses else (math.inf, None, '')
    if at is not None:
        failure = 'message %d: %s\n%s' % (numbers[at], what, covariances[at])
    return dict(seed=seed, floor=floor, counts=dict(counts), ratio=ratio, failure=failure)


def summary(results):
    """The sums of the counts, the worst ratio, and the shares that show whether the filter was really exercised."""
    counts = sum((Counter(result['counts']) for result in results), Counter())
    counts['longest'] = max(result['counts'].get('longest', 0) for result in results)
    worst = min(results, key=lambda result: result['ratio'])
    return dict(counts=dict(counts), worst_ratio=worst['ratio'], worst_seed=worst['seed'],
                accepted=1 - counts['rejected'] / counts['messages'],
                late=counts['late estimates'] / max(1, counts['estimates']))


def main():
    """Run, print, and write JSON. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--sequences', type=int, default=2000, metavar='N', help='default: 2000')
    parser.add_argument('--messages', type=int, default=1000, metavar='N', help='messages per sequence; default: 1000')
    parser.add_argument('--seed', type=int, default=0, help='seed of the first sequence; default: 0')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    parser.add_argument('--json', metavar='FILE')
    arguments = parser.parse_args()
    for name in 'sequences', 'messages', 'jobs':
        if getattr(arguments, name) < 1:
            parser.error('--%s: %d: expected an integer above 0' % (name, getattr(arguments, name)))
    folder = resources.surfaces()
    floors = {**{name: priors(load_surface(name, folder)) for name in known_surfaces(folder)}, 'unknown': UNKNOWN_FLOOR}
    seeds = range(arguments.seed, arguments.seed + arguments.sequences)
    with ProcessPoolExecutor(arguments.jobs) if arguments.jobs > 1 else nullcontext() as pool:
        work = partial(run, floors, arguments.messages)
        results = list(pool.map(work, seeds, chunksize=10) if pool else map(work, seeds))
    sums = summary(results)
    print(', '.join('%d %s' % (sums['counts'].get(name, 0), name) for name in (
        'sequences', 'messages', 'rejected', 'estimates', *(name for name, _ in WARNINGS))))
    print('accepted messages: %.1f %%; estimates of a filter that has run for more than %d steps: %.1f %%; longest: %d '
          'steps' % (100 * sums['accepted'], LONG, 100 * sums['late'], sums['counts']['longest']))
    print('smallest eigenvalue / largest: at least %.3g (seed %d)' % (sums['worst_ratio'], sums['worst_seed']))
    failures = [result for result in results if result['failure']]
    for result in failures:
        print('--seed %d --sequences 1 --messages %d: %s: %s'
              % (result['seed'], arguments.messages, result['floor'], result['failure']))
    print(f'{len(failures)} of {len(results)} sequences failed')
    if arguments.json:
        with open(arguments.json, 'w', encoding='utf-8') as file:
            json.dump(dict(sums, messages=arguments.messages, failures=failures), file, indent=1)
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
