"""Plots of simulated runs and of a fit, with matplotlib, and the colors of poses in all pictures.

Each function imports matplotlib when it draws: programs that draw only on request would take twice as long to start.

The colors are used in plots, animations, RViz (rviz/*.rviz) and the browser (web/style.css). Two of them differ in
luminance by a contrast of at least 1.5, and with simulated protanopia, deuteranopia and tritanopia (Machado et al.
2009) by at least 22 in CIELAB. On the backgrounds of all pictures, their contrast is at least 3.
"""
from __future__ import annotations

import io
import logging
from math import atan2, cos, degrees, sin
import os
from typing import TYPE_CHECKING, Iterable, Mapping, Sequence, Tuple

import numpy

from rbx1_nav.base.kinematics import ORIGIN, Pose
from rbx1_nav.base.units import Array, rounded
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.fitting.comparison import Comparison, mahalanobis, shares
from rbx1_nav.extras.many_runs.simulated_run import SimulationResult
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.files import check_writable, write_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

# matplotlib cannot save its list of fonts on a full disk; the error of the picture is enough
logging.getLogger('matplotlib.font_manager').setLevel(logging.ERROR)

# blue, red, green
TRUTH, ODOMETRY, ESTIMATE = '#1040b0', '#d01000', '#00a64d'
STYLES = {TRUTH: '-', ODOMETRY: '--', ESTIMATE: ':'}    # of their lines
ON_DARK = '#32a5ff', '#f21000', '#00f06e'       # the same on the dark backgrounds of RViz and the browser

PATHS = 20      # number of paths in a plot; more would hide each other
SHOWN = 5000    # number of end poses of each method in a plot; more would be a spot without structure

Extent = Tuple[float, float, float, float]    # xmin, xmax, ymin, ymax, m
SIMULATED = '#707070'   # gray: results of a model, as opposed to measurements
REGIONS = (0.9, 0.2), (0.5, 0.35)       # share of the simulated end poses, opacity
MARGIN = 0.08       # margin around all paths, as a fraction of their extent
POINTS = 150        # number of simulated end poses shown per run


def check_picture(path: str) -> None:
    """Check that a plot can be written to this path. Raises ConfigError."""
    from matplotlib.figure import Figure
    formats = sorted(set(Figure().canvas.get_supported_filetypes()) - {'pgf'})      # pgf needs LaTeX
    if os.path.splitext(path)[1][1:].lower() not in formats:
        raise ConfigError(f"expected a file name with one of the extensions .{', .'.join(formats)}")
    check_writable(path)


def draw(file: str, surface: str, results: Mapping[str, Sequence[SimulationResult]], seeds: range,
         truths: Mapping[str, Array]) -> None:
    """Draw a column for each method: above, true paths; below, the end poses of all runs, on one scale.

    surface: name of the surface; results: by method, at least those with a path; truths: true end poses (n, 3) of all
    runs by method, m and rad.
    """
    from matplotlib.figure import Figure
    figure = Figure(figsize=(5.6 * len(results), 9.4), constrained_layout=True)
    panels = figure.subplots(2, len(results), squeeze=False)
    runs = (f'1 run (seed {seeds[0]})' if len(seeds) == 1
            else f'{len(seeds)} runs (seeds {seeds[0]} to {seeds[-1]})')
    figure.suptitle(f'Out and back on {surface}, {runs}'
                    + (f'; the end poses of the first {SHOWN}' if len(seeds) > SHOWN else ''))
    ends = {method: with_heading_errors(truths[method]) for method in results}
    shown = [poses[:SHOWN] for poses in ends.values()]
    extent = square([poses[:, :2] for poses in shown], 0.05, 0.6)
    floor = widened((-0.35, 1.25, -0.45, 0.85), [each for kept in results.values() for each in kept])
    norm = common_norm(shown)
    for (above, below), method in zip(panels.T, results):
        draw_paths(above, results[method], floor)
        distances, errors = numpy.hypot(*ends[method].T[:2]), ends[method][:, 2]
        mean = 'mean ' if len(seeds) > 1 else ''
        above.set_title(f'{METHODS[method].title}: {mean}{100 * distances.mean():.1f} cm from the start, '
                        f'{errors.mean():.1f} degrees off', fontsize='medium')
        points = draw_ends(below, ends[method][:SHOWN], extent, norm)
    if norm:
        figure.colorbar(points, ax=list(panels[1]), label='heading error (degrees)').solids.set(alpha=1)
    save(figure, file)


def save(figure: Figure, path: str) -> None:
    """Write a Figure to a file, in the format given by its extension. Raises OSError."""
    # draw in memory, so that a full disk raises OSError and not an exception of a library that matplotlib uses
    picture = io.BytesIO()
    figure.savefig(picture, dpi=90, bbox_inches='tight', format=os.path.splitext(path)[1][1:].lower())
    write_file(path, picture.getvalue())


def with_heading_errors(poses: Array) -> Array:
    """Return poses (n, 3) with the absolute heading error (degrees) in place of the heading (rad)."""
    poses = poses.copy()
    poses[:, 2] = abs(numpy.degrees(numpy.angle(numpy.exp(1j * poses[:, 2]))))
    return poses


def square(parts: Sequence[Array], least: float, factor: float) -> Extent:
    """Return a square around the start and all points, (n, 2). Half of its width is at least `least` (m), and `factor`
    times the extent of the points."""
    points = numpy.vstack([numpy.zeros((1, 2)), *parts])
    low, high = points.min(axis=0), points.max(axis=0)
    half = max(least, factor * (high - low).max())
    x, y = (low + high) / 2
    return x - half, x + half, y - half, y + half


def widened(limits: Extent, results: Iterable[SimulationResult]) -> Extent:
    """Return limits that also show the true poses of all results, with a margin of 0.15 m."""
    x, y, _ = zip(*[each.truth for result in results for each in (*(result.path or ()), result.end)])
    left, right, bottom, top = limits
    return min(left, min(x) - 0.15), max(right, max(x) + 0.15), min(bottom, min(y) - 0.15), max(top, max(y) + 0.15)


def common_norm(ends: Iterable[Array]) -> Normalize | None:
    """Return the color scale of heading errors, from 0 to the largest; None if they are too small to distinguish."""
    from matplotlib.colors import Normalize
    largest = max(poses[:, 2].max() for poses in ends)
    return Normalize(0, largest) if largest > 1 else None


def draw_paths(axes: Axes, results: Sequence[SimulationResult], extent: Extent) -> None:
    """Draw the true paths that were kept on an extent of the floor, and the first run's start and end poses."""
    from matplotlib.ticker import MaxNLocator
    for result in results:
        if result.path:
            x, y, _ = zip(*[snapshot.truth for snapshot in result.path])
            axes.plot(x, y, color=TRUTH, linewidth=0.8, alpha=0.5)
    draw_robot(axes, ORIGIN, 'black', 'start')
    draw_robot(axes, results[0].end.truth, TRUTH, 'end pose of the first run')
    axes.set(xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=extent[:2], ylim=extent[2:])
    for axis in axes.xaxis, axes.yaxis:
        axis.set_major_locator(MaxNLocator(4, steps=[1, 5, 10]))
    axes.grid(True, alpha=0.5)
    axes.legend(loc='lower right')


def draw_robot(axes: Axes, pose: Pose, color: str, label: str) -> None:
    """Draw the robot at a pose: a dot, and an arrow of 0.2 m."""
    x, y, yaw = pose
    axes.plot(x, y, marker='o', linestyle='', color=color, zorder=4, label=label)
    axes.quiver(x, y, 0.2 * cos(yaw), 0.2 * sin(yaw), color=color, angles='xy', scale_units='xy', scale=1,
                width=0.012, zorder=4)


def draw_ends(axes: Axes, poses: Array, extent: Extent, norm: Normalize | None) -> PathCollection:
    """Draw end poses in an extent, with an inset if they occupy a small part of it. Returns the points, for a color
    bar."""
    x, y, error = poses.T
    few = len(x) <= 500
    style = dict(s=30 if len(x) < 100 else 12 if few else 3, alpha=0.8 if few else 0.4, linewidths=0)
    color = dict(c=error, norm=norm) if norm else dict(color=TRUTH)
    points = axes.scatter(x, y, **style, **color)
    axes.plot(0, 0, marker='+', markersize=14, color='black')
    size = max(numpy.ptp(x), numpy.ptp(y))
    end = f'({1000 * rounded(x.mean(), 4):.1f} mm, {1000 * rounded(y.mean(), 4):.1f} mm)'
    axes.set(title='end poses (+ start)' if size > 1e-4 else f'all end poses at {end}',
             xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=extent[:2], ylim=extent[2:])
    axes.grid(True, alpha=0.5)
    if 1e-4 < size < 0.1 * (extent[1] - extent[0]):
        inset = axes.inset_axes([0.55, 0.5, 0.42, 0.42])
        inset.scatter(100 * x, 100 * y, **style, **color)
        half = 60 * size
        inset.set(aspect='equal', xlim=(50 * (x.min() + x.max()) - half, 50 * (x.min() + x.max()) + half),
                  ylim=(50 * (y.min() + y.max()) - half, 50 * (y.min() + y.max()) + half))
        inset.set_title('enlarged (cm)', fontsize='small')
        inset.tick_params(labelsize='small')
    return points


def draw_fit(file: str, title: str, comparisons: Sequence[Comparison]) -> None:
    """Draw recorded paths, simulated paths and end poses of Comparisons side by side into a file. Raises OSError."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(15.5, 5.9), constrained_layout=True)
    figure.suptitle(title)
    recorded, simulated, ends = figure.subplots(1, 3)
    for number, each in enumerate(comparisons):
        if each.recorded is not None:
            color = TRUTH if each.is_truth else ODOMETRY
            recorded.plot(*each.recorded, color=color, linestyle=STYLES[color], linewidth=1, alpha=0.7,
                          label=None if number else 'truth' if each.is_truth else 'odometry')
        if each.end is not None:
            for axes in (recorded, simulated, ends):
                axes.plot(*each.end[:2], 's', color='black', markerfacecolor='white', markersize=6, zorder=5,
                          label=None if number else 'end pose, measured')
        for index, path in enumerate(each.simulated):
            simulated.plot(*path, color=SIMULATED, linewidth=0.8, alpha=0.5,
                           label=None if number or index else 'simulated')
        if not any(alike(each, other) for other in comparisons[:number]):
            draw_regions(ends, each.ends[:, :2], label=not number)
    extent = square([path.T for each in comparisons for path in (each.recorded, *each.simulated) if path is not None],
                    0.1, 0.5 + MARGIN)
    for axes in (recorded, simulated):      # the same part of the floor
        axes.set(xlim=extent[:2], ylim=extent[2:], aspect='equal')
        axes.plot(0, 0, marker='+', markersize=14, color='black', linestyle='', label='start')
    count, inside_50, inside_90 = shares(comparisons)
    recorded.set_title('recorded', fontsize='medium')
    simulated.set_title('simulated on the fitted floor, same commands', fontsize='medium')
    ends.set_title(f'{count} measured end poses: {inside_50} inside 50 %, {inside_90} inside 90 %'
                   if count else 'simulated end poses', fontsize='medium')
    for axes in (recorded, simulated, ends):
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
