"""Animated pictures of simulated runs, side by side."""
from __future__ import annotations

import io
from math import cos, hypot, sin
import os
from typing import TYPE_CHECKING, List, Mapping

from PIL import Image
import numpy

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.plots import ESTIMATE, ODOMETRY, STYLES, TRUTH, Extent, widened
from rbx1_nav.extras.many_runs.simulated_run import SimulationResult, Snapshot
from rbx1_nav.node.config import ConfigError
from rbx1_nav.node.files import check_writable, write_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FORMATS = {'.gif': 'GIF', '.png': 'PNG'}    # by file name extension
SPEED = 4.0         # times real time
FRAME = 0.1         # s that a frame is shown
LAST_FRAME = 3.0    # s that the last frame is shown
RADIUS = 0.17       # m, of a TurtleBot
GRID = 0.5          # m


class Panel:
    """The floor under one robot."""

    def __init__(self, axes: Axes, method: str, path: List[Snapshot], extent: Extent) -> None:
        """path: the Snapshots of all ticks; extent: the limits of the floor."""
        self.method, self.path = method, path
        self.axes = axes
        from matplotlib.ticker import MultipleLocator
        axes.set(xlim=extent[:2], ylim=extent[2:], aspect='equal')
        for axis in axes.xaxis, axes.yaxis:
            axis.set_major_locator(MultipleLocator(GRID))
        axes.grid(True, alpha=0.5)
        axes.tick_params(labelbottom=False, labelleft=False, length=0)
        axes.plot(0, 0, marker='+', markersize=18, markeredgewidth=2, color='black')
        # the scale, along a line of the grid
        axes.annotate('', (GRID, -GRID), (0, -GRID), arrowprops=dict(arrowstyle='|-|', mutation_scale=4, shrinkA=0,
                                                                   shrinkB=0))
        axes.text(GRID / 2, -GRID - 0.03, f'{GRID} m', ha='center', va='top')
        self.trail, = axes.plot([], [], color=TRUTH, linewidth=1.5)
        self.robot, = axes.plot([], [], color=TRUTH, linewidth=2.5)
        # on top, so that it is also visible where the robot is
        color = ESTIMATE if METHODS[method].filtered else ODOMETRY
        self.believed, = axes.plot([], [], color=color, linestyle=STYLES[color], linewidth=1.8)

    def show(self, time: float) -> None:
        """Show the robot at a time (s), or at its end pose after the run."""
        driven = [snapshot for snapshot in self.path if snapshot.time <= time] or self.path[:1]
        last = driven[-1]
        self.trail.set_data([each.truth.x for each in driven], [each.truth.y for each in driven])
        self.robot.set_data(*outline(last.truth))
        self.believed.set_data(*outline(last.estimate or last.odometry))
        distance = f'{100 * hypot(last.truth.x, last.truth.y):.0f} cm from the start'
        self.axes.set_title(f'{METHODS[self.method].title}\n{distance if last is self.path[-1] else ""}')


def outline(pose: Pose) -> tuple[list[float], list[float]]:
    """Return the x and y (m) of the robot's outline: a circle, and a radius that points forward."""
    angles = [pose.yaw + 0.1 * step for step in range(63)] + [pose.yaw]
    return ([pose.x] + [pose.x + RADIUS * cos(angle) for angle in angles],
            [pose.y] + [pose.y + RADIUS * sin(angle) for angle in angles])


def check_animation(path: str) -> None:
    """Check that an animation can be written to this path. Raises ConfigError."""
    Image.init()
    formats = [extension for extension, name in FORMATS.items() if name in Image.SAVE_ALL]  # Pillow 7.0 lacks PNG
    if os.path.splitext(path)[1].lower() not in formats:
        raise ConfigError(f"expected a file name with the extension {' or '.join(formats)}")
    check_writable(path)


def animate(file: str, surface: str, results: Mapping[str, SimulationResult]) -> None:
    """Draw one run of each method, side by side, at SPEED times real time. Raises OSError.

    surface: name of the surface; results: one run of each method, with its path. The solid circle is the true pose of
    the robot. The dashed circle is the pose from the filter, or without a filter from the odometry.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    figure = Figure(figsize=(3.2 * len(results), 3.9))
    figure.subplots_adjust(left=0.01, right=0.99, bottom=0.1, top=0.8, wspace=0.04)
    figure.suptitle(f'Out and back on {surface}')
    shown = {'true pose': TRUTH}
    by_estimate = [METHODS[method].filtered for method in results]
    if not all(by_estimate):
        shown['odometry'] = ODOMETRY
    if any(by_estimate):
        shown['estimate from odometry and gyro'] = ESTIMATE
    figure.legend([Line2D([], [], color=color, linestyle=STYLES[color], linewidth=2) for color in shown.values()],
                  list(shown), loc='lower center', ncol=len(shown), frameon=False)
    canvas = FigureCanvasAgg(figure)
    extent = widened((-0.45, 1.45, -0.65, 1.05), results.values())
    panels = [Panel(axes, method, result.path or [], extent)
              for axes, (method, result) in zip(figure.subplots(1, len(results), squeeze=False)[0], results.items())]
    end = max(panel.path[-1].time for panel in panels)
    frames = []
    for number in range(int(end / (FRAME * SPEED)) + 2):
        for panel in panels:
            panel.show(number * FRAME * SPEED)
        canvas.draw()
        frames.append(Image.fromarray(numpy.asarray(canvas.buffer_rgba())[..., :3]))
    # one palette of few colors, without dithering (0), keeps the file small: a frame then has only what has changed
    palette = frames[-1].quantize(64, dither=0)
    frames = [frame.quantize(palette=palette, dither=0) for frame in frames]
    durations = [round(1000 * FRAME)] * (len(frames) - 1) + [round(1000 * LAST_FRAME)]
    animation = io.BytesIO()
    frames[0].save(animation, FORMATS[os.path.splitext(file)[1].lower()], save_all=True, append_images=frames[1:],
                   duration=durations, loop=0, optimize=True)
    write_file(file, animation.getvalue())
