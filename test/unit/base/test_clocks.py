"""A stamp of a base in real time is right, even if the process is suspended while it reads the clocks."""
from itertools import chain, repeat
import time

import pytest
import rospy

from rbx1_nav.base.clocks import as_ros_time

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
