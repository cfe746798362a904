"""A stamp of a base in real time is right, even if the process is suspended while it reads the clocks."""
from itertools import chain, repeat
from threading import Event
import time
from types import SimpleNamespace

import pytest
import rospy

from rbx1_nav.base import clocks
from rbx1_nav.base.clocks import Clock, as_ros_time

OFFSET = 1_700_000_000_123_456_789      # ns, ROS time minus the time of the other clock
MS = 1_000_000      # ns


@pytest.fixture(name='now')
def fixture_now(monkeypatch):
    """A clock, with ROS time beside it; now.suspensions: durations (ns) before each reading of either."""
    def read():
        read.time += next(read.suspensions)
        return read.time
    read.time, read.suspensions = 5000 * MS, repeat(0)
    monkeypatch.setattr(time, 'time_ns', lambda: OFFSET + read())
    return read


@pytest.mark.parametrize('instant', [0, 4967 * MS, 5000 * MS, 5033 * MS])
@pytest.mark.parametrize('suspensions', [[0], [64 * MS], [0, MS], [0, 64 * MS], [0, 0, 64 * MS], [0, 64 * MS, 64 * MS],
                                         [0, 64 * MS, 0, 0, 0, 64 * MS]])
def test_a_stamp_does_not_depend_on_suspensions(now, instant, suspensions):
    now.suspensions = chain(suspensions, repeat(0))
    assert as_ros_time(instant, now).to_nsec() == OFFSET + instant


def test_a_stamp_in_simulated_time(now, monkeypatch):
    monkeypatch.setattr(rospy.rostime, '_rostime_initialized', True)
    monkeypatch.setattr(rospy.rostime, '_rostime_current', rospy.Time(7))
    stamp = as_ros_time(4967 * MS, now)
    assert (stamp.secs, stamp.nsecs) == (6, 967 * MS)


def test_steps_follow_the_rate_and_a_late_one_is_not_made_up_for(monkeypatch):
    ended, steps, durations, now = Event(), [], iter([0, 125, 500, 0]), [3000]      # ms

    def step():
        steps.append(now[0])
        now[0] += next(durations)
        if len(steps) == 4:
            ended.set()
    monkeypatch.setattr(clocks, 'time', SimpleNamespace(monotonic=lambda: now[0] / 1000))
    # a sleep may be shorter than requested
    monkeypatch.setattr(clocks, 'life', SimpleNamespace(end_requested=ended, sleep=lambda seconds: now.append(
        now.pop() + min(round(1000 * seconds), 50))))
    Clock(4).run(step)
    assert steps == [3000, 3250, 3500, 4000] and now == [4000]
