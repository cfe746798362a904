"""Fits the floor of a surface to recorded runs.

The end poses of windows are compared with the predictions of a surface. Slip and the other systematic errors are fitted
by least squares, weighted by the predicted covariance. The noise is fitted to the residuals by maximum likelihood. Both
fits alternate for ROUNDS rounds.
"""
from __future__ import annotations

from typing import Callable, Sequence

import numpy
from scipy.optimize import OptimizeResult, approx_fprime, brentq, least_squares, minimize

from rbx1_nav.base.surfaces import KEYS, Surface
from rbx1_nav.base.units import Array
from rbx1_nav.extras.fitting.prediction import Covariance, Prediction, with_values
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from rbx1_nav.simulation.floor_noise import KINDS

# key: step of a numerical derivative; standard error above which the recordings do not determine the value
MEANS = {'delay': (0.01, 0.1), 'lag': (0.01, 0.1), 'slip_straight': (1e-3, 0.05), 'slip_turning': (1e-3, 0.05),
         'curvature': (1e-3, 0.2), 'turning_loss': (1e-3, 0.05), 'drag_straight': (1e-4, 0.01),
         'drag_turning': (1e-4, 0.01)}
BOUNDS = {**{key: KEYS[key].limits for key in MEANS}, 'lag': (1e-3, 60.0)}
ROUNDS = 3
RELATIVE = 1 / 3    # largest standard error of an accepted value, in units of the value, if this is more
VAGUE_MEAN = 100    # prior 1 sigma of a value, in units of its largest standard error
VAGUE = 0.5     # 1 sigma of the logarithm of a strength above which the strength may be 0
MIN_STRENGTH, MAX_STRENGTH = 1e-4, 1.0      # of a noise or a spread; the minimum counts as 0


class Fitter:
    """Fits parameters of a surface to runs with their windows."""

    def __init__(self, runs: Sequence[PreparedRun], windows: Sequence[Windows], errors: Sequence[float],
                 by_cells: bool = False, widest: float = 1.0) -> None:
        """windows: one Windows per run; errors: 1 sigma of a measured end pose: x and y (m), yaw (rad); by_cells: see
        Prediction.sensitivities(); widest: largest factor by which fit_noise() may increase the errors if this is more
        likely."""
        self.runs = runs
        self.windows = windows
        self.measured = numpy.diag(numpy.square(errors))
        self.wider = 1.0    # fitted factor of the errors
        self.by_cells = by_cells
        self.widest = widest

    @property
    def floor(self) -> Array:
        """The covariance of a measured end pose."""
        return self.wider ** 2 * self.measured

    def predictions(self, surface: Surface) -> list[Prediction]:
        return [Prediction(surface, run.steps(surface), windows) for run, windows in zip(self.runs, self.windows)]

    def fit_means(self, surface: Surface, keys: Sequence[str]) -> tuple[Array, Array]:
        """Fit keys of MEANS, given the noise of the Surface. Returns (values, covariance)."""
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

    def mean_errors(self, surface: Surface, keys: Sequence[str]) -> dict[str, float]:
        """Return the standard errors of keys of MEANS that the runs allow, if the Surface is right."""
        information = vague(keys)
        for prediction, slopes in zip(self.predictions(surface), self.slopes(surface, keys)):
            covariance = Covariance(surface, prediction.sensitivities(self.by_cells), self.floor)
            white = numpy.stack([covariance.whitened(column) for column in numpy.moveaxis(slopes, 2, 0)])
            information = information + white @ white.T
        return dict(zip(keys, numpy.sqrt(numpy.diag(numpy.linalg.inv(information))).tolist()))

    def slopes(self, surface: Surface, keys: Sequence[str]) -> list[Array]:
        """Return the derivatives of all end poses with respect to keys of MEANS: for each run an array (n, 3, keys)."""
        base = self.predictions(surface)
        columns = []
        for key in keys:
            step = MEANS[key][0]
            moved = self.predictions(with_values(surface, {key: getattr(surface, key) + step}))
            columns.append([(after.means - before.means) / step for before, after in zip(base, moved)])
        return [numpy.stack(each, axis=2) for each in zip(*columns)]

    def noise_cost(self, surface: Surface, means: Sequence[str] = ()) -> Callable[..., float]:
        """Return the negative log-likelihood for Surfaces that differ only in their noises and spreads, a function of
        the Surface and optionally of another `wider`.

        means: keys of MEANS that were fitted to the same end poses. If there are any, the result is the restricted
        likelihood, which allows for what they explain (Patterson and Thompson, Recovery of inter-block information when
        block sizes are unequal, 1971).
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

    def excess(self, surface: Surface, key: str) -> float:
        """Return the excess kurtosis of the errors of the end poses that a noise or a spread causes: 3 for the Laplace
        distribution of a cell, 3 / n for n cells, and 0 for a spread, whose distribution is normal."""
        if key not in KINDS:
            return 0.0
        _, path, cell = KINDS[key]
        paths = numpy.concatenate([each.paths()[path].sum(axis=1) for each in self.predictions(surface)])
        return 3 * float(numpy.minimum(paths, cell).sum() / max(paths.sum(), cell))

    def fit_noise(self, surface: Surface, keys: Sequence[str], means: Sequence[str] = (),
                  prior: Surface | None = None) -> tuple[Array, Array]:
        """Fit keys of NOISES and SPREADS by maximum likelihood. Returns (values, standard errors).

        means: see noise_cost(); prior: a Surface with the prior values, which have a 1 sigma error of a factor of e;
        None: no prior.
        """
        cost_of = self.noise_cost(surface, means)
        likely = None if prior is None else numpy.log([getattr(prior, key) for key in keys])
        count = len(keys)

        def cost(logarithms: Array) -> float:       # of the strengths, and of `wider` if it is fitted too
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
            if result.x[count] in bounds[count]:    # at a bound, it has no variance
                result.x = result.x[:count]
        steps = 0.05 * numpy.eye(len(result.x))
        hessian = numpy.stack([(approx_fprime(result.x + step, cost, 1e-4) - approx_fprime(result.x - step, cost, 1e-4))
                               / 0.1 for step in steps])
        variances = numpy.diag(numpy.linalg.pinv((hessian + hessian.T) / 2))[:count].clip(0)
        variances *= [1 + self.excess(surface, key) / 2 for key in keys]    # as for the variance of a sample
        values = numpy.exp(result.x[:count])
        # with a prior, the upward error, which is larger than the downward error
        errors = values * (numpy.expm1(numpy.sqrt(variances)) if prior else numpy.sqrt(variances))
        unclear = (values < 3 * MIN_STRENGTH) | (variances > VAGUE ** 2) | (variances <= 0)
        for index in numpy.flatnonzero(unclear):
            errors[index] = upper_error(cost, result, index)
        return values, errors


def uncertainty(value: float, error: float, largest: float, relative: float = RELATIVE) -> float:
    """Return how uncertain a value is: above 1, its standard error is too large. largest, relative: errors that are
    never too large, in the unit of the value and in units of the value."""
    return error / max(largest, relative * abs(value))


def vague(keys: Sequence[str]) -> Array:
    """Return the prior information about keys of MEANS. It is almost zero, but gives a value (or a sum of two values)
    that the runs do not determine a large, finite standard error."""
    return numpy.diag([(VAGUE_MEAN * MEANS[key][1]) ** -2.0 for key in keys])


def upper_error(cost: Callable[[Array], float], result: OptimizeResult, index: int) -> float:
    """Return by how much one of the strengths, whose logarithms are in `result`, may be larger: until the likelihood
    has decreased as far as after one standard error. It is used for strengths that may be 0, where a parabola of the
    logarithm is not valid."""
    def excess(logarithm: float) -> float:
        moved = result.x.copy()
        moved[index] = logarithm
        return cost(moved) - result.fun - 0.5

    largest = numpy.log(MAX_STRENGTH)
    if result.x[index] >= largest or excess(largest) < 0:
        return numpy.inf
    return numpy.exp(brentq(excess, result.x[index], largest, xtol=0.01)) - numpy.exp(result.x[index])


def fit_floor(fitter: Fitter, surface: Surface, means: Sequence[str], noises: Sequence[str],
              prior: Surface | None = None) -> tuple[Surface, dict[str, float]]:
    """Fit the values of all keys together. Returns (Surface, {key: standard error}). prior: see fit_noise(); with a
    prior, the likelihood is restricted."""
    errors: dict[str, float] = {}
    for _ in range(ROUNDS):
        if means:
            values, covariance = fitter.fit_means(surface, means)
            surface = with_values(surface, dict(zip(means, values.tolist())))
            errors.update(zip(means, numpy.sqrt(numpy.diag(covariance))))
        if noises:
            values, deviations = fitter.fit_noise(surface, noises, means if prior else (), prior)
            surface = with_values(surface, dict(zip(noises, values.tolist())))
            errors.update(zip(noises, deviations))
    return surface, errors
