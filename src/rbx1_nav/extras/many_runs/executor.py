"""The executor of many runs: processes of this machine, or the workers of a Dask cluster."""
from __future__ import annotations

from collections import deque
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
import multiprocessing
import os
import signal
import threading
from typing import Any, Callable, Deque, Iterable, Iterator, TypeVar

from rbx1_nav.base.robot_parameters import Robot
from rbx1_nav.base.surfaces import Surface
from rbx1_nav.extras.many_runs.cluster import Place, open_cluster
from rbx1_nav.node.config import ConfigError

LOOK = 1.0          # s between two checks of a cluster whose result is late
AHEAD = 4           # tasks per process that are submitted before their results are needed
Task = TypeVar('Task')
Result = TypeVar('Result')


def in_order(place: Place | None, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Result]:
    """Yield the results of a function for all tasks, in the order of the tasks. Few of them are in memory at a time.

    place: None for this process. Raises ConnectionError if a cluster is lost, and ConfigError if a worker differs.
    """
    if place is None:
        yield from map(function, tasks)
        return
    waiting: Deque[Future[Result]] = deque()
    try:
        for task in tasks:
            waiting.append(place.submit(function, task))
            if len(waiting) > AHEAD * place.jobs():
                yield _result(place, waiting.popleft())
        while waiting:
            yield _result(place, waiting.popleft())
    except CancelledError:
        raise ConnectionError('the scheduler is disconnected') from None
    finally:
        for each in waiting:        # do not compute results that are not needed
            each.cancel()


def _result(place: Place, future: Future[Result]) -> Result:
    while not wait([future], LOOK).done:
        place.jobs()
    try:
        return future.result()
    except Exception as error:
        if type(error) is not Exception:
            raise
        # what Dask makes of an error that a worker could not send: the bytes of a pickle
        raise ConfigError('a worker that joined later cannot read the runs: expected the Python and the packages of '
                          'the program that uses the cluster') from None


@contextmanager
def open_place(jobs: int, scheduler: str | None, robot: Robot, surface: Surface | None) -> Iterator[Place | None]:
    """Provide a Place with so many local processes, or with a Dask scheduler (an address).

    It is None for one job. robot, surface: for the runs with which the workers of a cluster are checked. Raises
    ConfigError if the cluster cannot be used.
    """
    if scheduler is not None:
        with open_cluster(scheduler, robot, surface) as cluster:
            yield cluster
    elif jobs == 1:
        yield None
    else:
        with ProcessPoolExecutor(jobs, initializer=_follow_the_parent) as pool:
            yield Place(pool.submit, lambda: jobs)


def add_arguments(parser: Any, jobs: int | None = os.cpu_count()) -> None:
    """Add --jobs and --scheduler to an ArgumentParser. jobs: the default."""
    parser.add_argument('--jobs', type=int, default=jobs, metavar='N', help='number of processes; default: '
                        + ('the number of processor cores' if jobs != 1 else '1'))
    parser.add_argument('--scheduler', metavar='ADDRESS',
                        help='compute on the Dask cluster of this scheduler, such as tcp://192.168.1.2:8786')


def _follow_the_parent() -> None:
    """Make a new process leave Ctrl-C to its parent, and exit when its parent exits, even if the parent is killed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_end_with_the_parent, daemon=True).start()


def _end_with_the_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent:
        parent.join()
    os._exit(1)
