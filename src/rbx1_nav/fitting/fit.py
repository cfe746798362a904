"""Fits a surface to recorded runs.

The ends of windows are compared with those that a surface predicts. Slip and its like are fitted by least squares,
weighted by the predicted covariance; the noise by maximum likelihood, from what is left; both in turn until they stay.
"""
import numpy
from scipy.optimize import approx_fprime, brentq, least_squares, minimize

from rbx1_nav.fitting.floor import Covariance, Prediction

# key: step of a numerical derivative; standard error beyond which the recordings cannot tell the value
MEANS = {'delay': (0.01, 0.1), 'lag': (0.01, 0.1), 'slip_straight': (1e-3, 0.05), 'slip_turning': (1e-3, 0.05),
         'curvature': (1e-3, 0.2), 'turning_loss': (1e-3, 0.05), 'drag_straight': (1e-4, 0.01),
         'drag_turning': (1e-4, 0.01)}
BOUNDS = {'delay': (0, 5), 'lag': (1e-3, 60), 'slip_straight': (-0.5, 0.5), 'slip_turning': (-0.5, 0.5),
          'curvature': (-10, 10), 'turning_loss': (0, 1), 'drag_straight': (1e-6, 10), 'drag_turning': (1e-6, 10)}
ROUNDS = 3
VAGUE_MEAN = 100    # 1 sigma of a value before any run is seen, in units of its largest standard error
VAGUE = 0.5     # 1 sigma of the logarithm of a strength, above which it may as well be 0
MIN_STRENGTH, MAX_STRENGTH = 1e-4, 1.0      # of a noise or a spread; at the smaller one it counts as 0


class Fitter:
    """Runs with their windows."""

    def __init__(self, runs, windows, errors, by_cells=False, widest=1.0):
        """runs: Run objects; windows: Windows of each; errors: 1 sigma of a measured end: x and y (m), yaw (rad);
        by_cells: see Prediction.sensitivities(); widest: up to so many times as large as given are the errors taken, if
        fit_noise() finds that likelier."""
        self.runs = runs
        self.windows = windows
        self.measured = numpy.diag(numpy.square(errors))
        self.wider = 1.0    # by how much the errors were found larger
        self.by_cells = by_cells
        self.widest = widest

    @property
    def floor(self):
        """The covariance of a measured end."""
        return self.wider ** 2 * self.measured

    def predictions(self, surface):
        """The Prediction for each run."""
        return [Prediction(surface, run.steps(surface), windows) for run, windows in zip(self.runs, self.windows)]

    def fit_means(self, surface, keys):
        """(values, covariance) of keys of MEANS, given the noise of the Surface."""
        covariances = [Covariance(surface, each.sensitivities(self.by_cells), self.floor)
                       for each in self.predictions(surface)]

        def residuals(values):
            predictions = self.predictions(surface._replace(**dict(zip(keys, values))))
            return numpy.concatenate([covariance.whitened(each.errors)
                                      for covariance, each in zip(covariances, predictions)])

        def jacobian(values):
            base = residuals(values)
            return numpy.stack([(residuals(values + step) - base) / step.sum()
                                for step in numpy.diag([MEANS[key][0] for key in keys])], axis=1)

        start = [numpy.clip(getattr(surface, key), *BOUNDS[key]) for key in keys]
        result = least_squares(residuals, start, jacobian, numpy.transpose([BOUNDS[key] for key in keys]),
                               x_scale=[MEANS[key][1] for key in keys], xtol=1e-4, ftol=1e-6)
        return result.x, numpy.linalg.inv(result.jac.T @ result.jac + vague(keys))

    def slopes(self, surface, keys):
        """The derivatives of all ends by keys of MEANS: for each run an array (n, 3, keys)."""
        base = self.predictions(surface)
        columns = []
        for key in keys:
            step = MEANS[key][0]
            moved = self.predictions(surface._replace(**{key: getattr(surface, key) + step}))
            columns.append([(after.means - before.means) / step for before, after in zip(base, moved)])
        return [numpy.stack(each, axis=2) for each in zip(*columns)]

    def noise_cost(self, surface, means=()):
        """A function of a Surface that differs only in its noises and spreads, and perhaps of another `wider`:
        less the logarithm of its likelihood.

        If keys of MEANS that were fitted to the same ends are given, it is the restricted likelihood, which allows for
        what they explain (Patterson and Thompson, Recovery of inter-block information when block sizes are unequal,
        1971).
        """
        predictions = self.predictions(surface)
        sensitivities = [each.sensitivities(self.by_cells) for each in predictions]
        slopes = [numpy.moveaxis(each, 2, 0) for each in self.slopes(surface, means)] if means else []

        def cost(noisy, wider=None):
            total, information, floor = 0.0, 0.0, (wider or self.wider) ** 2 * self.measured
            for index, (sensitivity, prediction) in enumerate(zip(sensitivities, predictions)):
                covariance = Covariance(noisy, sensitivity, floor)
                total += covariance.half_log_determinant() + (covariance.whitened(prediction.errors) ** 2).sum() / 2
                if slopes:
                    white = numpy.stack([covariance.whitened(column) for column in slopes[index]])
                    information = information + white @ white.T
            return total + (numpy.linalg.slogdet(information + vague(means))[1] / 2 if slopes else 0.0)
        return cost

    def fit_noise(self, surface, keys, means=(), prior=None):
        """(values, standard errors, cost) of keys of NOISES and SPREADS, by maximum likelihood; means: see
        noise_cost(); prior: a Surface whose values are likely, before any run is seen, to a factor of e; None: any are.
        """
        cost_of = self.noise_cost(surface, means)
        likely = None if prior is None else numpy.log([getattr(prior, key) for key in keys])
        count = len(keys)

        def cost(logarithms):       # of the strengths, and of `wider` where it is fitted with them
            values = numpy.exp(logarithms).tolist()
            return (cost_of(surface._replace(**dict(zip(keys, values))), *values[count:])
                    + (0.0 if prior is None else ((logarithms[:count] - likely) ** 2).sum() / 2))

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


def vague(keys):
    """The information about keys of MEANS before any run is seen: next to nothing, but enough for a value that the runs
    do not tell, or a sum of two, to get a large standard error and not none."""
    return numpy.diag([(VAGUE_MEAN * MEANS[key][1]) ** -2.0 for key in keys])


def upper_error(cost, result, index):
    """How much larger one of the strengths, whose logarithms are in `result`, may be: until the likelihood falls as far
    as after one standard error. For those that may be 0, where a parabola of the logarithm says nothing."""
    def excess(logarithm):
        moved = result.x.copy()
        moved[index] = logarithm
        return cost(moved) - result.fun - 0.5
    largest = numpy.log(MAX_STRENGTH)
    if result.x[index] >= largest or excess(largest) < 0:
        return numpy.inf
    return numpy.exp(brentq(excess, result.x[index], largest, xtol=0.01)) - numpy.exp(result.x[index])


def fit_floor(fitter, surface, means, noises, prior=None):
    """(Surface, {key: standard error}, cost) with the values of all keys fitted together. prior: see fit_noise(); with
    it, the likelihood is restricted."""
    errors, cost = {}, None
    for _ in range(ROUNDS):
        if means:
            values, covariance = fitter.fit_means(surface, means)
            surface = surface._replace(**dict(zip(means, values.tolist())))
            errors.update(zip(means, numpy.sqrt(numpy.diag(covariance))))
        if noises:
            values, deviations, cost = fitter.fit_noise(surface, noises, means if prior else (), prior)
            surface = surface._replace(**dict(zip(noises, values.tolist())))
            errors.update(zip(noises, deviations))
    return surface, errors, cost
