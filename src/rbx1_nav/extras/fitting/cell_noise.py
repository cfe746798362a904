"""The noise of a floor for many runs at once: its errors, and their covariance."""
from __future__ import annotations

import numpy

from rbx1_nav.base.units import Array

ROWS = 256      # rows of a matrix that are computed at a time


def cell_errors(generator: numpy.random.Generator, count: int, path: Array, cell: float) -> Array:
    """Return the errors (count, m) in each of m steps of `path` due to Noise of strength 1, with
    other random numbers."""
    borders = numpy.concatenate([[0.0], numpy.cumsum(path)]) / cell + generator.random((count, 1))
    number = borders.astype(int)
    sums = numpy.cumsum(generator.laplace(0.0, (cell / 2) ** 0.5, (count, number[:, -1].max() + 1)), axis=1)
    sums = numpy.concatenate([numpy.zeros((count, 1)), sums], axis=1)
    before = numpy.take_along_axis(sums, number, axis=1)
    after = numpy.take_along_axis(sums, number + 1, axis=1)
    return numpy.diff(before + (borders - number) * (after - before), axis=1)


def cell_covariance(derivatives: Array, path: Array, cell: float) -> Array:
    """Return the covariance (k, k) of k values with these derivatives (k, m) with respect to the errors in m steps of a
    path, due to Noise of strength 1.

    The errors between two points have the variance cell * (apart - 1/3 + near ** 3 / 3), for a random position of the
    cells, where `apart` is the distance of the points in cells, and near = max(0, 1 - apart). White noise has the
    first term only. The second one cancels out.
    """
    covariance: Array = derivatives * path @ derivatives.T
    position = numpy.append(0.0, numpy.cumsum(path)) / cell
    change = numpy.diff(derivatives, prepend=0.0, append=0.0)
    for first in range(0, len(position), ROWS):     # the whole matrix may need gigabytes
        rows = position[first:first + ROWS]
        low, high = numpy.searchsorted(position, (rows[0] - 1, rows[-1] + 1))
        near = numpy.maximum(0, 1 - abs(rows[:, None] - position[low:high]))
        covariance -= cell / 6 * change[:, first:first + ROWS] @ (near * near * near) @ change[:, low:high].T
    return covariance
