"""Pictures of what real robots did, beside what a simulated floor predicts."""
import os

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Ellipse
import numpy

from rbx1_nav.fitting.ensemble import energy_score, inner_share, mahalanobis, simulate_ends, simulate_paths
from rbx1_nav.fitting.floor import Prediction
from rbx1_nav.fitting.recording import relative

# as in script/report.py; colours that colour-blind readers can tell apart
TRUTH, SIMULATED, IDEAL = '#0072b2', '#e69f00', '#777777'
PATHS = 20          # simulated, of each robot
ENDS = 500          # simulated, of each window
PATH_LENGTH = 40    # s
END_LENGTH = 20     # s
PARTS = 0.5, 0.9
DISTANCE = 1.0      # m: a window of the left panel in which the robot went less far is left out


class Ensemble:
    """A window of a run: where the robot went, and where simulated ones go."""

    def __init__(self, run, windows, index, predictions, surface, generator):
        """predictions: the Predictions on the Surface, and without errors."""
        first = windows.first[index]
        truth = run.recording.truth
        poses = [numpy.interp(run.times[first:first + windows.count + 1], truth.time, values) for values in truth[1:]]
        self.run = run
        self.true_path = relative([values[0] for values in poses], poses)
        self.end = windows.ends[index]
        self.ends = simulate_ends(surface, predictions[0], index, ENDS, generator)
        self.paths = simulate_paths(surface, predictions[0], index, PATHS, generator)
        self.ideal = [values[index] for values in predictions[1].path]
        self.inside = inner_share(self.ends[:, :2], self.end[:2])
        self.score = energy_score(self.ends[:, :2], self.end[:2])


def ensembles(runs, surface, ideal, length):
    """The Ensembles of all windows of a length (s)."""
    generator = numpy.random.default_rng(1)
    found = []
    for run in runs:
        windows = run.windows(length, length / 2)
        predictions = [Prediction(each, run.steps(each), windows) for each in (surface, ideal)]
        found += [Ensemble(run, windows, index, predictions, surface, generator)
                  for index in range(len(windows.first))]
    return found


def draw_all(folder, runs, surface, ideal):
    """Write real_paths.png and real_ends.png to a folder. Raises OSError."""
    save(draw_paths(runs, ensembles(runs, surface, ideal, PATH_LENGTH)), os.path.join(folder, 'real_paths.png'))
    save(draw_ends(ensembles(runs, surface, ideal, END_LENGTH)), os.path.join(folder, 'real_ends.png'))


def save(figure, path):
    """Write a picture."""
    figure.savefig(path, dpi=90)


def draw_paths(runs, windows):
    """For each robot the window that was predicted neither well nor badly: the median of its scores."""
    figure = Figure(figsize=(10.5, 7), constrained_layout=True)
    figure.suptitle('The same commands for %d s: real robots, and simulated ones' % PATH_LENGTH)
    panels = figure.subplots(2, 3).ravel()
    for axes, run in zip(panels, runs):
        own = sorted((each for each in windows if each.run is run), key=lambda each: each.score)
        draw_window(axes, own[len(own) // 2])
        axes.set_title('robot %s' % run.recording.name.rpartition('R')[2], fontsize='medium')
    panels[-1].axis('off')
    panels[-1].legend(handles=[
        Line2D([], [], color=TRUTH, linewidth=2.2, label='where the robot really was'),
        Line2D([], [], color=SIMULATED, linewidth=1, label='%d simulated robots' % PATHS),
        Line2D([], [], color=IDEAL, linestyle='--', label='as commanded, without any error'),
        Line2D([], [], color='black', marker='o', linestyle='', label='start'),
        Line2D([], [], color=TRUTH, marker='s', markeredgecolor='white', linestyle='', markersize=8, label='end'),
    ], loc='center', frameon=False)
    return figure


def draw_window(axes, window):
    """The paths of a window, from a start at the origin."""
    for x, y, _ in window.paths:
        axes.plot(numpy.append(0, x), numpy.append(0, y), color=SIMULATED, linewidth=0.7, alpha=0.7)
        axes.plot(x[-1], y[-1], '.', color=SIMULATED, markersize=4)
    x, y = window.ideal[:2]
    axes.plot(numpy.append(0, x), numpy.append(0, y), color=IDEAL, linestyle='--', linewidth=1.4)
    x, y = window.true_path[:2]
    axes.plot(x, y, color=TRUTH, linewidth=2.2)
    axes.plot(0, 0, 'o', color='black', markersize=6, zorder=4)
    axes.plot(x[-1], y[-1], 's', color=TRUTH, markeredgecolor='white', markersize=8, zorder=4)
    axes.set(xlabel='x (m)', ylabel='y (m)')
    axes.set_aspect('equal', adjustable='datalim')
    axes.grid(True, alpha=0.4)


def draw_ends(windows):
    """Left: some windows as they are. Right: the ends of all of them on the scale of their ensembles."""
    figure = Figure(figsize=(10.5, 5.6), constrained_layout=True)
    left, right = figure.subplots(1, 2)
    far = [each for each in windows if numpy.hypot(*each.ends[:, :2].mean(axis=0)) > DISTANCE]
    for each in far[::max(1, len(far) // 7)]:
        draw_ellipses(left, each)
    left.plot(0, 0, 'o', color='black', markersize=6)
    left.annotate('start', (0, 0), (0, -8), textcoords='offset points', ha='center', va='top')
    left.set(title='some of them: %d simulated ends each' % ENDS, xlabel='x (m)', ylabel='y (m)')
    left.set_aspect('equal', adjustable='datalim')
    left.grid(True, alpha=0.4)
    draw_scaled(right, windows)
    figure.suptitle('Where the robot was after %d s (blue), and the regions of 50 %% and 90 %% of the simulated ends'
                    % END_LENGTH)
    return figure


def draw_ellipses(axes, window):
    """The cloud of a window, its two regions, and the true end."""
    points = window.ends[:, :2]
    axes.plot(*points.T, '.', color=SIMULATED, markersize=2, alpha=0.35)
    sizes, directions = numpy.linalg.eigh(numpy.cov(points.T))
    for part in PARTS:
        radii = numpy.sqrt(numpy.quantile(mahalanobis(points, points), part) * sizes)
        axes.add_patch(Ellipse(points.mean(axis=0), *2 * radii, fill=False, linewidth=1.2, edgecolor='black',
                               angle=numpy.degrees(numpy.arctan2(directions[1, 0], directions[0, 0]))))
    axes.plot(*window.end[:2], 's', color=TRUTH, markeredgecolor='white', markersize=8, zorder=4)


def radius(share):
    """From 0 in the middle: where a region that holds a share of all ends has its border (in a normal distribution, in
    standard deviations)."""
    return numpy.sqrt(-2 * numpy.log(1 - numpy.minimum(share, 1 - 0.5 / ENDS)))


def draw_scaled(axes, windows):
    """The true ends of all windows on one scale: a circle for each region."""
    for part in PARTS:
        axes.add_patch(Circle((0, 0), radius(part), facecolor=SIMULATED, alpha=0.22, linewidth=0))
        axes.add_patch(Circle((0, 0), radius(part), fill=False, edgecolor='black', linewidth=1.2))
        axes.annotate('%d %%' % (100 * part), (0, -radius(part)), (0, 3), textcoords='offset points', ha='center')
    for each in windows:
        points = each.ends[:, :2]
        sizes, directions = numpy.linalg.eigh(numpy.cov(points.T))
        middle = points.mean(axis=0)
        error = directions @ (directions.T @ (each.end[:2] - middle) / numpy.sqrt(sizes))
        ahead = numpy.arctan2(middle[1], middle[0])
        along = numpy.arctan2(error[1], error[0]) - ahead
        axes.plot(radius(each.inside) * numpy.cos(along), radius(each.inside) * numpy.sin(along), 's',
                  color=TRUTH, markersize=4, alpha=0.8, markeredgewidth=0)
    shares = [100 * numpy.mean([each.inside < part for each in windows]) for part in PARTS]
    axes.set(title='all %d on one scale: %.0f %% and %.0f %% are inside' % (len(windows), *shares), aspect='equal',
             xlim=(-4, 4), ylim=(-4, 4), xticks=[], yticks=[],
             xlabel='less far  \u2190  than simulated  \u2192  farther', ylabel='right  \u2190      \u2192  left')
