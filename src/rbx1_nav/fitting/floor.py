"""The floor model in arrays: the pose that results from wheel travel in Steps, and its covariance.

The model matches simulation/wheels.py and simulation/floor_noise.py, for many windows at once. Covariances are
propagated to first order: each error turns or shifts the rest of the path.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Mapping, NamedTuple

import numpy

from rbx1_nav.arrays import Array
from rbx1_nav.fitting.travel import Steps
from rbx1_nav.simulation.floor_noise import CELL_TRAVELLED, CELL_TURNED
from rbx1_nav.simulation.surfaces import Surface

if TYPE_CHECKING:
    from numpy.typing import NDArray

NOISES = ('heading_noise_turning', 'heading_noise_straight', 'distance_noise')
SPREADS = ('slip_straight_spread', 'slip_turning_spread')
ROWS = 256      # rows of a matrix that are computed at a time


class Windows(NamedTuple):
    """Parts of a recording with measured end poses."""

    first: NDArray[numpy.int_]      # (n,), index of the first step of each window
    length: int     # number of steps in each window
    ends: Array     # (n, 3), end poses in the frame of the start of each window: x, y (m), yaw (rad)


def with_values(surface: Surface, values: Mapping[str, float]) -> Surface:
    """Return a copy of a Surface with the given values."""
    # passing the name shows mypy that no value is meant for it
    return surface._replace(name=surface.name, **values)


def floor_travel(surface: Surface, straight: Array, turn: Array) -> tuple[Array, Array]:
    """Return the (distance in m, angle in rad) that a robot travels without noise. straight, turn: wheel travel."""
    distance = straight * (1 - surface.slip_straight)
    distance = numpy.sign(distance) * numpy.maximum(0.0, abs(distance) - surface.turning_loss * abs(turn))
    return distance, turn * (1 - surface.slip_turning) + surface.curvature * straight


def integrate(distance: Array, angle: Array) -> tuple[Array, Array, Array]:
    """Return (x, y, yaw) after each step, along the last axis, of a robot that starts at the origin."""
    yaw = numpy.cumsum(angle, axis=-1)
    middle = yaw - angle / 2
    chord = distance * numpy.sinc(angle / 2 / numpy.pi)     # see Odometry.move()
    return numpy.cumsum(chord * numpy.cos(middle), axis=-1), numpy.cumsum(chord * numpy.sin(middle), axis=-1), yaw


def cell_covariance(derivatives: Array, path: Array, cell: float) -> Array:
    """Return the covariance (k, k) of k values with these derivatives (k, m) with respect to the errors in m steps of a
    path, due to noise of strength 1 with cells.

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


class Prediction:
    """The prediction of a Surface for n windows of m steps."""

    def __init__(self, surface: Surface, steps: Steps, windows: Windows) -> None:
        """steps: Steps of the whole recording."""
        part = windows.first[:, None] + numpy.arange(windows.length)
        self.straight: Array = steps.straight[part]     # (n, m)
        self.turn: Array = steps.turn[part]     # (n, m)
        self.distance, self.angle = floor_travel(surface, self.straight, self.turn)
        self.path = integrate(self.distance, self.angle)
        self.means = numpy.stack([values[:, -1] for values in self.path], axis=1)   # (n, 3)
        self.errors = windows.ends - self.means

    def sensitivities(self, by_cells: bool = False) -> dict[str, Array]:
        """Return a dictionary: for each of NOISES, the covariances (n, 3, 3) of the end poses for a strength of 1; for
        each of SPREADS, the derivatives (n, 3) of the end poses with respect to a slip that is constant in the run.

        by_cells: whether the noise has the cells of simulation.floor_noise.Noise, which matters for windows of few
        cells; otherwise it is white.
        """
        x, y, yaw = self.path
        middle = yaw - self.angle / 2
        by_heading = numpy.stack([y - y[:, -1:], x[:, -1:] - x, numpy.ones_like(x)], axis=1)    # (n, 3, m)
        by_distance = numpy.stack([numpy.cos(middle), numpy.sin(middle), numpy.zeros_like(x)], axis=1)
        turned, travelled = numpy.abs(self.turn)[:, None], numpy.abs(self.straight)[:, None]

        def along(derivatives: Array, weights: Array, cell: float) -> Array:
            if by_cells:
                return numpy.stack([cell_covariance(one, path[0], cell) for one, path in zip(derivatives, weights)])
            return derivatives * weights @ derivatives.transpose(0, 2, 1)

        return {'heading_noise_turning': along(by_heading, turned, CELL_TURNED),
                'heading_noise_straight': along(by_heading, travelled, CELL_TRAVELLED),
                'distance_noise': along(by_distance, travelled, CELL_TRAVELLED),
                'slip_straight_spread': -(by_distance @ self.straight[..., None])[..., 0],
                'slip_turning_spread': -(by_heading @ self.turn[..., None])[..., 0]}


class Covariance:
    """The covariance of all end poses of a run: independent noise in each window, and slips common to all windows."""

    def __init__(self, surface: Surface, sensitivities: Mapping[str, Array], floor: Array) -> None:
        """sensitivities: see Prediction; floor: covariance (3, 3) of a measured end pose."""
        blocks = floor + sum(getattr(surface, key) ** 2 * sensitivities[key] for key in NOISES)
        self.roots = numpy.linalg.cholesky(blocks)      # (n, 3, 3)
        common = numpy.stack([self._white(getattr(surface, key) * sensitivities[key]) for key in SPREADS], axis=1)
        # the whitened covariance is the identity plus common @ common.T
        self.axes, sizes, _ = numpy.linalg.svd(common, full_matrices=False)
        self.variances = 1 + sizes ** 2

    def _white(self, errors: Array) -> Array:
        return numpy.linalg.solve(self.roots, errors[..., None]).ravel()

    def whitened(self, errors: Array) -> Array:
        """Transform errors of the end poses, (n, 3), to 3 n independent numbers of variance 1."""
        white = self._white(errors)
        along = self.axes.T @ white
        whitened: Array = white + self.axes @ (along * (self.variances ** -0.5 - 1))
        return whitened

    def half_log_determinant(self) -> float:
        """Return half of the logarithm of the determinant."""
        half: float = (numpy.log(numpy.diagonal(self.roots, axis1=1, axis2=2)).sum()
                       + numpy.log(self.variances).sum() / 2)
        return half
