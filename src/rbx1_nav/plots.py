"""Pictures of simulated runs, with matplotlib."""
from math import cos, sin
import os

from matplotlib.figure import Figure
import numpy

from rbx1_nav.config import ConfigError

PATHS = 20      # paths in a picture; more would hide each other
TITLES = {'timed': 'by time', 'odom': 'by odometry', 'ekf': 'by odometry and gyro'}


def check_picture(path):
    """Try whether a picture can be written to this path. Raises ConfigError."""
    formats = sorted(set(Figure().canvas.get_supported_filetypes()) - {'pgf'})      # that one needs LaTeX
    if os.path.splitext(path)[1][1:].lower() not in formats:
        raise ConfigError('expected a name that ends in one of .%s' % ', .'.join(formats))
    if not os.path.isdir(os.path.dirname(os.path.abspath(path))):
        raise ConfigError('expected a folder that exists')
    new = not os.path.lexists(path)
    try:
        open(path, 'ab').close()        # the permissions alone do not say all
        if new:
            os.remove(path)
    except OSError as error:
        raise ConfigError('expected a file that can be written: %s' % error.strerror)


def draw(file, surface, results):
    """A picture: for each method a column, above the ways to scale, below the end poses from near by."""
    figure = Figure(figsize=(5.6 * len(results), 9), constrained_layout=True)
    panels = figure.subplots(2, len(results), squeeze=False)
    number = len(next(iter(results.values())))
    figure.suptitle('Out and back on %s, %d %s' % (surface, number, 'run' if number == 1 else 'runs'))
    for (above, below), (method, runs) in zip(panels.T, results.items()):
        poses = numpy.array([r.end.truth for r in runs])
        x, y = poses[:, 0], poses[:, 1]
        yaw = numpy.degrees(numpy.angle(numpy.exp(1j * poses[:, 2])))
        draw_paths(above, [r.path for r in runs if r.path])
        draw_arrow(above, (0.0, 0.0, 0.0), 'black')
        draw_arrow(above, runs[0].end.truth, 'firebrick')
        above.set_title('%s: %.1f cm from the start, %.1f degrees off' % (
            TITLES[method], 100 * numpy.hypot(x, y).mean(), abs(yaw).mean()))
        few = number <= 500
        points = below.scatter(x, y, c=yaw, s=12 if few else 3, alpha=0.8 if few else 0.4, linewidths=0)
        figure.colorbar(points, ax=below, format='%.4g').solids.set(alpha=1)
        # square, around them all, and never so near that rounding shows
        half = max(0.005, 0.6 * numpy.ptp(x), 0.6 * numpy.ptp(y))
        below.set(title='where they end; colour: heading (degrees)', xlabel='x (m)', ylabel='y (m)', aspect='equal',
                  xlim=((x.min() + x.max()) / 2 - half, (x.min() + x.max()) / 2 + half),
                  ylim=((y.min() + y.max()) / 2 - half, (y.min() + y.max()) / 2 + half))
        below.grid(True, alpha=0.5)
    figure.savefig(file, dpi=90, bbox_inches='tight')


def draw_paths(axes, paths):
    """True ways, on a floor with a grid of 0.5 m as in RViz."""
    for path in paths:
        x, y, _ = zip(*[snapshot.truth for snapshot in path])
        axes.plot(x, y, color='tab:blue', linewidth=0.8, alpha=0.5)
    axes.set(xlabel='x (m)', ylabel='y (m)', aspect='equal', xlim=(-0.35, 1.25), ylim=(-0.45, 0.85),
             xticks=[0, 0.5, 1], yticks=[0, 0.5])
    axes.grid(True, alpha=0.5)


def draw_arrow(axes, pose, color):
    """The robot at a pose."""
    x, y, yaw = pose
    axes.plot(x, y, marker='o', color=color, zorder=4)
    axes.quiver(x, y, 0.2 * cos(yaw), 0.2 * sin(yaw), color=color, angles='xy', scale_units='xy', scale=1,
                width=0.012, zorder=4)
