"""The covariance of the filter, kept as a square root: it has no negative eigenvalue, whatever is measured.

The square root S of a covariance P is a matrix with P = S S^T. The arithmetic is that of square root filters (Maybeck,
Stochastic Models, Estimation, and Control, volume 1, 1979, chapter 7):

- A step of the model multiplies S by the derivatives F, and each source of noise is one more column.
- A measurement with the derivatives H, the noise R and the gain K changes S to (I - K H) S, and adds the column
  K sqrt(R). This is Joseph's form (section 5.6), which holds for any gain.
- When S has no room for more columns, a QR decomposition makes it square again.
"""
from __future__ import annotations

from math import sqrt
from typing import Callable, Sequence

import numpy

from rbx1_nav.arrays import Array

SPARE = 32      # columns for noise, before S is made square
MOST = 2        # columns that one step adds
DOUBT, DRIFT, APART = 0, 1, 2   # columns beside S, and their number


class Covariance:
    """The covariance P (n x n) of the errors of a state.

    doubt, drift: two more vectors (n), which follow the steps of the model as the columns of S do, but are no part of
    P. The filter adds them where it believes in them. Process noise is added when S is made square, so that up to then
    P is a little too small.
    """

    def __init__(self, deviations: Sequence[float], process_noise: Callable[[], Array]) -> None:
        """deviations: n standard deviations of the initial state; process_noise(): called whenever S is made square,
        the noise (n x k columns) since the last call, which is not given to predict()."""
        size = len(deviations)
        self._columns = numpy.zeros((size, APART + size + SPARE))
        self.root = self._columns[:, APART:]        # S
        self.doubt, self.drift = self._columns[:, DOUBT], self._columns[:, DRIFT]
        self.root[range(size), range(size)] = deviations
        self._used = size                           # columns of S
        self._full = size + SPARE - MOST            # with more than these, there is no room for a step
        self._process_noise = process_noise

    def variance(self, index: int) -> float:
        """The variance of one element of the state."""
        return float(self.root[index] @ self.root[index])

    def of_first(self, count: int) -> Array:
        """The covariance (count x count) of the first elements."""
        first = self.root[:count]
        return first @ first.T

    def predict(self, F: Array, noise: Sequence[Sequence[float]]) -> None:
        """A step of the model. F (m x n): the derivatives of the first m elements by all; noise: vectors, at most MOST,
        each with the deviations of the first elements by one source."""
        self._columns[:len(F)] = F @ self._columns
        for column in noise:
            self.root[:len(column), self._used] = column
            self._used += 1
        self._make_room()

    def update(self, HS: Array, R: float, kept: list[int] | None = None) -> Array:
        """Use a measurement. HS: the derivatives H (n) of the measured value by the state, multiplied by S; R: the
        variance of its noise; kept: elements that do not change, though they are uncertain. Returns the gain K (n)."""
        K = self.root @ HS / (float(HS @ HS) + R)
        if kept:
            K[kept] = 0.0
        self.root -= K[:, None] * HS
        self.add(K * sqrt(R))
        return K

    def add(self, column: Array) -> None:
        """Add noise: the deviations (n) that one source causes."""
        self.root[:, self._used] = column
        self._used += 1
        self._make_room()

    def add_to(self, index: int, deviation: float) -> None:
        """Add noise to one element only."""
        self.root[index, self._used] = deviation
        self._used += 1
        self._make_room()

    def replace_first(self, covariance: Array, least: float) -> None:
        """The first elements have this covariance (m x m) now, with eigenvalues of at least `least`, and have nothing
        to do with the others, or with `doubt` and `drift`."""
        self._make_square()
        count = len(covariance)
        self.root[:count] = 0.0
        values, vectors = numpy.linalg.eigh(covariance)
        self.root[:count, self._used:self._used + count] = vectors * numpy.sqrt(numpy.maximum(values, least))
        self._columns[:count, :APART] = 0.0
        self._used += count
        self._make_room()

    def _make_room(self) -> None:
        if self._used > self._full:
            self._make_square()

    def _make_square(self) -> None:
        size = len(self.root)
        wide = numpy.hstack([self.root, self._process_noise()])
        # numpy's types do not know that mode='r' returns one matrix
        square = numpy.linalg.qr(wide.T, mode='r').T    # type: ignore[attr-defined]
        self.root[:] = 0.0
        self.root[:, :size] = square
        self._used = size
