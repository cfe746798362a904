"""Statistics of the end poses of simulated runs, as lines of text. The memory that they need hardly grows."""
from __future__ import annotations

from array import array
from math import atan2, cos, degrees, hypot, inf, sin, sqrt
from typing import Iterable

import numpy

from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.simulation.exercise import SimulationResult
from rbx1_nav.units import rounded, wrap_angle

HEADER = (f"{'method':6} {'':14}  {'x (m)':>17}  {'y (m)':>17}  {'heading (degrees)':>17}  {'from start (m)':>17}")
SHARE = 90      # percent of the runs whose error is at most the printed limit
FIRST = 1000    # runs whose mean heading is the center of the interval in which all headings are counted


class Spread:
    """Mean, standard deviation, minimum and maximum of values, updated with each value (Welford, Note on a method for
    calculating corrected sums of squares and products, 1962). The mean of a million values differs from an exact mean
    by less than 1e-9 of their size."""

    def __init__(self) -> None:
        self.count, self.mean, self.squares, self.low, self.high = 0, 0.0, 0.0, inf, -inf

    def add(self, value: float) -> None:
        """Add a value."""
        self.count += 1
        before = value - self.mean
        self.mean += before / self.count
        self.squares += before * (value - self.mean)
        self.low, self.high = min(self.low, value), max(self.high, value)

    def deviation(self) -> float:
        """Return the standard deviation."""
        return sqrt(self.squares / self.count)

    def __str__(self) -> str:
        return f'{rounded(self.mean, 3):8.3f} +- {self.deviation():5.3f}'


class AngleSpread:
    """Circular mean and standard deviation of angles (rad). Each angle counts with the value that is closest to the
    circular mean of the first FIRST angles."""

    def __init__(self) -> None:
        self.first: list[float] = []
        self.center: float | None = None
        self.around = Spread()      # degrees

    def add(self, angle: float) -> None:
        """Add an angle."""
        if self.center is not None:
            self.around.add(degrees(wrap_angle(angle - self.center)))
            return
        self.first.append(angle)
        if len(self.first) == FIRST:
            self._choose_center()

    def _choose_center(self) -> None:
        self.center = atan2(sum(map(sin, self.first)), sum(map(cos, self.first)))
        for angle in self.first:
            self.add(angle)
        self.first.clear()

    def __str__(self) -> str:
        if self.center is None:
            self._choose_center()
        assert self.center is not None
        return f'{rounded(degrees(self.center) + self.around.mean, 2):8.2f} +- {self.around.deviation():5.2f}'


class PoseSpread:
    """Spreads of x, y, the heading and the distance from the start."""

    def __init__(self) -> None:
        self.x, self.y, self.heading, self.distance = Spread(), Spread(), AngleSpread(), Spread()

    def add(self, pose: Pose) -> None:
        """Add a pose."""
        self.x.add(pose.x)
        self.y.add(pose.y)
        self.heading.add(pose.yaw)
        self.distance.add(hypot(pose.x, pose.y))

    def __str__(self) -> str:
        return f'{self.x}  {self.y}  {self.heading}  {self.distance}'


class ErrorSpread:
    """Distances between poses and their references, and differences of their headings."""

    def __init__(self) -> None:
        self.distance, self.angle = Spread(), Spread()
        self.distances = array('f')     # for the percentiles: 4 bytes a run, with a relative error of 6e-8

    def add(self, pose: Pose, reference: Pose) -> None:
        """Add a pose and its reference."""
        distance = hypot(pose.x - reference.x, pose.y - reference.y)
        self.distance.add(distance)
        self.distances.append(distance)
        self.angle.add(abs(degrees(wrap_angle(pose.yaw - reference.yaw))))

    def __str__(self) -> str:
        distances = numpy.array(self.distances, dtype=float)
        return (f'by {self.distance.mean:.3f} m (median {numpy.median(distances):.3f}, {SHARE} % below '
                f'{numpy.percentile(distances, SHARE):.3f}) and {self.angle.mean:.1f} degrees')


class Summary:
    """The statistics of the runs of one method."""

    def __init__(self) -> None:
        self.poses: dict[str, PoseSpread] = {}
        self.errors: dict[str, ErrorSpread] = {}
        self.first_leg = Spread()

    def add(self, truth: Pose, odometry: Pose, estimate: Pose | None, first_leg: float) -> None:
        """Add the end poses of a run, and its true first leg (m)."""
        for name, pose, reference in (('truth', truth, ORIGIN), ('/odom', odometry, truth),
                                      ('/odom_ekf', estimate, truth)):
            if pose:
                self.poses.setdefault(name, PoseSpread()).add(pose)
                self.errors.setdefault(name, ErrorSpread()).add(pose, reference)
        self.first_leg.add(first_leg)

    def lines(self, method: str) -> list[str]:
        """Return the lines below HEADER: the true end poses, and the end poses that the odometry and the estimate
        report; the distance and angle by which each of them is wrong; the first leg."""
        lines = [f'{name:14}  {spread}' for name, spread in self.poses.items()]
        lines += [f"{'misses its start' if name == 'truth' else f'{name} is wrong'} {errors}"
                  for name, errors in self.errors.items()]
        leg = self.first_leg
        lines += [f'first leg {leg.mean:.3f} m ({leg.low:.3f} to {leg.high:.3f})']
        return [f"{'' if number else method:6} {line}" for number, line in enumerate(lines)]


def summary(method: str, results: Iterable[SimulationResult]) -> list[str]:
    """Return Summary.lines() for results of a method."""
    found = Summary()
    for result in results:
        end = result.end
        found.add(end.truth, end.odometry, end.estimate, result.first_leg)
    return found.lines(method)
