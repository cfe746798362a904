"""The file with the results of many runs: a row for each run, in the order of the runs.

It grows by whole chunks. A second file, with `.json` appended to its name, records the command, so that only the same
command continues the file.
"""
from __future__ import annotations

import csv
import fcntl
import io
import json
import os
import signal
from typing import Any, Iterable, Iterator, Mapping, Sequence

from rbx1_nav.batch.cases import RESULTS, Chunk, Row
from rbx1_nav.config import ConfigError, show, show_name
from rbx1_nav.files import check_writable, write_file

TEXT = 'method', 'surface'      # the first columns


class RunsFile:
    """The file of one command."""

    def __init__(self, path: str, command: Mapping[str, Any], swept: Sequence[str]) -> None:
        """Open a file, which is continued if the same command wrote it. command: what determines the results; swept:
        the titles of the columns of a sweep. Raises ConfigError and OSError."""
        self.path, self.record = path, f'{path}.json'
        self.header = encoded([*TEXT, *swept, 'seed', *RESULTS])
        # as it will be read
        command = json.loads(json.dumps(command))
        exists = os.path.exists(path) and os.path.getsize(path) > 0
        if exists:
            self._compare(command)
        else:
            check_writable(path)
            write_file(self.record, (json.dumps(command, indent=1) + '\n').encode())
        self.file = open(path, 'r+b' if os.path.exists(path) else 'w+b', buffering=0)
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise ConfigError(f'--output: {show_name(path)}: another program is writing it') from None
        self.size = 0

    def _compare(self, command: Mapping[str, Any]) -> None:
        try:
            with open(self.record, encoding='utf-8') as file:
                before = json.load(file)
        except (OSError, ValueError):
            before = None
        if not isinstance(before, dict):
            raise ConfigError(f'--output: {show_name(self.path)}: no record of its command in '
                              f'{show_name(os.path.basename(self.record))}: expected a new file, or both files of an '
                              'earlier command')
        for key in {**before, **command}:
            if before.get(key) != command.get(key):
                raise ConfigError(f'--output: {show_name(self.path)}: written with another {key}: '
                                  f'{show(before.get(key))}: expected {show(command.get(key))}, or a new file')

    def read(self, chunks: Iterable[Chunk]) -> Iterator[tuple[Chunk, list[Row]]]:
        """Yield the Chunks in the file, with their rows, and cut off what follows them. Raises ConfigError if they are
        other runs."""
        with open(self.path, 'rb') as file:
            header = file.readline()
            if header == self.header:
                self.size = len(header)
                for chunk in chunks:
                    lines = [file.readline() for _ in chunk.seeds]
                    if not lines[-1].endswith(b'\n'):
                        break
                    yield chunk, self._decoded(chunk, lines)
                    self.size += sum(map(len, lines))
            elif header.endswith(b'\n'):
                raise ConfigError(f'--output: {show_name(self.path)}: other columns: expected a new file')
        if not self.size:
            self._write(self.header)
        self.file.truncate(self.size)

    def _decoded(self, chunk: Chunk, lines: Sequence[bytes]) -> list[Row]:
        rows: list[Row] = []
        for seed, line in zip(chunk.seeds, lines):
            keys = labels(chunk, seed)
            found: list[str] = next(csv.reader([line.decode(errors='replace').rstrip('\n')]), [])
            values = found[len(keys):]
            try:
                row: Row = tuple(float(value) if value else None for value in values)
            except ValueError:
                row = ()
            if found[:len(keys)] != keys or len(row) != len(RESULTS):
                raise ConfigError(f'--output: {show_name(self.path)}: {show(line.decode(errors="replace"))}: expected '
                                  f'the run {", ".join(keys)}, or a new file')
            rows.append(row)
        return rows

    def append(self, chunk: Chunk, rows: Sequence[Row]) -> None:
        """Append the rows of a Chunk: all of them or, with OSError, none."""
        self._write(b''.join(encoded([*labels(chunk, seed), *row]) for seed, row in zip(chunk.seeds, rows)))

    def _write(self, text: bytes) -> None:
        before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
        try:
            self.file.seek(self.size)
            done = 0
            while done < len(text):
                done += self.file.write(text[done:]) or 0
            os.fsync(self.file.fileno())
            self.size += len(text)
        except BaseException:
            self.file.truncate(self.size)
            raise
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


def labels(chunk: Chunk, seed: int) -> list[str]:
    """Return the first values of the row of a run, which name it."""
    return [chunk.method, chunk.combination.surface_name, *map(repr, chunk.combination.values.values()), str(seed)]


def encoded(values: Sequence[object]) -> bytes:
    """Return a line of the file. Each number has the digits that identify it."""
    line = io.StringIO()
    csv.writer(line, lineterminator='\n').writerow(values)
    return line.getvalue().encode()
