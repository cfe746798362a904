"""The executor on a Dask cluster, all of whose workers compute the same results: what a worker must have in common with
the program that uses it.
"""
from __future__ import annotations

from concurrent.futures import Future
from contextlib import contextmanager, suppress
from functools import partial
import hashlib
import logging
import os
import platform
import re
from typing import Any, Callable, Iterator, NamedTuple, Sequence, TypeVar
import warnings

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.exercise.legs import StuckError
from rbx1_nav.exercise.methods import METHODS
from rbx1_nav.extras.many_runs.cases import Case, Row, simulate_row
from rbx1_nav.extras.many_runs.simulated_run import PARAMETERS
from rbx1_nav.node.config import ConfigError, show_name

Task = TypeVar('Task')
Result = TypeVar('Result')

CONNECT = 10.0      # s until a scheduler must answer

_passed: list[Requirements] = []    # what this process, a worker, has already met


class Requirements(NamedTuple):
    """The versions of the program, and runs with their results."""

    versions: dict[str, str]
    runs: Sequence[tuple[Case, int, Row]]   # with the seed


class Place(NamedTuple):
    """Where tasks are computed."""

    submit: Callable[[Callable[[Any], Any], Any], Future[Any]]      # submits a task: function, argument
    jobs: Callable[[], int]     # returns the current number of processes; raises ConnectionError if a cluster is lost


def versions() -> dict[str, str]:
    """Return the version of all on which the results depend. The version of rbx1_nav is a digest of the code of a run.
    """
    import numpy
    return {'Python': platform.python_version(), 'numpy': numpy.__version__, 'rbx1_nav': code_version()}


def code_version() -> str:
    """Return a digest of the code on which the results of a run depend: all that it imports."""
    digest = hashlib.sha256()
    folder = os.path.realpath(os.path.join(os.path.dirname(__file__), *[os.pardir] * 3))
    needed = ['rbx1_nav.extras.many_runs.simulated_run', 'rbx1_nav.simulation.many_floors']
    for module in needed:       # the list grows
        with open(os.path.join(folder, *module.split('.')) + '.py', 'rb') as file:
            text = file.read()
        digest.update(text)
        for name in re.findall(rb'^from (rbx1_nav\.[\w.]+) import', text, re.MULTILINE):
            if name.decode() not in needed:
                needed.append(name.decode())
    return digest.hexdigest()[:12]


def differs(name: str, version: str, expected: str) -> str:
    """Return why a worker with another version is refused."""
    return f'{name} {version}: expected {expected}, as in the program that uses the cluster'


def require(requirements: Requirements) -> None:
    """Raise ConfigError unless this process meets Requirements. Computes the runs only the first time."""
    if requirements in _passed:
        return
    here = versions()
    for name, version in requirements.versions.items():
        if here[name] != version:
            raise ConfigError(differs(name, here[name], version))
    for case, seed, row in requirements.runs:
        if simulate_row(case, seed) != row:
            raise ConfigError(f'the {case.method} run with seed {seed} has another result there, although the '
                              'versions are equal: expected a processor and libraries that compute the same')
    _passed.append(requirements)


def checked(requirements: Requirements, function: Callable[[Task], Result], task: Task) -> Result:
    """Return function(task), on a worker, if it meets Requirements. Raises ConfigError, which names the worker."""
    try:
        require(requirements)
    except ConfigError as error:
        from distributed import get_worker
        raise ConfigError(f'worker {get_worker().address}: {error}') from None
    return function(task)


@contextmanager
def open_cluster(address: str, robot: Robot, surface: Surface | None) -> Iterator[Place]:
    """Provide the Place of a scheduler. Raises ConfigError; see open_place()."""
    if not re.fullmatch(r'(tcp|tls)://[^/\s]+:\d+', address):
        raise ConfigError(f'--scheduler: {show_name(address)}: expected tcp://HOST:PORT or tls://HOST:PORT')
    try:
        import distributed
    except ImportError as error:
        raise ConfigError(f'--scheduler: {error}: expected the Debian package python3-distributed, on Debian 11 also '
                          'python3-tornado') from None
    logging.disable(logging.CRITICAL)   # one line is enough, and it is ours
    warnings.simplefilter('ignore')
    try:
        if address.startswith('tls:') and not distributed.Security().get_connection_args('client')['ssl_context']:
            raise ConfigError('no certificate')     # Dask itself would wait for 20 s at its end
        client = distributed.Client(address, timeout=CONNECT, set_as_default=False)
    except Exception as error:
        raise ConfigError(f'--scheduler: {show_name(address)}: expected the address of a Dask scheduler that runs, '
                          "and for tls:// a certificate and its key in Dask's configuration (distributed.comm.tls): "
                          f'{error or type(error).__name__}') from None
    try:
        workers = client.nthreads()
        if not workers:
            raise ConfigError(f'--scheduler: {show_name(address)}: no workers: expected at least one')
        requirements = Requirements(versions(), list(sample_runs(robot, surface)))
        for worker in workers:
            try:
                # first, because another Python cannot read the requirements
                python = client.run(platform.python_version, workers=[worker])[worker]
                if python != requirements.versions['Python']:
                    raise ConfigError(differs('Python', python, requirements.versions['Python']))
                client.run(require, requirements, workers=[worker])
            except OSError:     # it has just gone
                pass
            except Exception as error:      # also what Dask makes of an ImportError
                raise ConfigError(f'worker {worker}: {show_name(str(error))}') from None
        # a worker that joins later checks itself
        submit = partial(connected, client.get_executor(pure=False).submit, checked, requirements)
        yield Place(submit, lambda: sum(connected(client.nthreads).values()))
    finally:
        with suppress(Exception):       # the scheduler is lost; the error that says so is more useful
            client.close(timeout=2)


# Any: Dask has no types
def connected(function: Callable[..., Any], *arguments: object) -> Any:
    """Return function(*arguments), which calls the scheduler. Raises ConnectionError."""
    try:
        return function(*arguments)
    except Exception:       # Dask has several for it
        raise ConnectionError('the scheduler is disconnected') from None


def sample_runs(robot: Robot, surface: Surface | None) -> Iterator[tuple[Case, int, Row]]:
    """Yield a run of each method that does not get stuck on a surface, with its seed and its results."""
    for method in METHODS:
        case = Case(method, robot, surface, PARAMETERS)
        with suppress(StuckError):
            yield case, 0, simulate_row(case, 0)
