"""The executor on a Dask cluster, all of whose workers compute the same results: what a worker must have in common with
the program that uses it.
"""
from __future__ import annotations

from concurrent.futures import Executor, Future
from contextlib import contextmanager
import hashlib
import logging
import os
import platform
import re
import sys
import time
from typing import Any, Callable, Iterator, NamedTuple, Sequence, TypeVar
import warnings

from rbx1_nav.batch.cases import Case, Row, simulate_row
from rbx1_nav.batch.executor import Place
from rbx1_nav.config import ConfigError, show_name
from rbx1_nav.control.legs import StuckError
from rbx1_nav.robot.description import Robot
from rbx1_nav.simulation.exercise import METHODS, PARAMETERS
from rbx1_nav.simulation.surfaces import Surface

Task = TypeVar('Task')
Result = TypeVar('Result')

CONNECT = 10.0      # s until a scheduler must answer
PATIENCE = 60.0     # s without a worker after which the cluster counts as lost
COUNT = 1.0         # s between two counts of the workers

_passed: list[Requirements] = []    # what this process, a worker, has already met


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


class Cluster(Executor):
    """An executor whose tasks are computed by workers that meet the Requirements."""

    def __init__(self, client: Any, requirements: Requirements) -> None:
        """client: distributed.Client."""
        self.client, self.requirements = client, requirements
        self.executor = client.get_executor(pure=False)
        self.accepted: set[str] = set()     # addresses of workers
        self.refused: set[str] = set()
        self.counted, self.threads = 0.0, 1
        self.last_worker = time.monotonic()

    def submit(self, function: Any, *arguments: Any) -> Future[Any]:    # type: ignore[override]
        """Submit a task, which first checks its worker."""
        future: Future[Any] = self.executor.submit(checked, self.requirements, function, *arguments)
        return future

    def ask(self, question: Callable[[], Any]) -> Any:
        """Return the answer of the scheduler. Raises ConnectionError."""
        try:
            if self.client.status == 'running':
                return question()
        except Exception:       # Dask has several for it
            pass
        raise ConnectionError(f'the scheduler at {self.client.scheduler.address} is disconnected')

    def workers(self) -> dict[str, int]:
        """Return the number of threads of each worker, by address. Raises ConnectionError."""
        found: dict[str, int] = self.ask(self.client.nthreads)
        if found:
            self.last_worker = time.monotonic()
        return found

    def count(self) -> int:
        """Return the number of threads, from time to time a new one."""
        if time.monotonic() > self.counted + COUNT:
            self.threads = sum(self.workers().values()) or self.threads
            self.counted = time.monotonic()
        return self.threads

    def check(self) -> None:
        """Raise ConnectionError if the scheduler is lost, or has had no worker for some time."""
        if not self.workers() and time.monotonic() > self.last_worker + PATIENCE:
            raise ConnectionError(f'{self.client.scheduler.address} has no worker any more')

    def refusals(self) -> Iterator[tuple[str, str]]:
        """Check the workers that are new. Yield the address of each one that is refused, and the reason."""
        known = self.ask(self.client.get_versions)['workers']
        for address in self.workers():
            if address in self.accepted:
                continue
            python = known.get(address, {}).get('host', {}).get('python', '')
            if python and not python.startswith(f'{platform.python_version()}.'):
                yield address, f'Python {python}: expected {platform.python_version()}, as here'
                continue
            try:
                self.client.run(require, self.requirements, workers=[address])
                self.accepted.add(address)
            except Exception as error:      # RefusedError, or what Dask makes of an ImportError
                yield address, (f'{error}: expected a worker with the same rbx1_nav as here'
                                if 'No module' in str(error) else str(error))

    def again(self, error: BaseException) -> bool:
        """Return whether a task failed because of a worker that joined later, which is then retired."""
        if isinstance(error, ValueError):       # of the simulation
            return False
        refused = dict(self.refusals())
        for address, reason in refused.items():
            print(f'Worker {address} is refused: {reason}', file=sys.stderr)
        if refused:
            self.refused.update(refused)
            self.client.retire_workers(list(refused), close_workers=True)
        return bool(self.refused)       # other tasks may have failed there, too


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
    warnings.filterwarnings('ignore', module='distributed')
    warnings.filterwarnings('ignore', message='.*Mismatched versions')
    if address.startswith('tls:'):
        try:        # Dask itself would wait for 20 s and print a traceback
            certificate, reason = distributed.Security().get_connection_args('client')['ssl_context'], ''
        except OSError as error:
            certificate, reason = None, f': {error}'
        if not certificate:
            raise ConfigError(f'--scheduler: {show_name(address)}: expected a certificate and its key in the '
                              f'configuration of Dask (distributed.comm.tls){reason}')
    try:
        client = distributed.Client(address, timeout=CONNECT, set_as_default=False)
    except Exception as error:
        raise ConfigError(f'--scheduler: {show_name(address)}: expected the address of a Dask scheduler that runs: '
                          f'{error or type(error).__name__}') from None
    try:
        here = versions()
        check_scheduler(client, here)
        cluster = Cluster(client, Requirements(here, list(sample_runs(robot, surface))))
        for name, reason in cluster.refusals():
            raise ConfigError(f'worker {name}: {reason}')
        if not cluster.accepted:
            raise ConfigError(f'--scheduler: {show_name(address)}: no workers: expected at least one')
        yield Place(cluster, cluster.count, cluster.check, cluster.again)
    finally:
        try:
            client.close(timeout=2)
        except Exception:       # the scheduler is lost; the error that says so is more useful
            pass


def sample_runs(robot: Robot, surface: Surface | None) -> Iterator[tuple[Case, int, Row]]:
    """Yield a run of each method that does not get stuck on a surface, with its seed and its results."""
    for method in METHODS:
        case = Case(method, robot, surface, PARAMETERS)
        try:
            yield case, 0, simulate_row(case, 0)
        except StuckError:
            pass


def check_scheduler(client: Any, here: dict[str, str]) -> None:
    """Raise ConfigError if the scheduler has another version of Python, Dask or rbx1_nav."""
    scheduler = client.get_versions()['scheduler']
    there = {'Python': '.'.join(scheduler['host']['python'].split('.')[:3]), **scheduler['packages']}
    for name in ('Python', 'dask', 'distributed'):
        if there.get(name) != here[name]:
            raise ConfigError(f'scheduler {client.scheduler.address}: {name} {there.get(name)}: expected {here[name]}, '
                              'as here')
    try:
        there['rbx1_nav'] = client.run_on_scheduler(code_version)
    except Exception as error:
        if 'No module' in str(error):   # without it, the scheduler only passes on what the workers compute
            return
        raise ConfigError(f'scheduler {client.scheduler.address}: {error}') from None
    if there['rbx1_nav'] != here['rbx1_nav']:
        raise ConfigError(f"scheduler {client.scheduler.address}: rbx1_nav {there['rbx1_nav']}: expected "
                          f"{here['rbx1_nav']}, as here")
