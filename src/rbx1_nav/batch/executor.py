"""The executor of many runs: processes of this machine, or the workers of a Dask cluster."""
from __future__ import annotations

from collections import deque
from concurrent.futures import Executor, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
import multiprocessing
import os
import signal
import threading
from typing import Any, Callable, Deque, Iterable, Iterator, NamedTuple, TypeVar

from rbx1_nav.robot.description import Robot
from rbx1_nav.simulation.surfaces import Surface

LOOK = 1.0          # s between two checks of an executor whose result is late
AHEAD = 4           # tasks per process that are submitted before their results are needed
ATTEMPTS = 10       # of a task, if place.again() requests them
Task = TypeVar('Task')
Result = TypeVar('Result')


class Place(NamedTuple):
    """Where tasks are computed."""

    executor: Executor
    jobs: Callable[[], int]     # returns the current number of processes
    check: Callable[[], object]     # called while a result is late; raises an error if no result will come
    again: Callable[[BaseException], bool]      # whether a task that failed with this error must be submitted again


def in_order(place: Place | None, function: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Result]:
    """Yield the results of a function for all tasks, in the order of the tasks. Few of them are in memory at a time.

    place: None for this process.
    """
    if place is None:
        yield from map(function, tasks)
        return
    waiting: Deque[tuple[Task, Future[Result]]] = deque()
    for task in tasks:
        waiting.append((task, _submit(place, function, task)))
        if len(waiting) > AHEAD * place.jobs():
            yield _result(place, function, *waiting.popleft())
    while waiting:
        yield _result(place, function, *waiting.popleft())


def _submit(place: Place, function: Callable[[Task], Result], task: Task) -> Future[Result]:
    # a thread that writes to the processes inherits this mask: SIGPIPE does not reach it when they die
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGPIPE,))
    try:
        return place.executor.submit(function, task)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _result(place: Place, function: Callable[[Task], Result], task: Task, future: Future[Result]) -> Result:
    attempts = 1
    while True:
        while not future.done():
            if not wait([future], LOOK).done:
                place.check()
        try:
            return future.result()
        except Exception as error:
            if attempts == ATTEMPTS or not place.again(error):
                raise
            attempts += 1
            future = _submit(place, function, task)


@contextmanager
def open_place(jobs: int, scheduler: str | None, robot: Robot, surface: Surface | None) -> Iterator[Place | None]:
    """Provide a Place with so many local processes, or with a Dask scheduler (an address).

    It is None for one job. robot, surface: for the runs with which the workers of a cluster are checked. Raises
    ConfigError if the cluster cannot be used.
    """
    if scheduler is not None:
        from rbx1_nav.batch.cluster import open_cluster     # only now, because it imports Dask
        with open_cluster(scheduler, robot, surface) as cluster:
            yield cluster
    elif jobs == 1:
        yield None
    else:
        with ProcessPoolExecutor(jobs, initializer=_follow_the_parent) as pool:
            try:
                yield Place(pool, lambda: jobs, lambda: None, lambda error: False)
            except BaseException:       # do not wait for runs whose results are not needed
                for process in multiprocessing.active_children():
                    process.kill()
                raise


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
