"""The figures of a recorded run, for a run simulated without ROS."""
import math
import os

import pytest
import yaml

import replay
from rbx1_nav.base.description import read_robot
from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.base.units import SECOND
from rbx1_nav.exercise.legs import out_and_back
from rbx1_nav.extras.many_runs.simulated_run import EXERCISE, TICK, Simulation, feed
from rbx1_nav.filter.combined_odometry import CombinedOdometry
from rbx1_nav.filter.priors import priors

CONFIG = os.path.join(os.path.dirname(__file__), '..', 'config')
CARPET = load_surface('low_ply_carpet', os.path.join(CONFIG, 'surfaces'))
PRIOR = priors(CARPET)
PERIOD = SECOND // 10
START = 78 * TICK       # not a multiple of the period
STANDSTILL = 200        # ticks before and after the motions


@pytest.fixture(name='recording', scope='module')
def fixture_recording():
    """The Recording of a run whose filter is started at START, and loses no message."""
    found = replay.Recording([], [], {}, [], [], {}, [])
    combined = CombinedOdometry(PRIOR, SECOND)

    def listen(snapshot, messages):
        odom = messages.odom
        found.odom.append((odom, messages.pose_variances))
        found.imu.append((messages.imu, messages.orientation))
        found.truth[odom.stamp] = tuple(snapshot.truth)
        if odom.stamp < START:
            return
        feed(combined, messages)
        if odom.stamp % PERIOD == 0:
            estimate = combined.estimate
            found.combined.append(replay.Published(estimate.stamp, tuple(estimate.pose), estimate.covariance[2, 2]))

    with open(os.path.join(CONFIG, 'turtlebot.yaml'), encoding='utf-8') as file:
        simulation = Simulation(read_robot(yaml.safe_load(file)), CARPET, 3, False, False, listen=listen)
    simulation.rest(STANDSTILL * TICK / SECOND)
    for motion in out_and_back(**EXERCISE):
        simulation.drive_by_time(motion)
        simulation.rest(1.0)
    simulation.rest(STANDSTILL * TICK / SECOND)
    return found


def live_figures(recording):
    return replay.live_figures(recording, PRIOR, PERIOD)


def without_odometry(recording, first, count):
    """The Recording of a recorder that missed some odometry."""
    return recording._replace(odom=recording.odom[:first] + recording.odom[first + count:],
                              missing={'/odom': [(recording.odom[first + count][0].stamp, count)]})


def test_the_replay_is_what_ran_live(recording):
    row = live_figures(recording)
    assert row['same'] and row['differs_after_s'] is None
    assert row['difference_m'] == row['difference_deg'] == 0.0      # the same steps with the same numbers
    assert row['timed_out'] == row['recovered'] == row['rejected'] == 0


def test_the_start_is_found(recording):
    assert replay.find_start(recording, PRIOR) == START
    with pytest.raises(replay.Unusable, match='no odometry was recorded at the start'):
        replay.find_start(recording._replace(odom=recording.odom[200:]), PRIOR)


def test_odometry_that_was_not_recorded_is_noticed(recording):
    row = live_figures(without_odometry(recording, 600, 5))
    assert not row['same'] and row['missing'] == {'/odom': 5}


def test_what_is_lost_before_the_start_or_after_the_exercise_does_not_count(recording):
    for first in 20, len(recording.odom) - 20:
        row = live_figures(without_odometry(recording, first, 5))
        assert row['same'] and row['missing'] == {'/odom': 0}
    assert live_figures(recording._replace(statistics=[(0, START - 1, 3)]))['same']


def test_what_the_filter_lost_is_noticed(recording):
    row = live_figures(recording._replace(statistics=[(0, START + SECOND, 1), (5 * SECOND, 6 * SECOND, 2)]))
    assert row['dropped'] == 3 and not row['same']


def test_other_stamps_than_those_of_the_replay_are_noticed(recording):
    combined = [each._replace(stamp=each.stamp + TICK) if each.stamp == 10 * SECOND else each
                for each in recording.combined]
    row = live_figures(recording._replace(combined=combined))
    assert not row['scheduled'] and not row['same']


@pytest.mark.parametrize('published, good', [
    ([0, 100, 200, 300], True),
    ([0, 110, 200, 300], False),        # in time at 100
    ([0, 100, 300], False),             # 200 is missing
    ([0, 101, 200], False),             # no estimate
])
def test_a_schedule(published, good):
    assert replay.is_scheduled(published, list(range(-10, 400, 10)), 100) == good


def test_a_schedule_on_irregular_stamps():
    stamps = [0, 21, 39, 62, 79, 102, 118, 141, 163, 179, 199, 221]
    # due at 20, 120, and 220
    assert replay.is_scheduled([21, 141, 221], stamps, 100)
    assert not replay.is_scheduled([39, 118, 221], stamps, 100)     # due after 21, and at most 100 later at 118


def test_the_errors_are_those_at_the_end_of_the_exercise(recording):
    row = replay.end_figures(recording, PRIOR)
    begin, end = replay.exercise(recording)
    estimate = replay.replay(recording, PRIOR, begin, end)[end]
    truth = recording.truth[end]
    assert row['error_m'] == pytest.approx(math.hypot(estimate.pose.x - truth[0], estimate.pose.y - truth[1]))
    # the truth after the end does not count
    later = {stamp: pose if stamp <= end else (pose[0] + 1, pose[1], pose[2] + 2) for stamp, pose
             in recording.truth.items()}
    assert replay.end_figures(recording._replace(truth=later), PRIOR) == row
    shifted = {stamp: (x, y, yaw + math.radians(10)) for stamp, (x, y, yaw) in recording.truth.items()}
    other = replay.end_figures(recording._replace(truth=shifted), PRIOR)
    assert abs(other['error_deg'] - row['error_deg']) == pytest.approx(10) or (
        other['error_deg'] + row['error_deg'] == pytest.approx(10))
    assert other['nees'] > row['nees'] + 10


def test_the_port_follows_the_gyro(recording):
    row = replay.end_figures(recording, PRIOR)
    assert row['port_deg'] == pytest.approx(row['error_deg'], abs=1.0)  # the gyro's error is in both
    turned = recording._replace(imu=[(imu, (0.0, variance)) for imu, (_, variance) in recording.imu])
    assert replay.end_figures(turned, PRIOR)['port_deg'] > 30


def test_a_run_without_enough_standstill_cannot_be_evaluated(recording):
    with pytest.raises(replay.Unusable, match='stationary for less than 2 s'):
        replay.exercise(recording._replace(odom=recording.odom[STANDSTILL - 50:]))
    with pytest.raises(replay.Unusable, match='did not move'):
        replay.exercise(recording._replace(odom=recording.odom[:STANDSTILL]))
    late = [each for each in recording.combined if each.stamp > 3 * SECOND]
    with pytest.raises(replay.Unusable, match='started less than 2 s before'):
        live_figures(recording._replace(combined=late))


def test_gaps_are_where_sequence_numbers_are_missing():
    assert replay.gaps([(4, 40), (5, 50), (8, 80), (9, 90)]) == [(80, 2)]
    assert replay.gaps([(1, 10)]) == [] and replay.gaps([]) == []


def test_a_line_may_stand_for_several():
    lines = ['odom has timed out: no message for more than 1 s; not used until it recovers (and 4 more of this kind)',
             'odom has recovered', 'odom has recovered (and 2 more of this kind)', 'Transform from a to b',
             '/odom: header.stamp: 1: expected another; rejected (and 12 more of this kind)']
    assert replay.count_lines(lines) == dict(timed_out=5, recovered=4, rejected=13)


def test_misses():
    good = dict(seed=1, timed_out=0, recovered=0, rejected=0, same=True, difference_m=0.0009, difference_deg=0.09,
                error_m=0.01, port_m=0.02, error_deg=0.3, port_deg=0.4, nees=3.0)
    assert replay.misses([good, good]) == []
    for change in (dict(recovered=1), dict(difference_m=0.0011), dict(difference_deg=math.nan), dict(error_m=0.05),
                   dict(error_deg=0.6), dict(nees=8.0), dict(nees=-2.0)):
        assert len(replay.misses([good, dict(good, **change)])) == 1
    assert replay.misses([dict(good, same=False, difference_m=1.0)]) == []
