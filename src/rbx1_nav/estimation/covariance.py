"""The covariance of the filter, stored as a square root so that no measurement can make an eigenvalue negative.

The square root S of a covariance P is a matrix with P = S S^T. The arithmetic follows square root filters (Maybeck,
Stochastic Models, Estimation, and Control, volume 1, 1979, chapter 7):

- A step of the model multiplies S by the derivatives F, and adds one column for each source of noise.
- A measurement with the derivatives H, the noise R and the gain K changes S to (I - K H) S, and adds the column
  K sqrt(R). This is Joseph's form (section 5.6), which holds for any gain.
- When S has no space for more columns, a QR decomposition makes it square again.
"""
from __future__ import annotations

from math import sqrt
from typing import Callable, Sequence

import numpy

from rbx1_nav.arrays import Array

SPARE = 32      # columns for noise, before S is made square
MOST = 2        # columns that one step adds
DOUBT, DRIFT, APART = 0, 1, 2   # additional columns next to S, and their number


class Covariance:
    """The covariance P (n x n) of the errors of a state.

    doubt, drift: two more vectors (n), which follow the steps of the model like the columns of S, but are not part of
    P. The filter adds them to P where they apply. Process noise is added when S is made square, so P is slightly too
    small until then.
    """

    def __init__(self, deviations: Sequence[float], process_noise: Callable[[], Array]) -> None:
        """deviations: n standard deviations of the initial state; process_noise(): called whenever S is made square,
        returns the noise (n x k columns) since its last call, which is not passed to predict()."""
        size = len(deviations)
        self._columns = numpy.zeros((size, APART + size + SPARE))
        self.root = self._columns[:, APART:]        # S
        self.doubt, self.drift = self._columns[:, DOUBT], self._columns[:, DRIFT]
        self.root[range(size), range(size)] = deviations
        self._used = size                           # columns of S
        self._full = size + SPARE - MOST            # with more columns than this, there is no space for a step
        self._process_noise = process_noise

    def variance(self, index: int) -> float:
        """Return the variance of one element of the state."""
        return float(self.root[index] @ self.root[index])

    def of_first(self, count: int) -> Array:
        """Return the covariance (count x count) of the first elements."""
        first = self.root[:count]
        return first @ first.T

    def predict(self, F: Array, noise: Sequence[Sequence[float]]) -> None:
        """Make a step of the model.

        F (m x n): derivatives of the first m elements with respect to all elements; noise: at most MOST vectors, each
        with the deviations of the first elements that one source causes.
        """
        self._columns[:len(F)] = F @ self._columns
        for column in noise:
            self.root[:len(column), self._used] = column
            self._used += 1
        self._make_room()

    def update(self, HS: Array, R: float, kept: list[int] | None = None) -> Array:
        """Use a measurement, and return the gain K (n).

        HS: derivatives H (n) of the measured value with respect to the state, multiplied by S; R: variance of its
        noise; kept: elements that do not change, although they are uncertain.
        """
        K = self.root @ HS / (float(HS @ HS) + R)
        if kept:
            K[kept] = 0.0
        self.root -= K[:, None] * HS
        self.add(K * sqrt(R))
        return K

    def add(self, column: Array) -> None:
        """Add noise. column: the deviations (n) that one source causes."""
        self.root[:, self._used] = column
        self._used += 1
        self._make_room()

    def add_to(self, index: int, deviation: float) -> None:
        """Add noise to one element only."""
        self.root[index, self._used] = deviation
        self._used += 1
        self._make_room()

    def replace_first(self, covariance: Array, least: float) -> None:
        """Give the first elements this covariance (m x m), with eigenvalues of at least `least`.

        They then have no correlation with the other elements, nor with `doubt` and `drift`.
        """
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
        # numpy's type hints do not cover mode='r', which returns one matrix
        square = numpy.linalg.qr(wide.T, mode='r').T    # type: ignore[attr-defined]
        self.root[:] = 0.0
        self.root[:, :size] = square
        self._used = size
