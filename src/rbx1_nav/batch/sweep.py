"""Computes all runs of a sweep that its file lacks, and shows the progress: a bar in a terminal, lines in a pipe."""
from __future__ import annotations

from array import array
import sys
import time
from typing import Iterable, Iterator, NamedTuple, Sequence, TypeVar

import numpy
from tqdm import tqdm

from rbx1_nav.batch.cases import Chunk, Combination, Row, add_row, chunks, simulate_paths, simulate_row, simulate_rows
from rbx1_nav.batch.cluster import code_version
from rbx1_nav.batch.executor import Place, in_order, open_place
from rbx1_nav.batch.runs_file import RunsFile
from rbx1_nav.config import ConfigError
from rbx1_nav.robot.description import Robot
from rbx1_nav.simulation.exercise import SimulationResult
from rbx1_nav.simulation.summary import HEADER, Summary
from rbx1_nav.units import Array

MOMENT = 1.0    # s: a bar appears after this time
PAUSE = 10.0    # s between two lines
_T = TypeVar('_T')
FORMAT = '{desc}: {n_fmt} of {total_fmt} runs, {rate_noinv_fmt}, {remaining} left'


class Progress:
    """Shows on stderr how many runs are done, how many there are in a second, and the time left."""

    def __init__(self, total: int) -> None:
        self.total, self.done, self.counted = total, 0, 0
        self.start = self.shown = time.monotonic()
        self.bar: tqdm[None] | None = None

    def add(self, runs: int, title: str, computed: bool) -> None:
        """Count runs, which were computed now or before; show the title of the current ones."""
        self.done += runs
        if not computed:
            self.counted += runs
            return
        now = time.monotonic()
        if self.bar is None and sys.stderr.isatty() and now > self.start + MOMENT:
            self.bar = tqdm(total=self.total, initial=self.done - runs, unit='run', leave=False)
        if self.bar is not None:
            self.bar.set_description(title, refresh=False)
            self.bar.update(runs)
        elif now > self.shown + PAUSE:
            rate = (self.done - self.counted) / (now - self.shown)      # since the last line: the methods differ
            self.shown, self.counted = now, self.done
            print(tqdm.format_meter(self.done, self.total, now - self.start, unit=' runs', bar_format=FORMAT,
                                    prefix=title, rate=rate), file=sys.stderr, flush=True)

    def print(self, text: str) -> None:
        """Print text to stdout, above the bar."""
        with tqdm.external_write_mode():
            print(text, flush=True)

    def close(self) -> None:
        """Remove the bar."""
        if self.bar is not None:
            self.bar.close()


class Finished(NamedTuple):
    """All runs of one method in one Combination."""

    combination: Combination
    method: str
    summary: Summary
    took: float         # s of wall time
    computed: int       # runs that were not in the file
    truths: Array       # (n, 3): the true end poses, if they were kept
    paths: list[SimulationResult]

    def lines(self) -> list[str]:
        """Return the lines below HEADER, with the speed of the simulation if runs were computed."""
        lines = self.summary.lines(self.method)
        if self.computed:
            simulated = self.summary.simulated * self.computed / self.summary.first_leg.count
            lines.append(f"{'':6} {simulated:.0f} s simulated in {self.took:.2f} s, {simulated / self.took:.0f} times "
                         'real time')
        return lines


def in_turn(values: Iterable[_T]) -> list[_T]:
    """Return the different values, in their order."""
    return list(dict.fromkeys(values))


class Sweep:
    """The runs of a command."""

    def __init__(self, combinations: Sequence[Combination], methods: Sequence[str], robot: Robot, seeds: range) -> None:
        """seeds: of each method in each Combination."""
        self.combinations, self.methods, self.robot, self.seeds = combinations, methods, robot, seeds
        self.chunks = list(chunks(combinations, methods, seeds))
        self.total = len(combinations) * len(methods) * len(seeds)
        self.progress = Progress(self.total)

    def title(self) -> str:
        """Return the lines above the table."""
        first, last, count = self.seeds[0], self.seeds[-1], len(self.combinations)
        runs, of = (('1 run', f'seed {first}') if first == last
                    else (f'{len(self.seeds)} runs', f'seeds {first} to {last}'))
        on = self.combinations[0].title() if count == 1 else f'each of {count} combinations'
        return f'{runs} of each method on {on}, {of}. Mean and standard deviation of the end poses:\n{HEADER}'

    def open_file(self, path: str, keys: Sequence[str]) -> RunsFile:
        """Return the RunsFile of this sweep. keys: titles of the columns of its values. Raises ConfigError, OSError."""
        return RunsFile(path, {
            'rbx1_nav': code_version(), 'config': self.robot, 'method': self.methods, 'seed': self.seeds[0],
            'runs': len(self.seeds),
            **{key: in_turn(each.values[key] for each in self.combinations) for key in self.combinations[0].values},
            'surface': in_turn(each.surface_name for each in self.combinations),
            'values of the surface': {each.surface_name: each.surface for each in self.combinations}}, keys)

    def run(self, jobs: int, scheduler: str | None, file: RunsFile | None = None, keep_truths: bool = False,
            paths: int = 0) -> Iterator[Finished]:
        """Compute the runs, and yield each method of each Combination when it is finished.

        jobs, scheduler: see open_place(); keep_truths: whether to return the true end poses; paths: number of runs with
        paths to return. Raises ConfigError, OSError, StuckError and the errors of the executor.
        """
        kept = Kept(keep_truths)
        start = time.monotonic()
        first = simulate_row(self.chunks[0].case(self.robot), self.seeds[0])
        long = (time.monotonic() - start) * self.total > MOMENT
        number = 0
        for chunk, rows in file.read(self.chunks) if file else ():
            self._check(number, rows, first)
            kept.add(rows)
            self.progress.add(len(rows), chunk.method, False)
            number += 1
            if chunk.is_last:
                yield kept.finished(chunk, 0.0, self._paths(None, chunk, paths))
        missing = self.chunks[number:]
        if not missing:
            return
        start = time.monotonic()
        with open_place(jobs if long else 1, scheduler, self.robot, self.chunks[0].combination.surface) as place:
            tasks = ((chunk.case(self.robot), chunk.seeds) for chunk in missing)
            for number, (chunk, rows) in enumerate(zip(missing, in_order(place, simulate_rows, tasks)), number):
                self._check(number, rows, first)
                kept.add(rows, computed=True)
                if file:
                    file.append(chunk, rows)
                self.progress.add(len(rows), chunk.method, True)
                if chunk.is_last:
                    took, start = time.monotonic() - start, time.monotonic()
                    yield kept.finished(chunk, took, self._paths(place, chunk, paths))

    def _check(self, number: int, rows: Sequence[Row], first: Row) -> None:
        if number == 0 and rows[0] != first:
            raise ConfigError(f'{self.methods[0]}, seed {self.seeds[0]}: this computer has another result for the run: '
                              'expected a file or a cluster with equal processors and libraries')

    def _paths(self, place: Place | None, chunk: Chunk, count: int) -> list[SimulationResult]:
        """Return the first results of a method, with their paths."""
        tasks = [(chunk.case(self.robot), [seed]) for seed in self.seeds[:count]]
        return [result for results in in_order(place, simulate_paths, tasks) for result in results]


class Kept:
    """What is kept of the runs of a method until all of them are done."""

    def __init__(self, keep_truths: bool) -> None:
        self.keep_truths = keep_truths
        self.summary, self.truths, self.computed = Summary(), array('d'), 0

    def add(self, rows: Sequence[Row], computed: bool = False) -> None:
        """Add runs. computed: whether they were not in the file."""
        self.computed += len(rows) if computed else 0
        for row in rows:
            add_row(self.summary, row)
            if self.keep_truths:
                self.truths.extend(row[:3])     # type: ignore[arg-type]

    def finished(self, chunk: Chunk, took: float, paths: list[SimulationResult]) -> Finished:
        """Return all runs of a method, and forget them. chunk: the last one."""
        found = Finished(chunk.combination, chunk.method, self.summary, took, self.computed,
                         numpy.array(self.truths).reshape(-1, 3), paths)
        self.summary, self.truths, self.computed = Summary(), array('d'), 0
        return found
