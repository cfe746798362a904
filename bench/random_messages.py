#!/usr/bin/env python3
"""Send random messages to the filter, and check each covariance that it would publish. See README.md."""
import argparse
import math
import random
import sys

import numpy

from floors import UNKNOWN
import simulated
from rbx1_nav.base.covariances import MIN_VARIANCE
from rbx1_nav.base.kinematics import Pose, arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.input_checks import MAX_VARIANCE, Imu, Odom, RejectedMessage
from rbx1_nav.filter.priors import UNKNOWN_FLOOR, priors

LEAST_RATIO = -1e-12    # smallest eigenvalue / largest one
START = 1000 * SECOND   # ns, of the first message


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


def judge(pose, covariance):
    """(smallest / largest eigenvalue of a covariance, what is bad about an estimate, '' if nothing is)."""
    covariance = numpy.array(covariance)
    if not numpy.isfinite(pose).all() or not numpy.isfinite(covariance).all():
        return math.inf, 'not finite'
    values = numpy.linalg.eigvalsh(covariance)
    if values[-1] <= 0:
        return math.inf, 'no eigenvalue above 0'
    ratio = float(values[0] / values[-1])
    if (covariance != covariance.T).any():
        return ratio, 'not symmetric'
    return ratio, 'a negative eigenvalue' if ratio < LEAST_RATIO else ''


def run(task):
    """(seed, number of estimates, of messages and of rejected messages, the least ratio of judge(), what is bad) of one
    sequence. task: (seed, {floor: Priors}, number of messages)."""
    seed, floors, count = task
    rng = random.Random(seed)
    prior = floors[rng.choice(sorted(floors))]
    clock = [0]     # ns, of a computer on which simulated time runs at a different rate
    factor = rng.choice([None, 1.0, log_uniform(rng, 0.1, 30.0)])
    combined = CombinedOdometry(prior, round(rng.choice([1.0, 1.0, log_uniform(rng, 0.1, 10.0)]) * SECOND),
                                rng.random() < 0.95, clock=factor and (lambda: clock[0]))
    estimate, estimates, rejected, least = None, 0, 0, math.inf
    messages = make_messages(rng, count)
    for number, (now, message) in enumerate(messages):
        clock[0] = round((now - START) / (factor or 1.0))
        try:
            if isinstance(message, Imu):
                combined.add_imu(now, message)
            else:
                combined.add_odom(now, message)
        except RejectedMessage:
            rejected += 1
        except Exception as error:
            return seed, estimates, number, rejected, least, f'message {number}: {type(error).__name__}: {error}'
        if combined.estimate is not None and combined.estimate is not estimate:
            estimate = combined.estimate
            estimates += 1
            ratio, what = judge(estimate.pose, estimate.covariance)
            least = min(least, ratio)
            if what:
                return seed, estimates, number, rejected, least, f'message {number}: {what}\n{estimate.covariance}'
    return seed, estimates, len(messages), rejected, least, ''


def main():
    """Run and print. Returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--sequences', type=int, default=2000, metavar='N', help='default: 2000')
    parser.add_argument('--messages', type=int, default=1000, metavar='N', help='messages per sequence; default: 1000')
    parser.add_argument('--seed', type=int, default=0, help='seed of the first sequence; default: 0')
    parser.add_argument('--jobs', type=int, default=1, metavar='N', help='processes; default: 1')
    arguments = parser.parse_args()
    floors = {**{name: priors(surface) for name, surface in simulated.floors().items()}, UNKNOWN: UNKNOWN_FLOOR}
    tasks = [(arguments.seed + number, floors, arguments.messages) for number in range(arguments.sequences)]
    sums, leasts, failures = numpy.zeros(3, int), [], 0
    for seed, *counts, least, what in simulated.in_processes(arguments.jobs, run, tasks):
        sums += counts
        leasts.append((least, seed))
        if what:
            failures += 1
            print(f'--seed {seed} --sequences 1 --messages {arguments.messages}: {what}', flush=True)
    print('%d estimates from %d messages, of which the filter rejected %d' % tuple(sums))
    print('smallest eigenvalue / largest: at least %.3g (seed %d)' % min(leasts))
    print(f'{failures} of {len(tasks)} sequences failed')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
