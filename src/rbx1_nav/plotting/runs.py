"""Plots simulated runs, with matplotlib."""
from __future__ import annotations

import io
from math import cos, sin
import os
from typing import TYPE_CHECKING, Iterable, Mapping, Sequence, Tuple

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.config import ConfigError
from rbx1_nav.files import check_writable, write_file
from rbx1_nav.plotting.palette import TRUTH
from rbx1_nav.robot.kinematics import ORIGIN, Pose
from rbx1_nav.simulation.exercise import SimulationResult
from rbx1_nav.units import rounded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection
    from matplotlib.colors import Normalize
    from matplotlib.figure import Figure

PATHS = 20      # number of paths in a plot; more would hide each other
TITLES = {'timed': 'timed', 'odom': 'with odometry', 'ekf': 'with odometry and gyro'}

Extent = Tuple[float, float, float, float]    # xmin, xmax, ymin, ymax, m


def check_picture(path: str) -> None:
    """Check that a plot can be written to this path. Raises ConfigError."""
    from matplotlib.figure import Figure
    formats = sorted(set(Figure().canvas.get_supported_filetypes()) - {'pgf'})      # pgf needs LaTeX
    if os.path.splitext(path)[1][1:].lower() not in formats:
        raise ConfigError(f"expected a file name with one of the extensions .{', .'.join(formats)}")
    check_writable(path)


def draw(file: str, surface: str, results: Mapping[str, Sequence[SimulationResult]], seeds: range,
         truths: Mapping[str, Array] | None = None) -> None:
    """Draw a column for each method: above, true paths; below, the end poses of all runs, on one scale.

    surface: name of the surface; results: by method, at least those with a path; truths: true end poses (n, 3) of all
    runs by method, m and rad; None: those of the results.
    """
    from matplotlib.figure import Figure
    figure = Figure(figsize=(5.6 * len(results), 9.4), constrained_layout=True)
    panels = figure.subplots(2, len(results), squeeze=False)
    runs = (f'1 run (seed {seeds[0]})' if len(seeds) == 1
            else f'{len(seeds)} runs (seeds {seeds[0]} to {seeds[-1]})')
    figure.suptitle(f'Out and back on {surface}, {runs}')
    ends = {method: with_heading_errors(truths[method]) if truths else end_poses(each)
            for method, each in results.items()}
    extent, norm = common_extent(ends.values()), common_norm(ends.values())
    for (above, below), method in zip(panels.T, results):
        draw_paths(above, results[method])
        distances, errors = numpy.hypot(*ends[method].T[:2]), ends[method][:, 2]
        mean = 'mean ' if len(seeds) > 1 else ''
        above.set_title(f'{TITLES[method]}: {mean}{100 * distances.mean():.1f} cm from the start, '
                        f'{errors.mean():.1f} degrees off', fontsize='medium')
        points = draw_ends(below, ends[method], extent, norm)
    if norm:
        figure.colorbar(points, ax=list(panels[1]), label='heading error (degrees)').solids.set(alpha=1)
    save(figure, file)


def save(figure: Figure, path: str) -> None:
    """Write a Figure to a file, in the format given by its extension. Raises OSError."""
    # draw in memory, so that a full disk raises OSError and not an exception of a library that matplotlib uses
    picture = io.BytesIO()
    figure.savefig(picture, dpi=90, bbox_inches='tight', format=os.path.splitext(path)[1][1:].lower())
    write_file(path, picture.getvalue())


def end_poses(results: Iterable[SimulationResult]) -> Array:
    """Return an array with a row for each result: true x and y (m), and the absolute heading error (degrees)."""
    return with_heading_errors(numpy.array([result.end.truth for result in results]))


def with_heading_errors(poses: Array) -> Array:
    """Return poses (n, 3) with the absolute heading error (degrees) in place of the heading (rad)."""
    poses = poses.copy()
    poses[:, 2] = abs(numpy.degrees(numpy.angle(numpy.exp(1j * poses[:, 2]))))
    return poses


def common_extent(ends: Iterable[Array]) -> Extent:
    """Return a square around the start and all end poses; at least 10 cm wide."""
    points = numpy.vstack([poses[:, :2] for poses in ends] + [numpy.zeros((1, 2))])
    low, high = points.min(axis=0), points.max(axis=0)
    half = max(0.05, 0.6 * (high - low).max())
    (x, y) = (low + high) / 2
    return x - half, x + half, y - half, y + half


def common_norm(ends: Iterable[Array]) -> Normalize | None:
    """Return the color scale of heading errors, from 0 to the largest; None if they are too small to distinguish."""
    from matplotlib.colors import Normalize
    largest = max(poses[:, 2].max() for poses in ends)
    return Normalize(0, largest) if largest > 1 else None


def draw_paths(axes: Axes, results: Sequence[SimulationResult]) -> None:
    """Draw the true paths that were kept on a floor with a 0.5 m grid as in RViz, and the first run's start and end
    poses."""
    for result in results:
        if result.path:
            x, y, _ = zip(*[snapshot.truth for snapshot in result.path])
            axes.plot(x, y, color=TRUTH, linewidth=0.8, alpha=0.5)
    draw_robot(axes, ORIGIN, 'black', 'start')
    draw_robot(axes, results[0].end.truth, TRUTH, 'end pose of the first run')
    axes.set(xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=(-0.35, 1.25), ylim=(-0.45, 0.85),
             xticks=[0, 0.5, 1], yticks=[0, 0.5])
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
    style = dict(s=12 if few else 3, alpha=0.8 if few else 0.4, linewidths=0)
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
