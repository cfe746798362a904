"""Statistics of the end poses of simulated runs, as lines of text. The memory that they need hardly grows."""
from __future__ import annotations

from array import array
from math import atan2, degrees, hypot
from typing import NamedTuple

import numpy

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.base.units import rounded, wrap_angle

HEADER = (f"{'method':6} {'':14}  {'x (m)':>17}  {'y (m)':>17}  {'heading (degrees)':>17}  {'from start (m)':>17}")
SHARE = 90      # percent of the runs whose error is at most the printed limit


class Spread:
    """Mean and standard deviation of rows of values, updated with each row (Welford, Note on a method for calculating
    corrected sums of squares and products, 1962). The mean of a million values differs from an exact mean by less than
    1e-9 of their size."""

    def __init__(self, width: int) -> None:
        """width: number of values in a row."""
        self.count, self.mean, self.squares = 0, numpy.zeros(width), numpy.zeros(width)

    def add(self, *row: float) -> None:
        """Add a row."""
        self.count += 1
        before = row - self.mean
        self.mean += before / self.count
        self.squares += before * (row - self.mean)

    def texts(self) -> list[str]:
        """Return the mean and the standard deviation of each value as text."""
        return [f'{rounded(mean, 3):8.3f} +- {deviation:5.3f}'
                for mean, deviation in zip(self.mean, numpy.sqrt(self.squares / self.count))]


class Poses(NamedTuple):
    """The poses of one kind, and their distances (m) and angles (degrees) from their references."""

    position: Spread    # x, y, and the distance from the start, m
    error: Spread       # distance, angle
    # for circular means and for percentiles: 4 bytes a run, with a relative error of 6e-8
    headings: array[float]      # rad
    distances: array[float]

    def add(self, pose: Pose, reference: Pose) -> None:
        """Add a pose and its reference."""
        self.position.add(pose.x, pose.y, hypot(pose.x, pose.y))
        distance = hypot(pose.x - reference.x, pose.y - reference.y)
        self.error.add(distance, abs(degrees(wrap_angle(pose.yaw - reference.yaw))))
        self.headings.append(pose.yaw)
        self.distances.append(distance)

    def spread(self) -> str:
        """Return the spreads of x, y, the heading and the distance from the start."""
        headings = numpy.array(self.headings, dtype=float)
        center = atan2(numpy.sin(headings).sum(), numpy.cos(headings).sum())    # the circular mean
        around = numpy.degrees((headings - center + numpy.pi) % (2 * numpy.pi) - numpy.pi)
        x, y, distance = self.position.texts()
        heading = f'{rounded(degrees(center) + around.mean(), 2):8.2f} +- {around.std():5.2f}'
        return f'{x}  {y}  {heading}  {distance}'

    def errors(self) -> str:
        distances, (distance, angle) = numpy.array(self.distances, dtype=float), self.error.mean
        return (f'by {distance:.3f} m (median {numpy.median(distances):.3f}, {SHARE} % below '
                f'{numpy.percentile(distances, SHARE):.3f}) and {angle:.1f} degrees')


class Summary:
    """The statistics of the runs of one method."""

    def __init__(self) -> None:
        self.count = 0          # runs
        self.poses: dict[str, Poses] = {}
        self.first_leg = 0.0, numpy.inf, -numpy.inf     # m: sum, lowest, highest

    def add(self, truth: Pose, odometry: Pose, estimate: Pose | None, first_leg: float) -> None:
        """Add the end poses of a run, and its true first leg (m)."""
        for name, pose, reference in (('truth', truth, ORIGIN), ('/odom', odometry, truth),
                                      ('/odom_ekf', estimate, truth)):
            if pose:
                self.poses.setdefault(name, Poses(Spread(3), Spread(2), array('f'), array('f'))).add(pose, reference)
        total, low, high = self.first_leg
        self.first_leg = total + first_leg, min(low, first_leg), max(high, first_leg)
        self.count += 1

    def lines(self, method: str) -> list[str]:
        """Return the lines below HEADER: the true end poses, and the end poses that the odometry and the estimate
        report; the distance and angle by which each of them is wrong; the first leg."""
        lines = [f'{name:14}  {poses.spread()}' for name, poses in self.poses.items()]
        lines += [f"{'misses its start' if name == 'truth' else f'{name} is wrong'} {poses.errors()}"
                  for name, poses in self.poses.items()]
        total, low, high = self.first_leg
        lines += [f'first leg {total / self.count:.3f} m ({low:.3f} to {high:.3f})']
        return [f"{'' if number else method:6} {line}" for number, line in enumerate(lines)]
