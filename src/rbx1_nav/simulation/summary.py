"""Statistics of the end poses of simulated runs, as lines of text."""
from __future__ import annotations

from math import atan2, cos, degrees, hypot, sin
from typing import Sequence

import numpy

from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.simulation.exercise import SimulationResult
from rbx1_nav.units import rounded, wrap_angle

HEADER = (f"{'method':6} {'':14}  {'x (m)':>17}  {'y (m)':>17}  {'heading (degrees)':>17}  {'from start (m)':>17}")
SHARE = 90      # percent of the runs whose error is at most the printed limit


def summary(method: str, results: Sequence[SimulationResult]) -> list[str]:
    """Return the lines below HEADER for the results of a method: the true end poses, and the end poses that the
    odometry and the estimate report; the distance and angle by which each of them is wrong; the first leg."""
    truth = [r.end.truth for r in results]
    poses = {'truth': truth, '/odom': [r.end.odometry for r in results]}
    estimates = [r.end.estimate for r in results if r.end.estimate]
    if estimates:
        poses['/odom_ekf'] = estimates
    lines = [f'{name:14}  {spread_of_poses(each)}' for name, each in poses.items()]
    lines += [errors('misses its start', truth, [ORIGIN] * len(truth))]
    lines += [errors(f'{name} is wrong', poses[name], truth) for name in poses if name != 'truth']
    legs = [r.first_leg for r in results]
    lines += [f'first leg {numpy.mean(legs):.3f} m ({min(legs):.3f} to {max(legs):.3f})']
    return [f"{'' if number else method:6} {line}" for number, line in enumerate(lines)]


def errors(what: str, poses: Sequence[Pose], references: Sequence[Pose]) -> str:
    """Return the mean, the median and the limit for SHARE percent of the distances between poses and their references,
    and the mean absolute difference of their headings, as text."""
    distances = [hypot(a.x - b.x, a.y - b.y) for a, b in zip(poses, references)]
    angles = [abs(degrees(wrap_angle(a.yaw - b.yaw))) for a, b in zip(poses, references)]
    return (f'{what} by {numpy.mean(distances):.3f} m (median {numpy.median(distances):.3f}, {SHARE} % below '
            f'{numpy.percentile(distances, SHARE):.3f}) and {numpy.mean(angles):.1f} degrees')


def spread_of_poses(poses: Sequence[Pose]) -> str:
    """Return the means and the standard deviations of x, y, the heading and the distance from the start as text."""
    return (f'{spread([pose.x for pose in poses])}  {spread([pose.y for pose in poses])}  '
            f'{spread_of_angles([pose.yaw for pose in poses])}  {spread([hypot(pose.x, pose.y) for pose in poses])}')


def spread(values: Sequence[float]) -> str:
    """Return the mean and the standard deviation as text."""
    return f'{rounded(float(numpy.mean(values)), 3):8.3f} +- {numpy.std(values):5.3f}'


def spread_of_angles(angles: Sequence[float]) -> str:
    """Return the circular mean and the standard deviation of angles (rad) as text, in degrees."""
    mean = atan2(sum(map(sin, angles)), sum(map(cos, angles)))
    around = [degrees(wrap_angle(angle - mean)) for angle in angles]
    return f'{rounded(degrees(mean) + float(numpy.mean(around)), 2):8.2f} +- {numpy.std(around):5.2f}'
