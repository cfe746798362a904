"""Tasks on several processes: order, few tasks in memory, and the life of the processes."""
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
import multiprocessing
import os
import signal
import subprocess
import sys
import time

import pytest

from rbx1_nav.extras.many_runs.cluster import Place
from rbx1_nav.extras.many_runs.executor import AHEAD, in_order, open_place
from rbx1_nav.node.config import ConfigError


def double(number):
    """A task that takes longer if it was submitted earlier."""
    time.sleep(max(0.0, 0.01 - 0.001 * number))
    return 2 * number


def slow(number):
    """A task that is never waited for."""
    time.sleep(0.05)
    return number


@pytest.mark.parametrize('jobs', [1, 2])
def test_the_results_have_the_order_of_the_tasks(jobs):
    with open_place(jobs, None, None, None) as place:
        assert list(in_order(place, double, range(20))) == list(range(0, 40, 2))
        assert not list(in_order(place, double, []))


def test_few_tasks_are_submitted_before_their_results_are_needed():
    taken = []
    with open_place(2, None, None, None) as place:
        results = in_order(place, double, (taken.append(number) or number for number in range(100)))
        assert next(results) == 0 and len(taken) == 2 * AHEAD + 1


def test_an_error_stops_the_processes():
    with pytest.raises(KeyError):
        with open_place(2, None, None, None) as place:
            next(in_order(place, slow, range(10 ** 6)))
            assert multiprocessing.active_children()
            raise KeyError
    assert not multiprocessing.active_children()


def test_a_process_that_is_killed_is_an_error():
    with open_place(2, None, None, None) as place:
        results = in_order(place, slow, range(10 ** 6))
        next(results)
        os.kill(multiprocessing.active_children()[0].pid, signal.SIGKILL)
        with pytest.raises(BrokenProcessPool):
            list(results)


def test_a_worker_that_joins_later_and_cannot_read_the_tasks():
    """The error is as Dask 2022.12.1 gave it for a worker with Python 3.8 and without numpy."""
    future = Future()
    future.set_exception(Exception(b'\x80\x05\x95tblib.pickling_support'))
    with pytest.raises(ConfigError, match='^a worker that joined later cannot read the runs: expected the Python'):
        list(in_order(Place(lambda function, task: future, lambda: 1), abs, [-1]))


KILLED = """
import os, signal, sys
sys.path[:0] = sys.argv[1:]
from test_executor import in_order, open_place, slow
with open_place(2, None, None, None) as place:
    next(in_order(place, slow, range(10 ** 6)))
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_processes_exit_with_a_parent_that_is_killed():
    with subprocess.Popen([sys.executable, '-c', KILLED, os.path.dirname(__file__), *sys.path], stdout=subprocess.PIPE,
                          start_new_session=True) as parent:
        try:
            # the output is complete when the last process has exited; 20 s are enough on a busy machine
            assert parent.communicate(timeout=20) == (b'', None) and parent.returncode == -signal.SIGKILL
        finally:
            with suppress(ProcessLookupError):
                os.killpg(parent.pid, signal.SIGKILL)
