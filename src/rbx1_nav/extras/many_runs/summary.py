"""Statistics of the end poses of simulated runs, as lines of text. The memory that they need hardly grows."""
from __future__ import annotations

from array import array
from math import atan2, degrees
from typing import NamedTuple

import numpy

from rbx1_nav.base.units import Array, rounded

HEADER = (f"{'method':6} {'':14}  {'x (m)':>17}  {'y (m)':>17}  {'heading (degrees)':>17}  {'from start (m)':>17}")
SHARE = 90      # percent of the runs whose error is at most the printed limit


class Spread:
    """Mean and standard deviation of rows of values, updated with blocks of rows (Chan, Golub and LeVeque, Updating
    formulae and a pairwise algorithm for computing sample variances, 1979). The mean of a million values differs from
    an exact mean by less than 1e-9 of their size."""

    def __init__(self, width: int) -> None:
        """width: number of values in a row."""
        self.count, self.mean, self.squares = 0, numpy.zeros(width), numpy.zeros(width)

    def add(self, *columns: Array) -> None:
        """Add rows, one or more, given as columns."""
        rows = numpy.transpose(columns)
        before, mean = self.count, rows.mean(axis=0)
        self.count += len(rows)
        apart = mean - self.mean
        self.mean += apart * len(rows) / self.count
        self.squares += ((rows - mean) ** 2).sum(axis=0) + apart ** 2 * before * len(rows) / self.count

    def texts(self) -> list[str]:
        """Return the mean and the standard deviation of each value as text."""
        return [f'{rounded(mean, 3):8.3f} +- {deviation:5.3f}'
                for mean, deviation in zip(self.mean, numpy.sqrt(self.squares / max(1, self.count - 1)))]


class Poses(NamedTuple):
    """The poses of one kind, and their distances (m) and angles (degrees) from their references."""

    position: Spread    # x, y, and the distance from the start, m
    error: Spread       # distance, angle
    # for circular means and for percentiles: 4 bytes a run, with a relative error of 6e-8
    headings: array[float]      # rad
    distances: array[float]

    def add(self, poses: Array, references: Array) -> None:
        """Add poses and their references, (n, 3)."""
        x, y, yaw = poses.T
        away_x, away_y, turned = (poses - references).T
        self.position.add(x, y, numpy.hypot(x, y))
        distances = numpy.hypot(away_x, away_y)
        self.error.add(distances, numpy.degrees(abs(wrapped(turned))))
        self.headings.extend(yaw)
        self.distances.extend(distances)

    def spread(self) -> str:
        """Return the spreads of x, y, the heading and the distance from the start."""
        headings = numpy.array(self.headings, dtype=float)
        center = atan2(numpy.sin(headings).sum(), numpy.cos(headings).sum())    # the circular mean
        around = numpy.degrees(wrapped(headings - center))
        x, y, distance = self.position.texts()
        deviation = around.std(ddof=min(1, len(around) - 1))
        heading = f'{rounded(degrees(center) + around.mean(), 2):8.2f} +- {deviation:5.2f}'
        return f'{x}  {y}  {heading}  {distance}'

    def errors(self) -> str:
        distances, (distance, angle) = numpy.array(self.distances, dtype=float), self.error.mean
        return (f'by {distance:.3f} m (median {numpy.median(distances):.3f}, {SHARE} % below '
                f'{numpy.percentile(distances, SHARE):.3f}) and {angle:.1f} degrees')


def wrapped(angles: Array) -> Array:
    """Return the equivalent angles between -pi and pi, rad."""
    return (angles + numpy.pi) % (2 * numpy.pi) - numpy.pi


class Summary:
    """The statistics of the runs of one method."""

    def __init__(self) -> None:
        self.count = 0          # runs
        self.poses: dict[str, Poses] = {}
        self.first_leg = 0.0, numpy.inf, -numpy.inf     # m: sum, lowest, highest

    def add(self, truths: Array, odometry: Array, estimates: Array | None, first_legs: Array) -> None:
        """Add the end poses of n runs, each (n, 3), and their true first legs (m), (n)."""
        for name, poses, references in (('truth', truths, numpy.zeros(3)), ('/odom', odometry, truths),
                                        ('/odom_ekf', estimates, truths)):
            if poses is not None:
                self.poses.setdefault(name, Poses(Spread(3), Spread(2), array('f'), array('f'))).add(poses, references)
        total, low, high = self.first_leg
        self.first_leg = total + first_legs.sum(), min(low, first_legs.min()), max(high, first_legs.max())
        self.count += len(truths)

    def lines(self, method: str) -> list[str]:
        """Return the lines below HEADER: the true end poses, and the end poses that the odometry and the estimate
        report; the distance and angle by which each of them is wrong; the first leg."""
        lines = [f'{name:14}  {poses.spread()}' for name, poses in self.poses.items()]
        lines += [f"{'misses its start' if name == 'truth' else f'{name} is wrong'} {poses.errors()}"
                  for name, poses in self.poses.items()]
        total, low, high = self.first_leg
        lines += [f'first leg {total / self.count:.3f} m ({low:.3f} to {high:.3f})']
        return [f"{'' if number else method:6} {line}" for number, line in enumerate(lines)]
