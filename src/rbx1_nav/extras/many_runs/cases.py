"""What a simulated run is made of, what it results in, and the combinations of a sweep."""
from __future__ import annotations

import itertools
from typing import Iterator, Mapping, NamedTuple, Sequence, Tuple

import numpy
import yaml

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import KEYS, Surface
from rbx1_nav.base.units import Array
from rbx1_nav.exercise.legs import StuckError, out_and_back_by_odometry
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS, SimulationResult, motions, simulate
from rbx1_nav.extras.many_runs.summary import Summary
from rbx1_nav.node.config import ConfigError, Section, YamlValue, show, show_name, suggestion
from rbx1_nav.node.parameters import Parameter
from rbx1_nav.simulation.floor import Floor
from rbx1_nav.simulation.many_floors import ManyFloors

# the results of a run: name and unit of each column of a file
RESULTS = (*(f'{name}_{field}' for name in ('true', 'odometry', 'estimate')
             for field in ('x (m)', 'y (m)', 'heading (rad)')),
           *(f'covariance_{name}' for name in ('x_x (m^2)', 'x_y (m^2)', 'x_heading (m rad)', 'y_y (m^2)',
                                               'y_heading (m rad)', 'heading_heading (rad^2)')),
           'first_leg (m)', 'time (s)')
CHUNK = 2000    # runs whose wheels are computed once, and which are written together, at most
FILTERED = 200  # runs with a filter that are computed and written together, at most
CHUNKS = 100    # chunks of a method with a filter, at least

Row = Tuple[object, ...]    # the values of RESULTS; None without a filter


class Case(NamedTuple):
    """All that determines a run, except for its seed."""

    method: str
    robot: Robot
    surface: Surface | None
    parameters: Mapping[str, float]     # of the exercise


class Combination(NamedTuple):
    """One combination of a sweep."""

    surface_name: str
    values: dict[str, float]    # in the units of the declarations
    surface: Surface | None
    parameters: Mapping[str, float]

    def title(self) -> str:
        """Return the surface and the values as text."""
        return ', '.join([self.surface_name, *(f'{key} {value:g}' for key, value in self.values.items())])


class Chunk(NamedTuple):
    """Runs that are computed and written together."""

    combination: Combination
    method: str
    seeds: range
    is_last: bool       # of this combination and method

    def case(self, robot: Robot) -> Case:
        """Return the Case of its runs."""
        return Case(self.method, robot, self.combination.surface, self.combination.parameters)


def simulate_row(case: Case, seed: int, floor: Floor | None = None) -> Row:
    """Return the RESULTS of a run. Raises StuckError, which names the run. floor: see simulate()."""
    try:
        result = simulate(case.method, case.robot, case.surface, seed, parameters=case.parameters, floor=floor)
    except StuckError as error:
        raise StuckError(f'{case.method}, seed {seed}: {error}') from None
    end, covariance = result.end, result.covariance
    upper = [None if covariance is None else covariance[row][column]
             for row in range(3) for column in range(row, 3)]
    estimate = map(float, end.estimate) if end.estimate else (None,) * 3
    return (*end.truth, *end.odometry, *estimate, *upper, result.first_leg, end.time)


def simulate_rows(task: tuple[Case, Sequence[int]]) -> list[Row]:
    """Return the RESULTS of the runs of a Case with several seeds."""
    case, seeds = task
    if METHODS[case.method].filtered or len(seeds) == 1:
        return [simulate_row(case, seed) for seed in seeds]
    # only the filter, by its gyro, lets a seed reach the wheels: computed once, all runs get stuck together
    row = simulate_row(case, seeds[0], ManyFloors(case.surface, seeds) if case.surface else None)
    return list(zip(*(numpy.full(len(seeds), value).tolist() for value in row)))


def simulate_paths(task: tuple[Case, Sequence[int]]) -> list[SimulationResult]:
    """Return the results of such runs, with their paths."""
    (method, robot, surface, parameters), seeds = task
    return [simulate(method, robot, surface, seed, keep=True, parameters=parameters) for seed in seeds]


def add_rows(summary: Summary, rows: Sequence[Row]) -> Array:
    """Add the RESULTS of runs to a Summary, and return the true end poses (n, 3)."""
    values: Array = numpy.array(rows, dtype=float)      # None becomes nan
    truths, odometry, estimates = (values[:, first:first + 3] for first in (0, 3, 6))
    summary.add(truths, odometry, None if rows[0][6] is None else estimates, values[:, -2])
    return truths


def chunks(combinations: Sequence[Combination], methods: Sequence[str], seeds: range) -> Iterator[Chunk]:
    """Yield the Chunks of a sweep, in the order of the file."""
    for combination, method in itertools.product(combinations, methods):
        size = max(1, min(FILTERED, len(seeds) // CHUNKS)) if METHODS[method].filtered else CHUNK
        for start in range(0, len(seeds), size):
            yield Chunk(combination, method, seeds[start:start + size], start + size >= len(seeds))


def number_of(value: YamlValue) -> YamlValue:
    """Return a value of YAML, whose texts include 1e9, as a number if possible."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def read_sweep(texts: Sequence[str], declared: Sequence[Parameter]) -> dict[str, list[float]]:
    """Return the values of `key=a,b,c` texts by key. declared: the parameters of a driving script. Raises
    ConfigError."""
    readers = {each.name: each.read for each in declared if each.name in PARAMETERS and each.read}
    values: dict[str, list[float]] = {}
    for text in texts:
        key, _, listed = text.partition('=')
        if key not in readers and key not in KEYS:
            known = [*readers, *KEYS]
            raise ConfigError(f"--set: {show_name(key)}{suggestion(key, known)}: expected KEY=VALUE,... with one of "
                              f"{', '.join(known)}")
        if key in values:
            raise ConfigError(f'--set: {key}: given twice: expected all its values in one list')
        values[key] = []
        for each in listed.split(','):
            try:
                section = Section({key: number_of(yaml.safe_load(each or "''"))}, '--set')
            except yaml.YAMLError:
                raise ConfigError(f'--set: {key}: {show(each)}: expected a number') from None
            declaration = KEYS.get(key)
            value = (section.number(key, declaration.low, declaration.high, None, declaration.what, declaration.unit)
                     if declaration else readers[key](section))
            if value in values[key]:
                raise ConfigError(f'--set: {key}: {value:g}: given twice')
            values[key].append(value)
    return values


def combine(surfaces: Mapping[str, Surface | None], values: Mapping[str, Sequence[float]]) -> list[Combination]:
    """Return all combinations of surfaces and values. Raises ConfigError if one of them cannot be driven."""
    found = []
    for (name, surface), *each in itertools.product(surfaces.items(), *values.values()):
        chosen = dict(zip(values, each))
        of_surface = {key: KEYS[key].to_si(value) for key, value in chosen.items() if key in KEYS}
        if of_surface and surface is None:
            raise ConfigError(f"--set: {next(iter(of_surface))}: the surface {show_name(name)} has no such value: "
                              'expected another --surface')
        parameters = {**PARAMETERS, **{key: value for key, value in chosen.items() if key in PARAMETERS}}
        combination = Combination(name, chosen, surface._replace(**of_surface) if surface else None, parameters)
        try:
            motions(parameters), out_and_back_by_odometry(**parameters)
        except ValueError as error:
            raise ConfigError(f'--set: {combination.title()}: {error}') from None
        found.append(combination)
    return found


def units(keys: Sequence[str], declared: Sequence[Parameter]) -> list[str]:
    """Return the names of keys of read_sweep(), followed by their units, for a header."""
    found = {**{each.name: each.unit for each in declared}, **{name: key.unit for name, key in KEYS.items()}}
    return [f'{key} ({found[key]})' if found[key] else key for key in keys]
