"""Fits delay, lag, acceleration limit and drag of the motors to commands and odometry."""
from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy
from scipy.optimize import least_squares
from scipy.stats import chi2

from rbx1_nav.base.surfaces import Surface
from rbx1_nav.base.units import Array, NDArray
from rbx1_nav.extras.fitting.floor_fit import BOUNDS
from rbx1_nav.extras.fitting.prediction import with_values
from rbx1_nav.extras.fitting.recording import Recording, Track
from rbx1_nav.extras.fitting.run import MOTORS, commanded_travel, reported_travel
from rbx1_nav.node.config import show_name

INTERVAL = 0.2      # s: the travel in intervals of about this length is compared
STEPS = dict(delay=1e-3, lag=1e-3, accel_limit=1e-2, drag_straight=1e-5, drag_turning=1e-5)     # for derivatives
LIMITS: dict[str, tuple[float, float]] = {**BOUNDS, 'accel_limit': (0.01, 100)}
FIRST_DELAYS = 0.0, 0.05, 0.1, 0.2, 0.4, 0.8    # s: the fit starts at the best of these; far away, the cost is flat

SMALLEST = dict(delay=0.002, lag=0.002, accel_limit=0.02, drag_straight=2e-4, drag_turning=2e-4)   # errors
UNLIKELY = 1e-4     # probability of a difference by chance, below which it is reported
SIGNIFICANT = 9.0   # required decrease of the sum of squares by a limit, in variances of a residual: 3 sigma


class MotorFit(NamedTuple):
    """The result of fit_motors() for MOTORS."""

    values: dict[str, float]
    errors: dict[str, float]    # standard errors
    unused: list[str]   # keys without a measurable effect
    rms: float      # m per INTERVAL: rms of the residuals
    travel: float   # m per INTERVAL: rms of the travel


class Intervals:
    """The reported travel of one Recording, between stamps of its odometry."""

    def __init__(self, recording: Recording, base_width: float) -> None:
        """base_width: m."""
        assert recording.odometry
        self.commands = recording.commands
        self.half_width = base_width / 2
        stamps, index = numpy.unique(recording.odometry.time, return_index=True)
        steps = reported_travel(Track(*(values[index] for values in recording.odometry)), stamps)
        number = ((stamps - stamps[0]) / INTERVAL + 1e-6).astype(int)
        chosen = numpy.flatnonzero(numpy.append(True, numpy.diff(number) > 0))
        self.times = stamps[chosen]
        self.travel = self._sides(*(numpy.add.reduceat(values, chosen[:-1]) if len(chosen) > 1 else numpy.zeros(0)
                                    for values in (steps.straight[:chosen[-1]], steps.turn[:chosen[-1]])))

    def _sides(self, straight: Array, turn: Array) -> Array:
        return numpy.concatenate([straight, turn * self.half_width])

    def errors(self, surface: Surface) -> Array:
        """Return reported minus predicted travel of the wheels, m: straight, then turning."""
        steps = commanded_travel(surface, 2 * self.half_width, self.commands, self.times)
        return self.travel - self._sides(steps.straight, steps.turn)


def standard_errors(slopes: Array, left: Array, borders: NDArray[numpy.int_]) -> Array:
    """Return the standard errors of values fitted by least squares: the largest of three estimates.

    The first uses the variance of the residuals `left`. The second uses each residual individually, because rounding to
    whole ticks leaves larger residuals in a start than at rest. The third uses their sums in each run, because
    residuals of successive intervals are not independent (the sandwich estimator of Liang and Zeger, Longitudinal data
    analysis using generalized linear models, 1986). borders: index of the end of each run.
    """
    sizes = numpy.sqrt((slopes ** 2).sum(axis=0))       # the units differ widely
    bread = numpy.linalg.pinv((slopes / sizes).T @ (slopes / sizes)) / numpy.outer(sizes, sizes)
    variances = [(left ** 2).sum() / max(1, len(left) - slopes.shape[1]) * numpy.diag(bread)]
    scores = slopes * left[:, None]
    for sums in (scores, numpy.stack([part.sum(axis=0) for part in numpy.split(scores, borders[:-1])])):
        variances.append(numpy.diag(bread @ (sums.T @ sums) @ bread) * len(sums) / max(1, len(sums) - 1))
    return numpy.sqrt(numpy.max(variances, axis=0))


def fit_motors(surface: Surface, base_width: float, recordings: Sequence[Recording]) -> MotorFit:
    """Fit the motors to Recordings with odometry, starting from a Surface. base_width: m."""
    intervals = [each for each in (Intervals(one, base_width) for one in recordings) if len(each.times) > 1]

    def with_clipped(values: Array) -> Surface:
        low, high = zip(*(LIMITS[key] for key in MOTORS))
        clipped = numpy.clip(values, low, high)
        return with_values(surface, dict(zip(MOTORS, clipped.tolist())))

    def residuals(values: Array) -> Array:
        return numpy.concatenate([each.errors(with_clipped(values)) for each in intervals])

    def squares(values: Array) -> float:
        return (residuals(values) ** 2).sum()

    def jacobian(values: Array) -> Array:
        base, columns = residuals(values), []
        for index, key in enumerate(MOTORS):
            step = numpy.zeros(len(MOTORS))
            # downward at the upper bound
            step[index] = STEPS[key] if values[index] + STEPS[key] < LIMITS[key][1] else -STEPS[key]
            columns.append((residuals(values + step) - base) / step[index])
        return numpy.stack(columns, axis=1)

    given = numpy.array([numpy.clip(getattr(surface, key), *LIMITS[key]) for key in MOTORS])
    start = min((numpy.array([delay, *given[1:]]) for delay in FIRST_DELAYS), key=squares)
    result = least_squares(residuals, start, jacobian, numpy.transpose([LIMITS[key] for key in MOTORS]),
                           x_scale=[0.01, 0.01, 0.3, 0.001, 0.001], xtol=1e-6, ftol=1e-8, max_nfev=60)
    slopes = jacobian(result.x)
    left = residuals(result.x)
    # a parameter without effect: a tenth of its value changes the residuals by less than 1 micrometer in total
    unused = [key for key, column, value in zip(MOTORS, slopes.T, result.x)
              if abs(column).sum() * max(abs(value), STEPS[key]) < 1e-5]
    # a limit just above the acceleration that the motors need also has no effect
    without = residuals(numpy.where([key == 'accel_limit' for key in MOTORS], LIMITS['accel_limit'][1], result.x))
    variance = (left ** 2).sum() / max(1, len(left) - len(MOTORS))
    if 'accel_limit' not in unused and (without ** 2).sum() - (left ** 2).sum() < SIGNIFICANT * variance:
        unused.append('accel_limit')
    used = [index for index, key in enumerate(MOTORS) if key not in unused]
    errors = dict.fromkeys(MOTORS, numpy.inf)
    if used:
        borders = numpy.cumsum([len(each.travel) for each in intervals])
        errors.update(zip((MOTORS[index] for index in used), standard_errors(slopes[:, used], left, borders)))
    travel = numpy.concatenate([each.travel for each in intervals])
    return MotorFit(dict(zip(MOTORS, result.x.tolist())), errors, unused, float(numpy.sqrt((left ** 2).mean())),
                    float(numpy.sqrt((travel ** 2).mean())))


def differing(fit: MotorFit, surface: Surface, base_width: float, recordings: Sequence[Recording]) -> list[str]:
    """Return a warning, with their files, if values differ between the Recordings more than their standard errors
    allow; otherwise nothing.

    fit: the common MotorFit of all Recordings; surface, base_width: see fit_motors().
    """
    fits = [fit_motors(surface, base_width, [each]) for each in recordings] if len(recordings) > 1 else []
    different = []
    for key in MOTORS:
        found = [(each.values[key], each.errors[key], recording.name) for each, recording in zip(fits, recordings)
                 if key not in each.unused]
        if key in fit.unused or len(found) < 2:
            continue
        values, errors = numpy.transpose([each[:2] for each in found])
        names = numpy.array([each[2] for each in found])
        weights = errors.clip(SMALLEST[key]) ** -2.0
        mean = (weights * values).sum() / weights.sum()
        if chi2.sf((weights * (values - mean) ** 2).sum(), len(found) - 1) < UNLIKELY:
            ordered = numpy.sort(values)
            gap = int(numpy.argmax(numpy.diff(ordered)))    # the largest one separates two groups
            groups = [f'{values[some].mean():.3g} in {", ".join(map(show_name, names[some].tolist()))}'
                      for some in (values <= ordered[gap], values > ordered[gap])]
            different.append(f'{key} {" and ".join(groups)}')
    return [f'{"; ".join(different)}: expected recordings of one robot on one floor'] if different else []
