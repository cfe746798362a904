"""What the exercise without ROS consists of: its motions and pauses, and its processes."""
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from itertools import groupby
from math import pi
import multiprocessing
import os
import signal
import subprocess
import sys
import time

import pytest

from rbx1_nav.robot.description import load_robot
from rbx1_nav.simulation.exercise import simulate, simulate_many
from sample_surface import SURFACE

TURTLEBOT = load_robot(os.path.join(os.path.dirname(__file__), '..', '..', '..', 'config', 'turtlebot.yaml'))


def standstills(run):
    """Return for how many ticks the robot of a run was stationary, each time."""
    lengths = [len(list(same)) for _, same in groupby(snapshot.truth for snapshot in run.path)]
    # the tick in which the robot arrives, except at the origin
    return [lengths[0], *(length - 1 for length in lengths[1:] if length > 1)]


def test_the_timed_exercise_takes_as_long_as_its_motions_and_pauses():
    run = simulate('timed', TURTLEBOT, None, 0, keep=True)
    # 2 s for the calibration, 1 m at 0.2 m/s and pi at 1 rad/s twice, and 1 s after each motion
    assert standstills(run) == [100, 50, 50, 50, 50]
    assert len(run.path) == 100 + 2 * (250 + 157) + 4 * 50
    assert run.path[0].time == pytest.approx(0.02) and run.end == run.path[-1]
    assert run.end.time == pytest.approx(len(run.path) / 50)
    assert run.first_leg == pytest.approx(1.0)
    assert run.covariance is None and run.end.estimate is None


@pytest.mark.parametrize('method', ['odom', 'ekf'])
def test_each_leg_has_a_trial_stop_of_half_a_second(method):
    run = simulate(method, TURTLEBOT, None, 0, keep=True)
    assert standstills(run) == [100] + [25, 50] * 4
    # half of the slowest travel per tick, 0.5 mm, for odometry that is exact
    assert run.first_leg == pytest.approx(1.0, abs=0.00051)
    assert (run.covariance is not None) is (run.end.estimate is not None) is (method == 'ekf')


def test_the_legs_have_the_speeds_of_the_tutorial():
    path = simulate('odom', TURTLEBOT, None, 0, keep=True).path
    turns = [50 * (after.truth.yaw - before.truth.yaw) for before, after in zip(path, path[1:])]
    speeds = [50 * (after.truth.x - before.truth.x) for before, after in zip(path, path[1:])]
    # rounding errors of differences of poses
    slowest = [min(each for each in values if each > 1e-6) for values in (speeds[:500], turns)]
    assert [max(speeds[:500]), max(turns)] == pytest.approx([0.2, 1.0], rel=1e-6)
    assert slowest == pytest.approx([0.05, 0.2], rel=1e-6)
    assert path[-1].truth.yaw == pytest.approx(2 * pi, abs=0.01)    # a slowest tick in each turn: 0.004 rad


def test_who_listens_is_called_at_each_tick_and_receives_the_readings_of_the_base():
    heard = []
    run = simulate('timed', TURTLEBOT, None, 0, keep=True, listen=lambda *each: heard.append(each))
    assert [snapshot for snapshot, _ in heard] == run.path
    for snapshot, messages in heard[::50]:
        assert messages.odom.stamp == messages.imu.stamp == round(snapshot.time * 1e9)
        assert messages.odom.pose == snapshot.odometry
        assert messages.orientation == pytest.approx((snapshot.truth.yaw, 1e-6))
        assert messages.pose_variances == (1e-6,) * 3
    assert {round(messages.imu.rate, 9) for _, messages in heard} == {0.0, 1.0}


@pytest.mark.parametrize('jobs', [1, 2])
def test_no_seeds_have_no_results(jobs):
    assert not list(simulate_many('timed', TURTLEBOT, None, [], jobs=jobs))


def test_more_runs_than_are_submitted_in_advance_keep_their_order():
    # with two processes, nine chunks are more than those that are submitted in advance
    single, parallel = (simulate_many('timed', TURTLEBOT, SURFACE, range(9), jobs=jobs) for jobs in (1, 2))
    assert list(single) == list(parallel)


@pytest.fixture(name='many')
def make_many():
    """Return the results of more runs than any test waits for, after the first one."""
    runs = simulate_many('timed', TURTLEBOT, SURFACE, range(500), jobs=2)
    next(runs)
    yield runs
    runs.close()


def test_closing_the_results_stops_the_processes(many):
    assert multiprocessing.active_children()
    many.close()
    assert not multiprocessing.active_children()


def test_a_process_that_is_killed_is_an_error(many):
    os.kill(multiprocessing.active_children()[0].pid, signal.SIGKILL)
    with pytest.raises(BrokenProcessPool):
        list(many)


@pytest.fixture(name='handler')
def set_handler():
    """Handle SIGTERM in this process, as the nodes do."""
    before = signal.signal(signal.SIGTERM, lambda *_: None)
    yield
    signal.signal(signal.SIGTERM, before)


def signals(pid, key):
    """Return the mask of signals that a process ignores (SigIgn) or handles (SigCgt)."""
    with open(f'/proc/{pid}/status', encoding='ascii') as file:
        return next(int(line.split()[1], 16) for line in file if line.startswith(key))


@pytest.mark.usefixtures('handler', 'many')
def test_the_processes_leave_ctrl_c_to_their_parent_but_can_be_terminated():
    children = [child.pid for child in multiprocessing.active_children()]
    assert children and signals(os.getpid(), 'SigCgt') & 1 << signal.SIGTERM - 1
    deadline = time.monotonic() + 60    # a process may still be starting
    while time.monotonic() < deadline and not all(
            signals(pid, 'SigIgn') & 1 << signal.SIGINT - 1 and not signals(pid, 'SigCgt') & 1 << signal.SIGTERM - 1
            for pid in children):
        time.sleep(0.01)
    assert all(signals(pid, 'SigIgn') & 1 << signal.SIGINT - 1 for pid in children)
    assert not any(signals(pid, 'SigCgt') & 1 << signal.SIGTERM - 1 for pid in children)


KILLED = """
import os, signal, sys
sys.path[:0] = sys.argv[1:]
from test_exercise_plan import SURFACE, TURTLEBOT, simulate_many
runs = simulate_many('timed', TURTLEBOT, SURFACE, range(500), jobs=2)
next(runs)
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
