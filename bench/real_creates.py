#!/usr/bin/env python3
"""Evaluate how well a simulated floor predicts the real Creates of the UTIAS dataset. See README.md.

Fits a surface to the first half of each robot's record. Then compares the prediction with the real poses in the second
half, some seconds after a known pose.
"""
import argparse
import glob
import os
import sys

import numpy

from real_pictures import draw_ends, draw_paths
import simulated
from rbx1_nav.extras.fitting.comparison import inner_share, simulate_paths
from rbx1_nav.extras.fitting.floor_fit import Fitter, fit_floor
from rbx1_nav.extras.fitting.prediction import SPREADS, Prediction
from rbx1_nav.extras.fitting.recording import CAMERAS, COMMANDS, read_robot, truth_file
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from rbx1_nav.extras.fitting.surface_fit import WholeFit
from rbx1_nav.simulation.floor_noise import NOISES

BASE_WIDTH = 0.26       # m, of a Create in these files
LENGTHS = 5, 10, 20, 40     # s
FITTED = 10     # s, length of the windows of the fit
ENDS = 500      # simulated end poses per window
UNEXPLAINED = 0.02, 0.02, 0.05  # m, m, rad: errors after FITTED that constant slip cannot explain: nearly all
BLOCK = 60      # s, block of the bootstrap, because neighboring windows have errors in common
DRAWS = 2000    # of the bootstrap
PICTURES = 'real_paths.png', 'real_ends.png'
PATH_LENGTH, END_LENGTH = 40, 20    # s, length of the windows shown
MOTIONS = 'delay', 'lag', 'slip_straight', 'slip_turning', 'curvature', 'turning_loss'
OLD_MOTIONS = 'lag', 'slip_straight', 'slip_turning', 'drag_straight', 'drag_turning'


def read_set(folder, number):
    """The Recordings of all robots of a set in a folder: for set 6, D6R1_Odometry.dat and so on."""
    paths = sorted(glob.glob(os.path.join(glob.escape(folder), f'D{number}R*{COMMANDS}')))
    if not paths:
        sys.exit(f'real_creates: --data: {folder}: no files of set {number}: expected the folder of an unpacked set')
    return [read_robot(path, truth_file(path)) for path in paths]


def energy_score(ends, point):
    """How well an ensemble (count, d) predicted a point (d,), in the unit of the point; lower is better
    (Gneiting and Raftery, Strictly proper scoring rules, prediction, and estimation, 2007, section 4.3)."""
    half = len(ends) // 2
    return (numpy.linalg.norm(ends - point, axis=1).mean()
            - numpy.linalg.norm(ends[:half] - ends[half:2 * half], axis=1).mean() / 2)


def halves(recordings):
    """(first, second): PreparedRun objects of the halves of each record."""
    first, second = [], []
    for recording in recordings:
        start = max(recording.commands.time[0], recording.truth.time[0])
        end = min(recording.commands.time[-1], recording.truth.time[-1])
        first.append(PreparedRun(recording, BASE_WIDTH, start, (start + end) / 2))
        second.append(PreparedRun(recording, BASE_WIDTH, (start + end) / 2, end))
    return first, second


def separate(windows):
    """Split Windows into single ones."""
    return [Windows(windows.first[index:index + 1], windows.length, windows.ends[index:index + 1])
            for index in range(len(windows.first))]


def starting_surface(**values):
    """A surface without errors, as the start of a fit."""
    surface = simulated.floor('hard_floor')
    zeros = dict.fromkeys(('slip_straight', 'slip_turning') + SPREADS, 0.0)
    return surface._replace(**{**zeros, 'drag_straight': 1e-6, 'drag_turning': 1e-6, **values})


def ideal_surface():
    """A surface on which a robot follows its commands immediately."""
    return starting_surface(lag=1e-4, accel_limit=1e3)


def fit(runs, motions, noises):
    """The Surface with these keys fitted to runs, and their standard errors."""
    windows, errors = [run.windows(FITTED) for run in runs], CAMERAS
    if noises == SPREADS:       # the best fit treats each window as a run, with few errors of its own
        errors = UNEXPLAINED
        runs, windows = zip(*((run, window) for run, each in zip(runs, windows) for window in separate(each)))
    fitter = Fitter(runs, windows, errors)
    start = starting_surface(**dict.fromkeys(noises, 0.05), **({'delay': 0.1} if 'delay' in motions else {}))
    return fit_floor(fitter, start, motions, noises)


class Judgement:
    """The prediction of a surface for windows of one length, compared with the truth. One value per window."""

    def __init__(self, runs, surface, length, seed=1):
        generator = numpy.random.default_rng(seed)
        self.windows, self.ends = [], []    # (PreparedRun, Windows with one window); simulated end poses
        self.blocks, inside, scores, errors = [], [], [], []
        for number, run in enumerate(runs):
            windows = run.windows(length, length / 2)
            prediction = Prediction(surface, run.steps(surface), windows)
            self.windows += [(run, window) for window in separate(windows)]
            self.blocks += [(number, int(run.times[first] - run.times[0]) // BLOCK) for first in windows.first]
            for index, end in enumerate(windows.ends):
                ends = simulate_paths(surface, prediction, index, ENDS, generator)[:, :, -1]
                self.ends.append(ends)
                error = end - ends.mean(axis=0)
                errors.append((numpy.hypot(*error[:2]), abs(error[2])))
                inside.append(inner_share(ends[:, :2], end[:2]) if ends[:, :2].std() > 1e-6 else 1.0)
                scores.append(energy_score(ends[:, :2], end[:2]))
        self.inside, self.scores = numpy.array(inside), numpy.array(scores)
        self.position, self.heading = numpy.transpose(errors)

    def interval(self, statistic, *values):
        """The 90 % interval of a statistic of `values` by a block bootstrap."""
        generator = numpy.random.default_rng(0)
        blocks = sorted(set(self.blocks))
        members = [[index for index, block in enumerate(self.blocks) if block == each] for each in blocks]
        drawn = []
        for _ in range(DRAWS):
            chosen = numpy.concatenate([members[index] for index in generator.integers(len(blocks), size=len(blocks))])
            drawn.append(statistic(*(each[chosen] for each in values)))
        return numpy.quantile(drawn, [0.05, 0.95])

    def share(self, part):
        """True end poses inside the region that contains a share of the simulated ones, with interval, in %."""
        def within(inside):
            return 100 * (inside < part).mean()
        return '%3.0f (%2.0f to %3.0f)' % (within(self.inside), *self.interval(within, self.inside))


def judge(name, runs, surface):
    """Print one line per length. Returns the Judgements."""
    judgements = {}
    for length in LENGTHS:
        each = judgements[length] = Judgement(runs, surface, length)
        print('%-22s %3d  %4d  %16s  %16s  %8.3f  %8.3f' % (
            name, length, len(each.inside), each.share(0.5), each.share(0.9), numpy.median(each.position),
            numpy.median(each.heading)), flush=True)
        name = ''
    return judgements


def plot(folder, surface, judgements):
    """Write the pictures."""
    paths, ends = (os.path.join(folder, name) for name in PICTURES)
    floor = 'a floor fitted to the first halves of their recordings'
    draw_paths(paths, 'The same commands for %d s: real robots, and simulated ones on %s\n'
               'The window with the median score of each robot, from the second half of its recording' % (
                   PATH_LENGTH, floor), judgements[PATH_LENGTH], surface, ideal_surface())
    judgement = judgements[END_LENGTH]
    draw_ends(ends, 'After %d s: real end poses, and the regions of %d simulated ones on %s\n'
              'Of all %d end poses in the second halves of the recordings, %.0f %% are inside 50 %%, '
              '%.0f %% inside 90 %%' % (
                  END_LENGTH, ENDS, floor, len(judgement.inside), 100 * (judgement.inside < 0.5).mean(),
                  100 * (judgement.inside < 0.9).mean()), judgement)


def show(surface, errors):
    """Print the fitted values."""
    for key, error in errors.items():
        print(f'  {key:24} {getattr(surface, key):8.4f} +- {error:.4f}')


def leave_out(first, second, judgements):
    """Print how much worse the prediction is without each parameter of the model."""
    print('\nLeft out, and how much the energy score of the second halves grows by it, in % (90 % interval):')
    for key in MOTIONS + NOISES:
        surface, _ = fit(first, [each for each in MOTIONS if each != key], [each for each in NOISES if each != key])
        texts = []
        for length in LENGTHS[:3]:
            full, less = judgements[length], Judgement(second, surface, length)

            def growth(some, others):
                return 100 * (others.mean() / some.mean() - 1)
            texts.append('%5.1f (%5.1f to %5.1f)' % (growth(full.scores, less.scores),
                                                   *full.interval(growth, full.scores, less.scores)))
        print(f"{key:24} {'  '.join(texts)}", flush=True)


def leave_robots_out(recordings):
    """Print how well the surface that fit_surface.py fits to the other robots predicts each robot."""
    for recording in recordings:
        others = [each for each in recordings if each is not recording]
        surface = WholeFit(others, BASE_WIDTH, starting_surface(delay=0.1)).run().surface
        inside = Judgement([PreparedRun(recording, BASE_WIDTH)], surface, END_LENGTH).inside
        print('%s, from the other robots: of %d end poses after %d s, %.0f %% inside 50 %%, %.0f %% inside 90 %%' % (
            recording.name, len(inside), END_LENGTH, 100 * (inside < 0.5).mean(), 100 * (inside < 0.9).mean()),
            flush=True)


def main():
    """Fit, evaluate, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--data', required=True, metavar='DIR', help='folder of files such as D6R1_Odometry.dat')
    parser.add_argument('--set', type=int, default=6, metavar='N', help='number of the set (default 6)')
    parser.add_argument('--leave-out', action='store_true',
                        help='also fit without each parameter and without each robot (takes half an hour)')
    parser.add_argument('--plot', metavar='DIR', help='write %s and %s to this folder' % PICTURES)
    args = parser.parse_args()
    recordings = read_set(args.data, args.set)
    first, second = halves(recordings)
    surface, errors = fit(first, MOTIONS, NOISES)
    print('Fitted to the first halves of set %d:' % args.set)
    show(surface, errors)
    print('%-22s %3s  %4s  %16s  %16s  %8s  %8s' % (
        'surface', 's', 'ends', 'in 50 % (90 % CI)', 'in 90 % (90 % CI)', 'm, med.', 'rad, med.'))
    judgements = judge('fitted', second, surface)
    if args.plot:
        plot(args.plot, surface, judgements)
    old, _ = fit(first, OLD_MOTIONS, SPREADS)
    judge('constant slip, fitted', second, old)
    judge('ideal', second, ideal_surface())
    if args.leave_out:
        leave_out(first, second, judgements)
        leave_robots_out(recordings)


if __name__ == '__main__':
    main()
