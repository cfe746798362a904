"""Fits a surface to recorded runs.

The ends of windows are compared with those that a surface predicts. Slip and its like are fitted by least squares,
weighted by the predicted covariance; the noise by maximum likelihood, from what is left; both in turn until they stay.
"""
from __future__ import annotations

from typing import Callable, Protocol, Sequence

import numpy
from scipy.optimize import OptimizeResult, approx_fprime, brentq, least_squares, minimize

from rbx1_nav.arrays import Array
from rbx1_nav.fitting.floor import Covariance, Prediction, Windows, with_values
from rbx1_nav.fitting.run import PreparedRun
from rbx1_nav.simulation.surfaces import Surface

# key: step of a numerical derivative; standard error beyond which the recordings cannot tell the value
MEANS = {'delay': (0.01, 0.1), 'lag': (0.01, 0.1), 'slip_straight': (1e-3, 0.05), 'slip_turning': (1e-3, 0.05),
         'curvature': (1e-3, 0.2), 'turning_loss': (1e-3, 0.05), 'drag_straight': (1e-4, 0.01),
         'drag_turning': (1e-4, 0.01)}
BOUNDS: dict[str, tuple[float, float]] = {
    'delay': (0, 5), 'lag': (1e-3, 60), 'slip_straight': (-0.5, 0.5), 'slip_turning': (-0.5, 0.5),
    'curvature': (-10, 10), 'turning_loss': (0, 1), 'drag_straight': (1e-6, 10), 'drag_turning': (1e-6, 10)}
ROUNDS = 3
VAGUE_MEAN = 100    # 1 sigma of a value before any run is seen, in units of its largest standard error
VAGUE = 0.5     # 1 sigma of the logarithm of a strength, above which it may as well be 0
MIN_STRENGTH, MAX_STRENGTH = 1e-4, 1.0      # of a noise or a spread; at the smaller one it counts as 0


class NoiseCost(Protocol):
    """Less the logarithm of a likelihood, see Fitter.noise_cost()."""

    def __call__(self, noisy: Surface, wider: float | None = None) -> float:
        """The cost with the noises and spreads of a Surface, and perhaps another `wider`."""


class Fitter:
    """Runs with their windows."""

    def __init__(self, runs: Sequence[PreparedRun], windows: Sequence[Windows], errors: Sequence[float],
                 by_cells: bool = False, widest: float = 1.0) -> None:
        """windows: of each of the runs; errors: 1 sigma of a measured end: x and y (m), yaw (rad); by_cells: see
        Prediction.sensitivities(); widest: up to so many times as large as given are the errors taken, if fit_noise()
        finds that likelier."""
        self.runs = runs
        self.windows = windows
        self.measured = numpy.diag(numpy.square(errors))
        self.wider = 1.0    # by how much the errors were found larger
        self.by_cells = by_cells
        self.widest = widest

    @property
    def floor(self) -> Array:
        """The covariance of a measured end."""
        floor: Array = self.wider ** 2 * self.measured
        return floor

    def predictions(self, surface: Surface) -> list[Prediction]:
        """The Prediction for each run."""
        return [Prediction(surface, run.steps(surface), windows) for run, windows in zip(self.runs, self.windows)]

    def fit_means(self, surface: Surface, keys: Sequence[str]) -> tuple[Array, Array]:
        """(values, covariance) of keys of MEANS, given the noise of the Surface."""
        covariances = [Covariance(surface, each.sensitivities(self.by_cells), self.floor)
                       for each in self.predictions(surface)]

        def residuals(values: Array) -> Array:
            predictions = self.predictions(with_values(surface, dict(zip(keys, values))))
            return numpy.concatenate([covariance.whitened(each.errors)
                                      for covariance, each in zip(covariances, predictions)])

        def jacobian(values: Array) -> Array:
            base = residuals(values)
            return numpy.stack([(residuals(values + step) - base) / step.sum()
                                for step in numpy.diag([MEANS[key][0] for key in keys])], axis=1)

        start = [numpy.clip(getattr(surface, key), *BOUNDS[key]) for key in keys]
        result = least_squares(residuals, start, jacobian, numpy.transpose([BOUNDS[key] for key in keys]),
                               x_scale=[MEANS[key][1] for key in keys], xtol=1e-4, ftol=1e-6)
        return result.x, numpy.linalg.inv(result.jac.T @ result.jac + vague(keys))

    def slopes(self, surface: Surface, keys: Sequence[str]) -> list[Array]:
        """The derivatives of all ends by keys of MEANS: for each run an array (n, 3, keys)."""
        base = self.predictions(surface)
        columns = []
        for key in keys:
            step = MEANS[key][0]
            moved = self.predictions(with_values(surface, {key: getattr(surface, key) + step}))
            columns.append([(after.means - before.means) / step for before, after in zip(base, moved)])
        return [numpy.stack(each, axis=2) for each in zip(*columns)]

    def noise_cost(self, surface: Surface, means: Sequence[str] = ()) -> NoiseCost:
        """Less the logarithm of the likelihood, for Surfaces that differ only in their noises and spreads.

        If keys of MEANS that were fitted to the same ends are given, it is the restricted likelihood, which allows for
        what they explain (Patterson and Thompson, Recovery of inter-block information when block sizes are unequal,
        1971).
        """
        predictions = self.predictions(surface)
        sensitivities = [each.sensitivities(self.by_cells) for each in predictions]
        slopes = [numpy.moveaxis(each, 2, 0) for each in self.slopes(surface, means)] if means else []

        def cost(noisy: Surface, wider: float | None = None) -> float:
            total, information = 0.0, numpy.zeros((len(means), len(means)))
            floor = (wider or self.wider) ** 2 * self.measured
            for index, (sensitivity, prediction) in enumerate(zip(sensitivities, predictions)):
                covariance = Covariance(noisy, sensitivity, floor)
                total += covariance.half_log_determinant() + (covariance.whitened(prediction.errors) ** 2).sum() / 2
                if slopes:
                    white = numpy.stack([covariance.whitened(column) for column in slopes[index]])
                    information = information + white @ white.T
            restriction: float = numpy.linalg.slogdet(information + vague(means))[1] / 2 if slopes else 0.0
            return total + restriction

        return cost

    def fit_noise(self, surface: Surface, keys: Sequence[str], means: Sequence[str] = (),
                  prior: Surface | None = None) -> tuple[Array, Array, float]:
        """(values, standard errors, cost) of keys of NOISES and SPREADS, by maximum likelihood; means: see
        noise_cost(); prior: a Surface whose values are likely, before any run is seen, to a factor of e; None: any are.
        """
        cost_of = self.noise_cost(surface, means)
        likely = None if prior is None else numpy.log([getattr(prior, key) for key in keys])
        count = len(keys)

        def cost(logarithms: Array) -> float:       # of the strengths, and of `wider` where it is fitted with them
            values = numpy.exp(logarithms).tolist()
            unlikely: float = 0.0 if likely is None else ((logarithms[:count] - likely) ** 2).sum() / 2
            return cost_of(with_values(surface, dict(zip(keys, values))), *values[count:]) + unlikely

        start = numpy.log(numpy.clip([getattr(surface, key) or 0.03 for key in keys], MIN_STRENGTH, MAX_STRENGTH))
        bounds = [(numpy.log(MIN_STRENGTH), numpy.log(MAX_STRENGTH))] * count
        if self.widest > 1:
            start, bounds = numpy.append(start, numpy.log(self.wider)), bounds + [(0.0, numpy.log(self.widest))]
        result = minimize(cost, start, method='L-BFGS-B', bounds=bounds)
        if self.widest > 1:
            self.wider = float(numpy.exp(result.x[count]))
            if result.x[count] in bounds[count]:    # there it has no variance
                result.x = result.x[:count]
        steps = 0.05 * numpy.eye(len(result.x))
        hessian = numpy.stack([(approx_fprime(result.x + step, cost, 1e-4) - approx_fprime(result.x - step, cost, 1e-4))
                               / 0.1 for step in steps])
        variances = numpy.diag(numpy.linalg.pinv((hessian + hessian.T) / 2))[:count].clip(0)
        values = numpy.exp(result.x[:count])
        # with a prior the way up, which is longer than the way down
        errors = values * (numpy.expm1(numpy.sqrt(variances)) if prior else numpy.sqrt(variances))
        unclear = (values < 3 * MIN_STRENGTH) | (variances > VAGUE ** 2) | (variances <= 0)
        for index in numpy.flatnonzero(unclear):
            errors[index] = upper_error(cost, result, index)
        return values, errors, result.fun


def vague(keys: Sequence[str]) -> Array:
    """The information about keys of MEANS before any run is seen: next to nothing, but enough for a value that the runs
    do not tell, or a sum of two, to get a large standard error and not none."""
    return numpy.diag([(VAGUE_MEAN * MEANS[key][1]) ** -2.0 for key in keys])


def upper_error(cost: Callable[[Array], float], result: OptimizeResult, index: int) -> float:
    """How much larger one of the strengths, whose logarithms are in `result`, may be: until the likelihood falls as far
    as after one standard error. For those that may be 0, where a parabola of the logarithm says nothing."""
    def excess(logarithm: float) -> float:
        moved = result.x.copy()
        moved[index] = logarithm
        difference: float = cost(moved) - result.fun - 0.5
        return difference

    largest = numpy.log(MAX_STRENGTH)
    if result.x[index] >= largest or excess(largest) < 0:
        return numpy.inf
    error: float = numpy.exp(brentq(excess, result.x[index], largest, xtol=0.01)) - numpy.exp(result.x[index])
    return error


def fit_floor(fitter: Fitter, surface: Surface, means: Sequence[str], noises: Sequence[str],
              prior: Surface | None = None) -> tuple[Surface, dict[str, float], float | None]:
    """(Surface, {key: standard error}, cost) with the values of all keys fitted together. prior: see fit_noise(); with
    it, the likelihood is restricted."""
    errors: dict[str, float] = {}
    cost = None
    for _ in range(ROUNDS):
        if means:
            values, covariance = fitter.fit_means(surface, means)
            surface = with_values(surface, dict(zip(means, values.tolist())))
            errors.update(zip(means, numpy.sqrt(numpy.diag(covariance))))
        if noises:
            values, deviations, cost = fitter.fit_noise(surface, noises, means if prior else (), prior)
            surface = with_values(surface, dict(zip(noises, values.tolist())))
            errors.update(zip(noises, deviations))
    return surface, errors, cost
