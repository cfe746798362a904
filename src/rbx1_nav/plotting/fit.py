"""Plots a fit: recorded and simulated paths with the same commands, and their end poses."""
from __future__ import annotations

from math import atan2, degrees
from typing import TYPE_CHECKING, Sequence

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.fitting.comparison import Comparison, shares
from rbx1_nav.fitting.ensemble import mahalanobis
from rbx1_nav.plotting.palette import ESTIMATE, ODOMETRY, TRUTH
from rbx1_nav.plotting.runs import save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIMULATED = ESTIMATE    # results of a model, as opposed to measurements
REGIONS = (0.9, 0.2), (0.5, 0.35)       # share of the simulated end poses, opacity
MARGIN = 0.08       # margin around all paths, as a fraction of their extent
POINTS = 150        # number of simulated end poses shown per run


def draw_fit(file: str, title: str, comparisons: Sequence[Comparison]) -> None:
    """Draw recorded paths, simulated paths and end poses of Comparisons side by side into a file. Raises OSError."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(15.5, 5.9), constrained_layout=True)
    figure.suptitle(title)
    recorded, simulated, ends = figure.subplots(1, 3)
    for number, each in enumerate(comparisons):
        if each.recorded is not None:
            recorded.plot(*each.recorded, color=TRUTH if each.is_truth else ODOMETRY, linewidth=1, alpha=0.7,
                          label=None if number else 'truth' if each.is_truth else 'odometry')
        if each.end is not None:
            for axes in (recorded, ends):
                axes.plot(*each.end[:2], 's', color='black', markerfacecolor='white', markersize=6, zorder=5,
                          label=None if number else 'end pose, measured')
        simulated.plot(*each.simulated, color=SIMULATED, linewidth=1, alpha=0.7, label=None if number else 'simulated')
        simulated.plot(*each.simulated[:, -1], 'o', color='black', markerfacecolor='white', markersize=5, zorder=5,
                       label=None if number else 'end pose, simulated')
        if not any(alike(each, other) for other in comparisons[:number]):
            draw_regions(ends, each.ends[:, :2], label=not number)
    set_extents(comparisons, recorded, simulated)
    count, inside_50, inside_90 = shares(comparisons)
    recorded.set_title('recorded', fontsize='medium')
    simulated.set_title('simulated on the fitted floor, same commands', fontsize='medium')
    ends.set_title(f'{count} measured end poses: {inside_50} inside 50 %, {inside_90} inside 90 %'
                   if count else 'simulated end poses', fontsize='medium')
    for axes in (recorded, simulated, ends):
        if axes is not ends:
            axes.plot(0, 0, marker='+', markersize=14, color='black', linestyle='', label='start')
        axes.set(xlabel='x (m)', ylabel='y (m)')
        axes.grid(True, alpha=0.5)
        axes.legend(loc='upper center', bbox_to_anchor=(0.5, -0.13), ncol=4, frameon=False, fontsize='small')
    ends.set_aspect('equal', adjustable='datalim')
    save(figure, file)


def alike(comparison: Comparison, other: Comparison) -> bool:
    """Return whether two runs have visibly equal regions, because they had the same commands."""
    return bool(mahalanobis(other.ends[:, :2], comparison.ends[:, :2].mean(axis=0)[None])[0] < 0.02)


def draw_regions(axes: Axes, points: Array, label: bool) -> None:
    """Draw simulated end positions, (n, 2), and the regions that contain shares of them. label: whether to add them to
    the legend."""
    from matplotlib.patches import Ellipse
    axes.plot(*points[:POINTS].T, '.', color=SIMULATED, markersize=4, alpha=0.6, zorder=1, markeredgewidth=0,
              label='simulated' if label else None)
    covariance = numpy.cov(points.T)
    sizes, directions = numpy.linalg.eigh(covariance)
    angle = degrees(atan2(directions[1, 1], directions[0, 1]))
    distances = mahalanobis(points, points)
    for part, alpha in REGIONS:
        axis = 2 * (numpy.quantile(distances, part) * sizes.clip(0)) ** 0.5
        axes.add_patch(Ellipse(points.mean(axis=0), axis[1], axis[0], angle=angle, facecolor=SIMULATED,
                               edgecolor='black', linewidth=0.8, alpha=alpha,
                               label=f'{100 * part:.0f} %' if label else None))


def set_extents(comparisons: Sequence[Comparison], *panels: Axes) -> None:
    """Show the same part of the floor, which contains all paths, in all panels."""
    points = numpy.concatenate([path for each in comparisons for path in (each.recorded, each.simulated)
                                if path is not None] + [numpy.zeros((2, 1))], axis=1)
    low, high = points.min(axis=1), points.max(axis=1)
    half = max(0.1, (high - low).max() * (0.5 + MARGIN))
    x, y = (low + high) / 2
    for axes in panels:
        axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect='equal')
