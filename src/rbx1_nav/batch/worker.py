"""What a worker of a cluster must have in common with the program that uses it. Runs on the workers."""
from __future__ import annotations

import hashlib
import os
import platform
from typing import Callable, NamedTuple, Sequence, TypeVar

from rbx1_nav.batch.cases import Case, Row, simulate_row

Task = TypeVar('Task')
Result = TypeVar('Result')

_passed: list[Requirements] = []    # what this process has already met


class Requirements(NamedTuple):
    """The versions of the program, and runs with their results."""

    versions: dict[str, str]
    runs: Sequence[tuple[Case, int, Row]]   # with the seed


class RefusedError(RuntimeError):
    """Raised on a worker that would not compute the same results."""


def versions() -> dict[str, str]:
    """Return the version of Python and of all packages on which the results depend. The version of rbx1_nav is a
    digest of its code."""
    import dask
    import distributed
    import numpy
    return {'Python': platform.python_version(), 'dask': dask.__version__, 'distributed': distributed.__version__,
            'numpy': numpy.__version__, 'rbx1_nav': code_version()}


def code_version() -> str:
    """Return a digest of the code of this package."""
    digest = hashlib.sha256()
    folder = os.path.realpath(os.path.join(os.path.dirname(__file__), '..'))
    for path, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted(names):
            if name.endswith('.py'):
                with open(os.path.join(path, name), 'rb') as file:
                    digest.update(file.read())
    return digest.hexdigest()[:12]


def require(requirements: Requirements) -> None:
    """Raise RefusedError unless this process meets Requirements. Computes the runs only the first time."""
    if requirements in _passed:
        return
    here = versions()
    for name, version in requirements.versions.items():
        if here[name] != version:
            raise RefusedError(f'{name} {here[name]}: expected {version}, as in the program that uses the cluster')
    for case, seed, row in requirements.runs:
        if simulate_row(case, seed) != row:
            raise RefusedError(f'the {case.method} run with seed {seed} has another result there, although the '
                               'versions are equal: expected a processor and libraries that compute the same')
    _passed.append(requirements)


def checked(requirements: Requirements, function: Callable[[Task], Result], task: Task) -> Result:
    """Return function(task) if this process meets Requirements. Raises RefusedError."""
    require(requirements)
    return function(task)
