"""Simulates many runs with the commands of a recorded run on one floor, and compares them with the recorded run."""
from __future__ import annotations

from typing import Callable, Iterable, Iterator, NamedTuple, Sequence

import numpy

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import Array
from rbx1_nav.extras.fitting.cell_noise import cell_errors
from rbx1_nav.extras.fitting.prediction import Prediction, integrate
from rbx1_nav.extras.fitting.recording import Recording, relative
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from rbx1_nav.simulation.floor_noise import KINDS

ENDS = 500      # number of simulated end poses per run
LONG = 60.0     # s: longer runs are compared in parts, each of which starts at the true pose
PART = 20.0     # s: length of a part
MAX_SHOWN = 12  # number of runs or parts
PATHS = 10      # number of simulated paths shown per run


def simulate_paths(surface: Surface, prediction: Prediction, index: int, count: int,
                   generator: numpy.random.Generator) -> Array:
    """Return x, y (m) and yaw (rad) after each step of a window of a Prediction, in `count` separate runs on a Surface.
    The shape is (count, 3, steps)."""
    straight, turn = prediction.straight[index], prediction.turn[index]
    errors = {'angle': numpy.repeat(prediction.angle[index][None], count, axis=0),
              'distance': numpy.repeat(prediction.distance[index][None], count, axis=0)}
    paths = prediction.paths()
    for key, kind in KINDS.items():
        strength = getattr(surface, key)
        if strength:
            errors[kind.error] += strength * cell_errors(generator, count, paths[kind.path][index], kind.cell)
    errors['angle'] -= surface.slip_turning_spread * generator.standard_normal((count, 1)) * turn
    errors['distance'] -= surface.slip_straight_spread * generator.standard_normal((count, 1)) * straight
    return numpy.stack(integrate(errors['distance'], errors['angle']), axis=1)


def mahalanobis(ends: Array, points: Array) -> Array:
    """Return the squared Mahalanobis distances of points (n, d) from the mean and covariance of `ends` (count, d)."""
    away = points - ends.mean(axis=0)
    covariance = numpy.cov(ends.T)
    # the end poses of a stationary robot have no spread; keep the covariance invertible
    covariance += 1e-12 * numpy.eye(len(covariance))
    return (away * numpy.linalg.solve(covariance, away.T).T).sum(axis=1)


def inner_share(ends: Array, end: Array) -> float:
    """Return the share of simulated end poses whose Mahalanobis distance from their mean is smaller than the distance
    of `end`. It is below p for an end pose inside the region that contains a share p. ends: (count, d); end: (d,)."""
    return (mahalanobis(ends, ends) < mahalanobis(ends, end[None])).mean()


class Comparison(NamedTuple):
    """One run or a part of it, in the frame of its start."""

    recorded: Array | None      # x and y (m) of the recorded path
    is_truth: bool      # whether the recorded path is the truth and not odometry
    simulated: Array    # (PATHS, 2, steps): x and y (m) of paths with the same commands
    ends: Array         # (ENDS, 3): simulated end poses: x, y (m) and yaw (rad)
    end: Array | None   # true end pose


def predict(surface: Surface, recording: Recording, base_width: float, start: float | None = None,
            end: float | None = None) -> tuple[PreparedRun, Prediction]:
    """Return (PreparedRun without its odometry, Prediction for the whole run from its commands)."""
    run = PreparedRun(recording._replace(odometry=None), base_width, start, end)
    windows = Windows(numpy.array([0]), len(run.times) - 1, numpy.zeros((1, 3)))
    return run, Prediction(surface, run.steps(surface), windows)


def compare(surface: Surface, recordings: Sequence[Recording], base_width: float,
            compute: Callable[..., Iterable[Comparison]] = map) -> list[Comparison]:
    """Return Comparisons of Recordings with a Surface that was fitted to them; at most MAX_SHOWN.

    compute(function, parts): yields the results for all parts, in their order, wherever they are computed.
    """
    return list(compute(compare_part, [(number, surface, recording, base_width, start, end)
                                       for number, (recording, start, end) in enumerate(choose(recordings))]))


def compare_part(part: tuple[int, Surface, Recording, float, float | None, float | None]) -> Comparison:
    number, surface, recording, base_width, start, end = part
    run, prediction = predict(surface, recording, base_width, start, end)
    # each run shows different paths, but equal commands have equal regions
    paths = simulate_paths(surface, prediction, 0, ENDS, numpy.random.default_rng(1))
    track = recording.truth or recording.odometry
    path: Array | None = None
    true: Array | None = None
    if track:
        path = relative(*(numpy.array([numpy.interp(time, track.time, values) for values in track[1:]])
                          for time in (run.times[0], run.times)))
        path = numpy.concatenate([numpy.zeros((3, 1)), path], axis=1)
    if recording.truth and path is not None:
        true = path[:, -1]
    elif recording.end:
        true = numpy.array(recording.end)
    return Comparison(None if path is None else path[:2], bool(recording.truth),
                      numpy.pad(paths[PATHS * number:PATHS * (number + 1), :2], ((0, 0), (0, 0), (1, 0))),
                      paths[:, :, -1], true)


def choose(recordings: Sequence[Recording]) -> Iterator[tuple[Recording, float | None, float | None]]:
    """Yield (Recording, start, end) for each run or part to compare; start and end (s) are None for a whole run."""
    if len(recordings) > MAX_SHOWN:
        recordings = [recordings[index] for index in numpy.linspace(0, len(recordings) - 1, MAX_SHOWN).astype(int)]
    each = max(1, MAX_SHOWN // len(recordings))
    for recording in recordings:
        time = recording.commands.time
        if time[-1] - time[0] <= LONG or not recording.truth:
            yield recording, None, None
            continue
        # parts, spread evenly over the recording
        first, last = max(time[0], recording.truth.time[0]), min(time[-1], recording.truth.time[-1])
        for start in numpy.linspace(first, last - PART, each + 2)[1:-1]:
            yield recording, start, start + PART


def shares(comparisons: Sequence[Comparison]) -> tuple[int, int, int]:
    """Return the numbers of (true end poses, those inside the 50 % region, those inside the 90 % region) in x and y."""
    inside = numpy.array([inner_share(each.ends[:, :2], each.end[:2]) for each in comparisons if each.end is not None])
    return len(inside), int((inside < 0.5).sum()), int((inside < 0.9).sum())
