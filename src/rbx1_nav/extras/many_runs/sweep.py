"""Computes all runs of a sweep that its file lacks, and shows the progress."""
from __future__ import annotations

from array import array
from math import inf
import sys
import time
from typing import Iterator, NamedTuple, Sequence

import numpy
from tqdm import tqdm

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import KEYS
from rbx1_nav.base.units import SECOND, Array
from rbx1_nav.extras.many_runs.cases import (
    Chunk, Combination, Row, add_rows, chunks, simulate_paths, simulate_row, simulate_rows)
from rbx1_nav.extras.many_runs.cluster import Place, versions
from rbx1_nav.extras.many_runs.executor import in_order, open_place
from rbx1_nav.extras.many_runs.runs_file import RunsFile
from rbx1_nav.extras.many_runs.simulated_run import SimulationResult
from rbx1_nav.extras.many_runs.summary import HEADER, Summary
from rbx1_nav.node.config import ConfigError

MOMENT = 1.0    # s: shorter sweeps show no bar, and use one process
REPORT = 10.0   # s between two lines about the progress, without a terminal


class Finished(NamedTuple):
    """All runs of one method in one Combination."""

    combination: Combination
    method: str
    summary: Summary
    truths: Array       # (n, 3): the true end poses, if they were kept
    paths: list[SimulationResult]


class Sweep:
    """The runs of a command."""

    def __init__(self, combinations: Sequence[Combination], methods: Sequence[str], robot: Robot, seeds: range) -> None:
        """seeds: of each method in each Combination. Raises ConfigError if a Combination is too fast for the robot."""
        for each in combinations:
            for key, limit in zip(('linear_speed', 'angular_speed'), robot.limits):
                if each.parameters[key] > limit:    # the base would clamp each command, and a timed run end elsewhere
                    raise ConfigError(f'{each.title()}: {key}: {each.parameters[key]:g}: expected at most {limit:g}, '
                                      f'max_{key} of --config')
        self.combinations, self.methods, self.robot, self.seeds = combinations, methods, robot, seeds
        self.chunks = list(chunks(combinations, methods, seeds))
        self.total = len(combinations) * len(methods) * len(seeds)
        self.done = 0       # runs

    def title(self) -> str:
        """Return the lines above the table."""
        first, last, count = self.seeds[0], self.seeds[-1], len(self.combinations)
        runs, of = (('1 run', f'seed {first}') if first == last
                    else (f'{len(self.seeds)} runs', f'seeds {first} to {last}'))
        on = self.combinations[0].title() if count == 1 else f'each of {count} combinations'
        return f'{runs} of each method on {on}, {of}. Mean and standard deviation of the end poses:\n{HEADER}'

    def open_file(self, path: str, keys: Sequence[str]) -> RunsFile:
        """Return the RunsFile of this sweep. keys: titles of the columns of its values. Raises ConfigError, OSError."""
        first, robot = self.combinations[0], self.robot
        swept = {key: list(dict.fromkeys(each.values[key] for each in self.combinations)) for key in first.values}
        found = versions()
        return RunsFile(path, {
            'rbx1_nav': found.pop('rbx1_nav'),
            'config': {'base_width': robot.base_width, 'rate': robot.rate, 'timeout': robot.timeout / SECOND,
                       **{f'max_{name}_speed': limit for name, limit in robot.limits._asdict().items()
                          if limit < inf}},
            'method': self.methods, 'seed': self.seeds[0], 'runs': len(self.seeds),
            **{key: value for key, value in first.parameters.items() if key not in swept}, **swept,
            'surface': {each.surface_name: each.surface and {
                key: KEYS[key].from_si(getattr(each.surface, key)) for key in KEYS if key not in swept}
                for each in self.combinations}}, keys, found)

    def run(self, jobs: int, scheduler: str | None, file: RunsFile | None = None, keep_truths: bool = False,
            paths: int = 0) -> Iterator[Finished]:
        """Compute the runs, and yield each method of each Combination when it is finished.

        jobs, scheduler: see open_place(); keep_truths: whether to return the true end poses; paths: number of runs with
        paths to return. Raises ConfigError, OSError, StuckError and the errors of the executor.
        """
        summary, truths = Summary(), array('d')
        for place, chunk, rows in self._rows(jobs, scheduler, file):
            poses = add_rows(summary, rows)
            if keep_truths:
                truths.frombytes(poses.tobytes())
            self.done += len(rows)
            if chunk.is_last:
                tasks = [(chunk.case(self.robot), [seed]) for seed in self.seeds[:paths]]
                yield Finished(chunk.combination, chunk.method, summary, numpy.array(truths).reshape(-1, 3),
                               [result for results in in_order(place, simulate_paths, tasks) for result in results])
                summary, truths = Summary(), array('d')

    def _rows(self, jobs: int, scheduler: str | None,
              file: RunsFile | None) -> Iterator[tuple[Place | None, Chunk, list[Row]]]:
        """Yield all Chunks with their rows, first those in the file, and where further runs can be computed."""
        start = time.monotonic()
        first = simulate_row(self.chunks[0].case(self.robot), self.seeds[0])
        long = (time.monotonic() - start) * self.total > MOMENT
        number = 0
        for chunk, rows in file.read(self.chunks, self.robot) if file else ():
            if number == 0 and rows[0] != first:
                raise ConfigError(f'{self.methods[0]}, seed {self.seeds[0]}: this computer has another result for the '
                                  'run: expected a file from one with an equal processor and equal libraries')
            number += 1
            yield None, chunk, rows
        missing = self.chunks[number:]
        if not missing:
            return
        before, begun, reported = self.done, time.monotonic(), 0.0
        with open_place(jobs if long else 1, scheduler, self.robot, self.chunks[0].combination.surface) as place, tqdm(
                total=self.total, initial=self.done, unit='run', leave=False, disable=None if long else True) as bar:
            tasks = ((chunk.case(self.robot), chunk.seeds) for chunk in missing)
            for chunk, rows in zip(missing, in_order(place, simulate_rows, tasks)):
                if file:
                    file.append(chunk, rows)
                bar.set_description(chunk.method, refresh=False)
                bar.update(len(rows))
                passed, done = time.monotonic() - begun, self.done + len(rows)
                if bar.disable and passed > reported + REPORT:
                    # the current rate: methods differ a lot
                    print(tqdm.format_meter(done, self.total, passed, ncols=0, prefix=chunk.method, unit='run',
                                            rate=(done - before) / (passed - reported)), file=sys.stderr, flush=True)
                    reported, before = passed, done
                yield place, chunk, rows
        if file:
            file.synchronize()
