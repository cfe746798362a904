"""Fits a floor to runs of which only the ends are known, measured with a tape.

A few ends tell the mean slips and how large the errors are as a whole, not each noise by itself. So all noises and
spreads are multiplied by one common factor. What so few runs leave open is added to the spreads.
"""
from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy
from scipy.optimize import minimize_scalar
from scipy.stats import chi2, f as f_distribution

from rbx1_nav.fitting.fit import MEANS, Fitter
from rbx1_nav.fitting.floor import NOISES, SPREADS, Windows, with_values
from rbx1_nav.fitting.run import PreparedRun
from rbx1_nav.simulation.surfaces import Surface

SLIPS = ('slip_straight', 'slip_turning')
TYPICAL = dict(heading_noise_turning=0.09, heading_noise_straight=0.07, distance_noise=0.04,     # of real Creates
               slip_straight_spread=0.01, slip_turning_spread=0.01)
FACTORS = 0.02, 50.0    # of the noises
PRIOR = 1.0     # 1 sigma of the logarithm of the factor, before any run is seen: floors differ by so much
ROUNDS = 3
PART = 0.9      # the region that has to hold this part of the ends of further runs
FAR_OFF = 5.0   # a factor above this, or below its reciprocal, is suspicious


class EndsFit(NamedTuple):
    """What was found."""

    values: dict[str, float]
    errors: dict[str, float]    # standard errors
    reasons: dict[str, str]     # for keys that are not told
    notes: list[str]
    warnings: list[str]


def fit_ends(runs: Sequence[PreparedRun], surface: Surface, end_errors: Sequence[float]) -> EndsFit:
    """The EndsFit; end_errors: 1 sigma of x, y (m) and yaw (rad)."""
    start = surface
    if not any(getattr(surface, key) for key in NOISES):
        surface = start = with_values(surface, {key: getattr(surface, key) or value
                                                for key, value in TYPICAL.items()})
    means, factor = list(SLIPS), 1.0
    reasons: dict[str, str] = {}
    while True:
        for _ in range(ROUNDS):
            windows = [ends_of(run, surface) for run in runs]
            fitter = Fitter(runs, windows, end_errors, by_cells=True)
            covariance = numpy.zeros((0, 0))
            if means:
                slips, covariance = fitter.fit_means(surface, means)
                surface = with_values(surface, dict(zip(means, slips.tolist())))
            factor = fit_factor(fitter, surface, start, means)
            surface = scaled(surface, start, factor)
        errors: dict[str, float] = dict(zip(means, numpy.sqrt(numpy.diag(covariance))))
        unknown = [key for key in means if not errors[key] <= MEANS[key][1]]
        if not unknown:
            break
        worst = max(unknown, key=lambda key: errors[key])
        reasons[worst] = f'found {getattr(surface, worst):.3g} +- {errors[worst]:.2g}: too uncertain'
        means.remove(worst)
        surface = with_values(surface, {worst: getattr(start, worst)})
    degrees = 3 * len(runs) - len(means)
    wider = widening(degrees)
    spreads = {'slip_straight_spread': 'slip_straight', 'slip_turning_spread': 'slip_turning'}
    values = {key: getattr(surface, key) for key in means}
    for key in NOISES:
        values[key] = min(1.0, wider * getattr(surface, key))
    for key, mean in spreads.items():
        values[key] = float(min(0.5, wider * numpy.hypot(getattr(surface, key), errors.get(mean, 0.0))))
    relative = (1 / (2 * degrees)) ** 0.5
    found = {key: float(values[key] * relative) for key in (*NOISES, *spreads) if values[key]}
    notes = [f'Noises and spreads are those of the starting surface times {factor:.2f}, one common factor that '
             f'{len(runs)} ends tell, and times {wider:.2f}, since {3 * len(runs)} values are few: the region of 90 % '
             "is to hold 90 % of the ends of further runs (Student's t distribution). The spreads also contain the "
             'standard errors of the mean slips.']
    warnings = [] if 1 / FAR_OFF < factor < FAR_OFF else [
        f'noise: {factor:.2f} times that of the starting surface: check the ends, and their order']
    return EndsFit({key: float(value) for key, value in values.items()}, {**errors, **found}, reasons, notes, warnings)


def ends_of(run: PreparedRun, surface: Surface) -> Windows:
    """The Windows, one, of a run, with the heading nearest to what a Surface predicts."""
    steps = run.steps(surface)
    yaw = (1 - surface.slip_turning) * steps.turn.sum() + surface.curvature * steps.straight.sum()
    return run.whole(yaw)


def scaled(surface: Surface, start: Surface, factor: float) -> Surface:
    """A Surface with the noises and spreads of another one, times a factor."""
    return with_values(surface, {key: min(0.5, factor * getattr(start, key)) for key in NOISES + SPREADS})


def fit_factor(fitter: Fitter, surface: Surface, start: Surface, means: Sequence[str]) -> float:
    """The most probable factor of all noises and spreads."""
    cost = fitter.noise_cost(surface, means)

    def total(logarithm: float) -> float:
        return cost(scaled(surface, start, numpy.exp(logarithm))) + logarithm ** 2 / (2 * PRIOR ** 2)

    return float(numpy.exp(minimize_scalar(total, bounds=numpy.log(FACTORS), method='bounded').x))


def widening(degrees: int) -> float:
    """By how much a region must be wider if its size was itself estimated, with so many degrees of freedom: the root of
    the ratio of Hotelling's T squared, for two coordinates, and chi squared."""
    return float((2 * f_distribution.ppf(PART, 2, degrees) / chi2.ppf(PART, 2)) ** 0.5)
