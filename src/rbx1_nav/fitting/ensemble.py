"""Simulates the end poses of many runs with equal commands on one floor, and compares them with a real end pose."""
from __future__ import annotations

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.fitting.floor import Prediction, integrate
from rbx1_nav.simulation.floor_noise import CELL_TRAVELLED, CELL_TURNED
from rbx1_nav.simulation.surfaces import Surface


def cell_noise(generator: numpy.random.Generator, count: int, path: Array, cell: float) -> Array:
    """Return the errors (count, m) in each of m steps of `path` due to noise of strength 1. This is
    simulation.floor_noise.Noise in arrays."""
    borders = numpy.concatenate([[0.0], numpy.cumsum(path)]) / cell + generator.random((count, 1))
    number = borders.astype(int)
    sums = numpy.cumsum(generator.laplace(0.0, (cell / 2) ** 0.5, (count, number[:, -1].max() + 1)), axis=1)
    sums = numpy.concatenate([numpy.zeros((count, 1)), sums], axis=1)
    before = numpy.take_along_axis(sums, number, axis=1)
    after = numpy.take_along_axis(sums, number + 1, axis=1)
    return numpy.diff(before + (borders - number) * (after - before), axis=1)


def simulate_paths(surface: Surface, prediction: Prediction, index: int, count: int,
                   generator: numpy.random.Generator) -> Array:
    """Return x, y (m) and yaw (rad) after each step of a window of a Prediction, in `count` separate runs on a Surface.
    The shape is (count, 3, steps)."""
    straight, turn = prediction.straight[index], prediction.turn[index]
    angle = numpy.repeat(prediction.angle[index][None], count, axis=0)
    distance = numpy.repeat(prediction.distance[index][None], count, axis=0)
    for strength, errors, path, cell in (
            (surface.heading_noise_turning, angle, abs(turn), CELL_TURNED),
            (surface.heading_noise_straight, angle, abs(straight), CELL_TRAVELLED),
            (surface.distance_noise, distance, abs(straight), CELL_TRAVELLED)):
        if strength:
            errors += strength * cell_noise(generator, count, path, cell)
    angle -= surface.slip_turning_spread * generator.standard_normal((count, 1)) * turn
    distance -= surface.slip_straight_spread * generator.standard_normal((count, 1)) * straight
    return numpy.stack(integrate(distance, angle), axis=1)


def simulate_ends(surface: Surface, prediction: Prediction, index: int, count: int,
                  generator: numpy.random.Generator) -> Array:
    """Return the end poses of simulate_paths(), with shape (count, 3)."""
    ends: Array = simulate_paths(surface, prediction, index, count, generator)[:, :, -1]
    return ends


def mahalanobis(ends: Array, points: Array) -> Array:
    """Return the squared Mahalanobis distances of points (n, d) from the mean and covariance of `ends` (count, d)."""
    away = points - ends.mean(axis=0)
    covariance = numpy.cov(ends.T)
    # the end poses of a stationary robot have no spread; keep the covariance invertible
    covariance += 1e-12 * numpy.eye(len(covariance))
    squares: Array = (away * numpy.linalg.solve(covariance, away.T).T).sum(axis=1)
    return squares


def inner_share(ends: Array, end: Array) -> float:
    """Return the share of simulated end poses whose Mahalanobis distance from their mean is smaller than the distance
    of `end`. It is below p for an end pose inside the region that contains a share p. ends: (count, d); end: (d,)."""
    share: float = (mahalanobis(ends, ends) < mahalanobis(ends, end[None])).mean()
    return share


def energy_score(ends: Array, point: Array) -> float:
    """Return how well an ensemble (count, d) predicted a point (d,), in the unit of the point; lower is better
    (Gneiting and Raftery, Strictly proper scoring rules, prediction, and estimation, 2007, section 4.3)."""
    half = len(ends) // 2
    score: float = (numpy.linalg.norm(ends - point, axis=1).mean()
                    - numpy.linalg.norm(ends[:half] - ends[half:2 * half], axis=1).mean() / 2)
    return score
