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
import time
from typing import Any, Iterable, Iterator, Mapping, Sequence
from zlib import crc32

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.extras.many_runs.cases import RESULTS, Chunk, Row, simulate_row
from rbx1_nav.node.config import ConfigError, show, show_name
from rbx1_nav.node.files import write_file

TEXT = 'method', 'surface'      # the first columns
CHECK = 'check'     # the last column: CRC-32 of the others
SYNCHRONIZE = 1.0   # s: a power failure costs the rows of at most this time


class RunsFile:
    """The file of one command."""

    def __init__(self, path: str, command: Mapping[str, Any], swept: Sequence[str],
                 versions: Mapping[str, str]) -> None:
        """Open a file, which is continued if the same command wrote it. command: what determines the results; swept:
        the titles of the columns of a sweep; versions: for the record only. Raises ConfigError and OSError."""
        self.path, self.record = path, f'{path}.json'
        self.header = encoded([*TEXT, *swept, 'seed', *RESULTS, CHECK])
        self.synchronized = time.monotonic()
        if os.path.exists(path) and not os.path.isfile(path):
            raise ConfigError(f'--output: {show_name(path)}: expected a regular file, or a new one')
        try:
            self.file = open(path, 'ab', buffering=0)
        except OSError as error:
            raise ConfigError(f'--output: {show_name(path)}: expected a file that can be written: '
                              f'{error.strerror}') from None
        try:
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise ConfigError(f'--output: {show_name(path)}: another program is writing it') from None
        if os.path.getsize(path):
            self._compare(command)
        else:
            text = json.dumps({'versions': versions, **command}, indent=1, allow_nan=False)
            write_file(self.record, f'{text}\n'.encode())
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
        before.pop('versions', None)
        old, new = (dict(leaves(each)) for each in (before, command))
        for key in {**old, **new}:
            if old.get(key) != new.get(key):
                raise ConfigError(f'--output: {show_name(self.path)}: written with another {key}: '
                                  f'{show(old.get(key))}: expected {show(new.get(key))}, or a new file')

    def read(self, chunks: Iterable[Chunk], robot: Robot) -> Iterator[tuple[Chunk, list[Row]]]:
        """Yield the Chunks in the file, with their rows, and cut off an incomplete one. Raises ConfigError if they are
        other runs, or more, or were altered."""
        number = 1
        with open(self.path, 'rb') as file:
            header = file.readline()
            if header == self.header:
                self.size = len(header)
                for chunk in chunks:
                    lines = [file.readline() for _ in chunk.seeds]
                    if not lines[-1].endswith(b'\n'):
                        break
                    yield chunk, [self._decoded(number + index, chunk, robot, seed, line)
                                  for index, (seed, line) in enumerate(zip(chunk.seeds, lines), 1)]
                    number += len(lines)
                    self.size += sum(map(len, lines))
                else:
                    if b'\n' in file.read():
                        raise ConfigError(f'--output: {show_name(self.path)}: more rows than this command writes: '
                                          'expected a new file')
            elif header.endswith(b'\n'):
                raise ConfigError(f'--output: {show_name(self.path)}: other columns: '
                                  f'{show(header.decode(errors="replace"))}: expected '
                                  f'{show(self.header.decode())}, or a new file')
        self.file.truncate(self.size)
        if not self.size:
            self._write(self.header)

    def _decoded(self, number: int, chunk: Chunk, robot: Robot, seed: int, line: bytes) -> Row:
        """Return the RESULTS in a line. number: of the row, in which the header is row 1."""
        keys = labels(chunk, seed)
        found: list[str] = next(csv.reader([line.decode(errors='replace').rstrip('\n')]), [])
        if found[:len(keys)] != keys or len(found) != len(keys) + len(RESULTS) + 1:
            raise ConfigError(f'--output: {show_name(self.path)}: {show(line.decode(errors="replace"))}: expected '
                              f'the run {", ".join(keys)}, or a new file')
        if checked(found[:-1]) != line:
            right = next(csv.reader([checked([*keys, *simulate_row(chunk.case(robot), seed)]).decode()]))
            for name, value, expected in zip([*RESULTS, CHECK], found[len(keys):], right[len(keys):]):
                if value != expected:
                    raise ConfigError(f'--output: {show_name(self.path)}: row {number}: {name}: {show(value)}: '
                                      f'altered: expected {expected}, or a new file')
        return tuple(None if not value and name.startswith(('estimate', 'covariance')) else float(value)
                     for name, value in zip(RESULTS, found[len(keys):]))

    def append(self, chunk: Chunk, rows: Sequence[Row]) -> None:
        """Append the rows of a Chunk: all of them or, with OSError, none."""
        self._write(b''.join(checked([*labels(chunk, seed), *row]) for seed, row in zip(chunk.seeds, rows)))
        if time.monotonic() > self.synchronized + SYNCHRONIZE:
            self.synchronize()

    def synchronize(self) -> None:
        """Write all rows to the disk itself. Raises OSError."""
        os.fsync(self.file.fileno())
        self.synchronized = time.monotonic()

    def _write(self, text: bytes) -> None:
        done = 0
        try:
            while done < len(text):
                done += self.file.write(text[done:]) or 0
            self.size += len(text)
        except BaseException:
            self.file.truncate(self.size)
            raise


def leaves(value: Any, path: str = '') -> Iterator[tuple[str, Any]]:
    """Yield (path, value) of all values in nested dictionaries."""
    if not isinstance(value, dict):
        yield path, value
        return
    for key, each in value.items():
        yield from leaves(each, f'{path}/{key}' if path else key)


def labels(chunk: Chunk, seed: int) -> list[str]:
    """Return the first values of the row of a run, which name it."""
    return [chunk.method, chunk.combination.surface_name, *map(repr, chunk.combination.values.values()), str(seed)]


def checked(values: Sequence[object]) -> bytes:
    """Return a line of the file whose last value is the CRC-32 of the others, in hexadecimal digits."""
    line = encoded(values)
    return b'%s,%08x\n' % (line[:-1], crc32(line))


def encoded(values: Sequence[object]) -> bytes:
    """Return a line of the file. Each number has the digits that identify it."""
    line = io.StringIO()
    csv.writer(line, lineterminator='\n').writerow(values)
    return line.getvalue().encode()
