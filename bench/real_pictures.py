"""Pictures of real robots and of the prediction for a simulated floor; windows are chosen by their scores."""
from matplotlib.figure import Figure
import numpy

from rbx1_nav.extras.fitting.comparison import simulate_paths
from rbx1_nav.extras.fitting.prediction import Prediction
from rbx1_nav.extras.fitting.recording import relative
from rbx1_nav.extras.many_runs.plots import PATHS, SIMULATED, TRUTH, draw_regions, save

QUARTILES = (0.25, 'first quartile'), (0.5, 'median'), (0.75, 'third quartile')
HALF = 0.32     # m, half the size of a panel with end poses: the largest region fits


def ranked(judgement, robot, part):
    """The index of the window at a quantile of a Run, sorted by score, the best predicted window first."""
    own = [index for index, (run, _) in enumerate(judgement.windows) if run is robot]
    return sorted(own, key=lambda index: judgement.scores[index])[int(part * len(own))]


def robots(judgement):
    """The Runs that have windows."""
    return list(dict.fromkeys(run for run, _ in judgement.windows))


def draw_paths(file, title, judgement, surface, ideal):
    """For each robot, the paths of the window with the median score. Raises OSError."""
    figure = Figure(figsize=(13.5, 8.6), constrained_layout=True)
    figure.suptitle(title)
    *panels, legend = figure.subplots(2, 3).ravel()
    for axes, robot in zip(panels, robots(judgement)):
        run, window = judgement.windows[ranked(judgement, robot, 0.5)]
        on_floor, exact = (Prediction(each, run.steps(each), window) for each in (surface, ideal))
        paths = simulate_paths(surface, on_floor, 0, PATHS, numpy.random.default_rng(1))
        times, truth = run.times[window.first[0]:][:window.length + 1], run.recording.truth
        poses = numpy.array([numpy.interp(times, truth.time, values) for values in truth[1:]])
        for path in paths:
            simulated, = axes.plot(*path[:2], color=SIMULATED, linewidth=0.8, alpha=0.6)
        ends, = axes.plot(*paths[:, :2, -1].T, 'o', color=SIMULATED, markersize=4)
        real, = axes.plot(*relative(poses[:, 0], poses)[:2], color=TRUTH, linewidth=2.5)
        commanded, = axes.plot(exact.path[0][0], exact.path[1][0], '--', color='black', linewidth=1)
        real_end, = axes.plot(*window.ends[0, :2], 's', color='black', markerfacecolor='white', zorder=5)
        start, = axes.plot(0, 0, '+', color='black', markersize=14)
        axes.set(xlabel='x (m)', ylabel='y (m)')
        axes.set_title(run.recording.name, fontsize='medium')
        axes.set_aspect('equal', adjustable='datalim')
        axes.grid(True, alpha=0.5)
    legend.axis('off')
    legend.legend([start, real, real_end, simulated, ends, commanded], [
        'start', 'real robot', 'its end pose', '%d simulated robots' % PATHS, 'their end poses',
        'commands, followed exactly'], loc='center', frameon=False)
    save(figure, file)


def draw_ends(file, title, judgement):
    """For each robot, the windows at the quartiles of its scores: simulated end poses, their regions, and the real end
    pose. Raises OSError."""
    found = robots(judgement)
    figure = Figure(figsize=(2.7 * len(found), 8.6))
    figure.suptitle(title)
    panels = figure.subplots(len(QUARTILES), len(found), squeeze=False, gridspec_kw=dict(wspace=0.3))
    for row, (part, name) in zip(panels, QUARTILES):
        row[0].set_ylabel(f'score: {name}\n\ny (m)')
        for axes, robot in zip(row, found):
            index = ranked(judgement, robot, part)
            ends = judgement.ends[index][:, :2]
            draw_regions(axes, ends, label=True)
            axes.plot(*judgement.windows[index][1].ends[0, :2], 's', color='black', markerfacecolor='white', zorder=5,
                      label='real end pose')
            x, y = ends.mean(axis=0)
            axes.set(aspect='equal', xlim=(x - HALF, x + HALF), ylim=(y - HALF, y + HALF))
            axes.grid(True, alpha=0.5)
    for axes, robot in zip(panels[0], found):
        axes.set_title(robot.recording.name, fontsize='medium')
    for axes in panels[-1]:
        axes.set_xlabel('x (m)')
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc='lower center', ncol=4, frameon=False)
    save(figure, file)
