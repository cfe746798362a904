"""The figures of a recorded run, for a run simulated without ROS."""
import math

import pytest

import recordings
import simulated
from rbx1_nav.base.units import SECOND
from rbx1_nav.exercise.legs import out_and_back
from rbx1_nav.extras.many_runs.simulated_run import EXERCISE, TICK, Simulation, feed
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import priors

CARPET = simulated.floor('low_ply_carpet')
PRIOR = priors(CARPET)
START = 78 * TICK       # not a multiple of the period, 0.1 s


@pytest.fixture(name='recording', scope='module')
def fixture_recording():
    """The Record of a run whose filter is started at START, and loses no message."""
    found = recordings.Record([], [], {}, [], ['odom has timed out: no message for 1 s', 'Transform from a to b'])
    combined = CombinedOdometry(PRIOR, SECOND)

    def listen(snapshot, messages):
        odom = messages.odom
        found.odom.append((odom, messages.pose_variances))
        found.imu.append((messages.imu, messages.orientation))
        found.truth[odom.stamp] = tuple(snapshot.truth)
        if odom.stamp < START:
            return
        feed(combined, messages.imu, messages.odom)
        if odom.stamp % (SECOND // 10) == 0:
            estimate = combined.estimate
            found.combined.append((estimate.stamp, tuple(estimate.pose), estimate.covariance[2][2]))

    simulation = Simulation(simulated.robot(), CARPET, 3, False, False, listen=listen)
    simulation.rest(4.0)
    for motion in out_and_back(**EXERCISE):
        simulation.drive_by_time(motion)
        simulation.rest(1.0)
    simulation.rest(4.0)
    return found


def test_the_start_is_found(recording):
    assert recordings.find_start(recording, PRIOR) == START


def test_the_replay_is_what_ran_live_and_the_errors_are_those_at_the_end(recording):
    lines, metres, degrees, end_metres, end_degrees, _, port_degrees, nees = recordings.evaluate(recording, PRIOR)
    assert lines == 1
    assert metres == degrees == 0.0         # the same steps with the same numbers
    assert port_degrees == pytest.approx(end_degrees, abs=1.0)  # the gyro's error is in both
    # the truth after the end does not count
    _, end = recordings.exercise(recording)
    later = {stamp: pose if stamp <= end else (pose[0] + 1, pose[1], pose[2] + 2) for stamp, pose
             in recording.truth.items()}
    assert recordings.evaluate(recording._replace(truth=later), PRIOR)[3:5] == (end_metres, end_degrees)
    shifted = {stamp: (x, y, yaw + math.radians(10)) for stamp, (x, y, yaw) in recording.truth.items()}
    *_, other_degrees, _, _, other_nees = recordings.evaluate(recording._replace(truth=shifted), PRIOR)
    assert 10 in (pytest.approx(abs(other_degrees - end_degrees)), pytest.approx(other_degrees + end_degrees))
    assert other_nees > nees + 10
