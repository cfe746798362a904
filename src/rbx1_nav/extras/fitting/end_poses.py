"""Fits a surface to runs for which only the end pose was measured, with a tape, and reads these end poses.

A few end poses determine the mean slips and the overall size of the errors, but not each noise individually. So all
noises and spreads are multiplied by one common factor. The remaining uncertainty of the slips is added to the spreads.
"""
from __future__ import annotations

from math import exp, hypot, log1p, radians
import os
from typing import Mapping, NamedTuple, Sequence

import numpy
from scipy.optimize import minimize_scalar
from scipy.stats import chi2, f as f_distribution

from rbx1_nav.base.kinematics import Pose
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.extras.fitting.floor_fit import MEANS, Fitter, uncertainty
from rbx1_nav.extras.fitting.prediction import SPREADS, with_values
from rbx1_nav.extras.fitting.run import PreparedRun, Windows
from rbx1_nav.node.config import ConfigError, Section, load_yaml, show, show_name
from rbx1_nav.simulation.floor_noise import NOISES
from rbx1_nav.simulation.slip import floor_travel

FARTHEST, MOST = 1000.0, 36000.0    # m, degrees
ERRORS = dict(position_error=(1e-4, 10.0, 0.01, 'm'), heading_error=(0.01, 90.0, 2.0, 'degrees'))
SLIPS = ('slip_straight', 'slip_turning')
TYPICAL = dict(heading_noise_turning=0.09, heading_noise_straight=0.07, distance_noise=0.04,     # of real Creates
               slip_straight_spread=0.01, slip_turning_spread=0.01)
FACTORS = 0.02, 50.0    # limits of the factor
PRIOR = 1.0     # prior 1 sigma of the logarithm of the factor: the variation between floors
ROUNDS = 3
PART = 0.9      # share of the end poses of future runs that the region should contain


def read_ends(path: str, bags: Sequence[str]) -> tuple[list[Pose], tuple[float, float, float]]:
    """Read ([Pose of each bag], (error of x in m, of y in m, of the heading in rad)) from a YAML file. bags: paths.

    The file maps the name of each bag, without folder, to its end pose [x (m), y (m), heading (degrees)] in the frame
    of its start pose. position_error (m) and heading_error (degrees) give the measurement error. Raises ConfigError.
    """
    try:
        section = Section(load_yaml(path))
        errors = {key: section.number(key, low, high, default, unit=unit)
                  for key, (low, high, default, unit) in ERRORS.items()}
        names = [os.path.basename(bag) for bag in bags]
        twice = [name for name in names if names.count(name) > 1]
        if twice:
            raise ConfigError(f'{show_name(twice[0])}: two bags have this name: expected unique names')
        ends = [read_end(section, name) for name in names]
        if section.unknown():
            raise ConfigError(f"{section.unknown()[0]}: unknown: expected {', '.join(ERRORS)} and names of bags on "
                              'the command line')
    except ConfigError as error:
        raise ConfigError(f'{show_name(path)}: {error}') from error
    return ends, (errors['position_error'], errors['position_error'], radians(errors['heading_error']))


def read_end(section: Section, name: str) -> Pose:
    """Read the Pose of one bag. Raises ConfigError."""
    expected = '[x in m, y in m, heading in degrees]'
    values = section.get(name, expected=expected)
    if not (isinstance(values, list) and len(values) == 3):
        raise ConfigError(f'{section.path(name)}: {show(values)}: expected {expected}')
    part = Section(dict(zip(('x', 'y', 'heading'), values)), section.path(name))
    return Pose(part.number('x', -FARTHEST, FARTHEST, unit='m'), part.number('y', -FARTHEST, FARTHEST, unit='m'),
                radians(part.number('heading', -MOST, MOST, unit='degrees')))


class EndsFit(NamedTuple):
    """The result of fit_ends()."""

    values: dict[str, float]
    errors: dict[str, float]    # standard errors
    reasons: dict[str, str]     # for keys that cannot be determined
    notes: list[str]


def fit_ends(runs: Sequence[PreparedRun], surface: Surface, end_errors: Sequence[float]) -> EndsFit:
    """Fit slips, noises and spreads to the end poses of runs. end_errors: 1 sigma of x, y (m) and yaw (rad)."""
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
        unknown = [key for key in means if not uncertainty(getattr(surface, key), errors[key], MEANS[key][1]) <= 1]
        if not unknown:
            break
        worst = max(unknown, key=lambda key: errors[key])
        reasons[worst] = f'found {getattr(surface, worst):.3g} +- {errors[worst]:.2g}: too uncertain'
        means.remove(worst)
        surface = with_values(surface, {worst: getattr(start, worst)})
    degrees = max(1, 2 * (len(runs) - 1))       # the region has two coordinates
    wider = widening(degrees)
    values = {key: getattr(surface, key) for key in means}
    for key in NOISES:
        values[key] = min(1.0, wider * getattr(surface, key))
    values.update(future_spreads(surface, errors, degrees))
    reasons.update((key, 'multiplied by the common factor') for key in NOISES + SPREADS if values[key])
    notes = [f'The noises and spreads of the starting surface are multiplied by {factor:.2f} +- '
             f'{factor / (2 * degrees) ** 0.5:.2f}, one common factor fitted to {len(runs)} end poses, and by '
             f'{wider:.2f} because {len(runs)} runs are few: the 90 % region should contain 90 % of the end '
             "poses of future runs (Student's t distribution). The spreads also contain the standard errors of the "
             'mean slips.']
    return EndsFit({key: float(value) for key, value in values.items()}, errors, reasons, notes)


def ends_of(run: PreparedRun, surface: Surface) -> Windows:
    """Return the single window of a run, with the heading closest to the prediction of a Surface."""
    steps = run.steps(surface)
    _, yaw = floor_travel(surface, surface, float(steps.straight.sum()), float(steps.turn.sum()))
    return run.whole(yaw)


def scaled(surface: Surface, start: Surface, factor: float) -> Surface:
    """Return a Surface with the noises and spreads of `start` times a factor."""
    return with_values(surface, {key: min(0.5, factor * getattr(start, key)) for key in NOISES + SPREADS})


def fit_factor(fitter: Fitter, surface: Surface, start: Surface, means: Sequence[str]) -> float:
    """Return the most probable factor for all noises and spreads."""
    cost = fitter.noise_cost(surface, means)

    def total(logarithm: float) -> float:
        return cost(scaled(surface, start, numpy.exp(logarithm))) + logarithm ** 2 / (2 * PRIOR ** 2)

    return float(numpy.exp(minimize_scalar(total, bounds=numpy.log(FACTORS), method='bounded').x))


def future_spreads(surface: Surface, errors: Mapping[str, float], degrees: int) -> dict[str, float]:
    """Return the SPREADS of a Surface for runs to which it was not fitted: the root mean squares of the deviations from
    the fitted slips, widened for few degrees of freedom. errors: standard errors of slips and spreads, if fitted."""
    wider = widening(degrees)
    spreads = {}
    for key, mean in zip(SPREADS, SLIPS):
        spread = getattr(surface, key)
        # the logarithm of a fitted spread has a normal distribution: see fit_noise()
        size = exp(log1p(errors[key] / spread) ** 2) if key in errors else 1.0
        spreads[key] = min(0.5, wider * size * hypot(spread, errors.get(mean, 0.0)))
    return spreads


def widening(degrees: int) -> float:
    """Return the factor by which to widen a region whose size was estimated with `degrees` degrees of freedom: the
    square root of the ratio of Hotelling's T squared, for two coordinates, to chi squared."""
    return float((2 * f_distribution.ppf(PART, 2, degrees) / chi2.ppf(PART, 2)) ** 0.5)
