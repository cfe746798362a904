"""The prediction of end poses from wheel travel, for many windows at once, and its covariance.

Covariances are propagated to first order: each error turns or shifts the rest of the path.
"""
from __future__ import annotations

from typing import Mapping

import numpy

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import Array
from rbx1_nav.extras.fitting.cell_noise import cell_covariance
from rbx1_nav.extras.fitting.run import Steps, Windows
from rbx1_nav.simulation.floor_noise import KINDS, NOISES, NoiseKind
from rbx1_nav.simulation.slip import floor_travel

SPREADS = ('slip_straight_spread', 'slip_turning_spread')


def with_values(surface: Surface, values: Mapping[str, float]) -> Surface:
    """Return a copy of a Surface with the given values."""
    # passing the name shows mypy that no value is meant for it
    return surface._replace(name=surface.name, **values)


def integrate(distance: Array, angle: Array) -> tuple[Array, Array, Array]:
    """Return (x, y, yaw) after each step, along the last axis, of a robot that starts at the origin."""
    yaw = numpy.cumsum(angle, axis=-1)
    middle = yaw - angle / 2
    chord = distance * numpy.sinc(angle / 2 / numpy.pi)     # see Odometry.move()
    return numpy.cumsum(chord * numpy.cos(middle), axis=-1), numpy.cumsum(chord * numpy.sin(middle), axis=-1), yaw


class Prediction:
    """The prediction of a Surface for n windows of m steps."""

    def __init__(self, surface: Surface, steps: Steps, windows: Windows) -> None:
        """steps: Steps of the whole recording."""
        self.tick = 1 / surface.ticks_meter if steps.rounded else 0.0       # m
        part = windows.first[:, None] + numpy.arange(windows.length)
        self.straight: Array = steps.straight[part]     # (n, m)
        self.turn: Array = steps.turn[part]     # (n, m)
        self.distance, self.angle = floor_travel(surface, surface, self.straight, self.turn, numpy.copysign,
                                                 numpy.maximum)
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
        paths = self.paths()
        derivatives = {'angle': by_heading, 'distance': by_distance}

        def covariances(kind: NoiseKind) -> Array:
            along, path = derivatives[kind.error], paths[kind.path]
            if by_cells:
                return numpy.stack([cell_covariance(*each, kind.cell) for each in zip(along, path)])
            return along * path[:, None] @ along.transpose(0, 2, 1)

        return {**{key: covariances(kind) for key, kind in KINDS.items()},
                'slip_straight_spread': -(by_distance @ self.straight[..., None])[..., 0],
                'slip_turning_spread': -(by_heading @ self.turn[..., None])[..., 0]}

    def paths(self) -> dict[str, Array]:
        """Return the (n, m) lengths of the steps of both kinds of path of a NoiseKind."""
        travelled = numpy.abs(self.straight)
        # encoders that round to ticks report a path even during a turn on the spot, but the floor adds no noise to it
        return {'travelled': numpy.where(travelled > self.tick, travelled, 0.0), 'turned': numpy.abs(self.turn)}


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
        return white + self.axes @ (along * (self.variances ** -0.5 - 1))

    def half_log_determinant(self) -> float:
        return (numpy.log(numpy.diagonal(self.roots, axis1=1, axis2=2)).sum()
                + numpy.log(self.variances).sum() / 2)
