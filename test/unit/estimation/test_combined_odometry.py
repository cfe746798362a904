"""The combined odometry: the order of messages, rejected messages, dropouts, jumps and restarts."""
from itertools import count
from math import cos, pi, sin, sqrt

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rbx1_nav.estimation.combined_odometry import CombinedOdometry
from rbx1_nav.estimation.model import BIAS, X, Y, YAW
from rbx1_nav.estimation.priors import UNKNOWN_FLOOR
from rbx1_nav.estimation.inputs import Imu, Odom, RejectedMessage
from rbx1_nav.estimation.limits import Limits
from rbx1_nav.robot.kinematics import ORIGIN, Pose, arc
from rbx1_nav.units import SECOND
from sample_priors import IDEAL, PRIORS
from test_inputs import BAD_ODOMETRY, BAD_READINGS, VARIANCES, with_field

STEP = SECOND // 50


class Robot:
    """Sends the messages of a robot without errors every 0.02 s."""

    def __init__(self, prior=PRIORS, **options):
        self.warnings = []
        self.combined = CombinedOdometry(prior, SECOND, warn=self.warnings.append, **options)
        self.now = 1000 * SECOND
        self.pose = Pose(0.0, 0.0, 0.0)

    def send(self, ticks=1, linear=0.0, angular=0.0, odom=True, imu=True, bias=0.0):
        """Move for a number of ticks, and send what both sensors measure; returns the last Estimate."""
        for _ in range(ticks):
            self.now += STEP
            self.pose = arc(self.pose, linear * 0.02, angular * 0.02)
            if imu:
                self.combined.add_imu(self.now, Imu(self.now, angular + bias, 3e-6))
            if odom:
                self.combined.add_odom(self.now, self.odom(), VARIANCES)
        return self.combined.estimate

    def odom(self):
        """The odometry of now."""
        return Odom(self.now, self.pose, 1e-6, 1e-6)


def exact(estimate, pose, abs=1e-9):
    """Whether an Estimate is at a Pose."""
    return estimate.pose == pytest.approx(pose, abs=abs)


def test_the_estimate_follows_sensors_without_errors_exactly():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.send(100, 0.2, 0.5)
    robot.send(100, -0.1, -1.0)
    assert exact(robot.combined.estimate, robot.pose)


def test_the_estimate_starts_at_the_pose_of_the_odometry():
    robot = Robot()
    robot.pose = Pose(3.0, -2.0, 1.0)
    assert exact(robot.send(), robot.pose)


def test_the_bias_is_estimated_at_standstill():
    robot = Robot()
    robot.send(100, bias=0.01)
    state = robot.combined.filter.state
    assert state[BIAS] == pytest.approx(0.01, abs=1e-4)
    # it turned as little as the wheels report, not by the 0.02 rad of the gyro
    assert abs(state[YAW]) < 1e-4


# contradictions

def turn_with_wheels(robot, ticks, factor, linear=0.0, angular=1.0, bias=0.0):
    """Drive a robot whose odometry reports a multiple of each turn; returns the last Estimate."""
    wheels = robot.pose
    for _ in range(ticks):
        robot.send(1, linear, angular, odom=False, bias=bias)
        wheels = arc(wheels, linear * 0.02, factor * angular * 0.02)
        robot.combined.add_odom(robot.now, Odom(robot.now, wheels, 1e-6, 1e-6), VARIANCES)
    robot.pose = wheels
    return robot.combined.estimate


def test_wheels_and_gyro_that_contradict_each_other_are_reported_and_make_the_heading_uncertain():
    robot = Robot()
    robot.send(100)
    estimate = turn_with_wheels(robot, 500, -1.0)
    assert robot.combined.contradicts and len(robot.warnings) == 1
    # they differ by 20 rad. The last turn, of 2 rad at most, may not be significant yet; the wrong slip that is learned
    # may add a tenth
    assert 15.0 < sqrt(estimate.covariance[2, 2]) < 22.0


def test_a_contradiction_is_shown_for_5_seconds():
    robot = Robot()
    robot.send(100)
    turn_with_wheels(robot, 74, -1.0)
    # a turn of less than 1.5 rad, here at 1 rad/s, is not enough evidence
    assert not robot.combined.contradicts
    turn_with_wheels(robot, 10, -1.0)
    assert robot.combined.contradicts
    # 5 s, less up to 10 ticks since the contradiction was noticed
    robot.send(239)
    assert robot.combined.contradicts
    robot.send(11)
    assert not robot.combined.contradicts


def test_a_slip_that_the_floor_does_not_have_is_reported_as_another_floor():
    robot = Robot(IDEAL)
    robot.send(100)
    turn_with_wheels(robot, 500, 1.08)
    assert robot.combined.doubts.another_floor and not robot.combined.contradicts and len(robot.warnings) == 1


@pytest.mark.parametrize('motion', [
    # the gyro reports -0.04 rad/s at standstill, and 0.01 rad/s in a turn at 0.05 rad/s
    dict(factor=1.0, angular=0.05, bias=-0.04),
    # a curve of 60 m, in which unequal wheels may turn the robot by 0.066 rad times the square root of the distance
    dict(factor=1.6, linear=0.5, angular=0.06)])
def test_neither_a_bias_in_a_slow_turn_nor_unequal_wheels_in_a_long_curve_are_a_contradiction(motion):
    robot = Robot(UNKNOWN_FLOOR)
    robot.send(500, bias=motion.get('bias', 0.0))
    turn_with_wheels(robot, 6000, **motion)
    assert not robot.warnings


# rejected messages

def check_rejected(make_message, text, same_time=False):
    """A message is rejected with a text that contains this one, and leaves no trace.

    make_message(robot): the arguments of add_odom() or add_imu(); same_time: whether it comes after the valid messages
    of its time, and not before them.
    """
    robot, undisturbed = Robot(), Robot()
    for each in (robot, undisturbed):
        each.send(50, 0.2, 0.5)
    if not same_time:
        robot.now += STEP
    message = make_message(robot)
    add = robot.combined.add_imu if isinstance(message[0], Imu) else robot.combined.add_odom
    with pytest.raises(RejectedMessage) as error:
        add(robot.now, *message)
    assert text in str(error.value) and ': expected a' in str(error.value) and '\n' not in str(error.value)
    if not same_time:
        robot.now -= STEP
    robot.send(50, 0.2, 0.5)
    undisturbed.send(50, 0.2, 0.5)
    assert robot.combined.filter.state == undisturbed.combined.filter.state
    assert not robot.warnings


@pytest.mark.parametrize('field, value', BAD_ODOMETRY)
def test_rejected_odometry_leaves_no_trace(field, value):
    check_rejected(lambda robot: with_field(robot.odom(), VARIANCES, field, value), field)


@pytest.mark.parametrize('field, rate, variance', BAD_READINGS)
def test_a_rejected_gyro_reading_leaves_no_trace(field, rate, variance):
    check_rejected(lambda robot: (Imu(robot.now, rate, variance),), field)


@pytest.mark.parametrize('offset', [0, -1, -3600 * SECOND, 10 * SECOND])
def test_stamps_out_of_order_or_from_the_future_are_rejected(offset):
    check_rejected(lambda robot: (robot.odom()._replace(stamp=robot.now + offset), VARIANCES), 'header.stamp', True)
    check_rejected(lambda robot: (Imu(robot.now + offset, 0.0, 1e-6),), 'header.stamp', True)


def test_a_first_stamp_that_is_too_old_is_rejected():
    robot = Robot()
    with pytest.raises(RejectedMessage, match='^header.stamp: 0.000000000: expected a stamp not much older than now'):
        robot.combined.add_odom(robot.now, robot.odom()._replace(stamp=0), VARIANCES)


def test_a_restart_does_not_make_old_stamps_acceptable():
    robot = Robot()
    robot.send(10)
    robot.combined.restart('test')
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
    robot.send(2)
    robot.pose = Pose(5.0, 0.0, 0.0)
    robot.send(2)
    with pytest.raises(RejectedMessage, match='later than the last'):
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)


@given(st.lists(st.tuples(st.sampled_from(['odom', 'imu']), st.floats() | st.sampled_from([0.0, 0.001, 5.0, 5.001]),
                          st.floats() | st.sampled_from([1e-12, 1e-6, 1.0, 1e12]),
                          st.integers(-10 ** 10, 10 ** 10) | st.sampled_from([0, -STEP])), max_size=40))
def test_no_sequence_of_messages_makes_the_estimate_infinite(messages):
    robot = Robot()
    robot.send(10)
    for kind, value, variance, offset in messages:
        robot.now += STEP
        stamp = robot.now + offset
        try:
            if kind == 'odom':
                robot.combined.add_odom(robot.now, Odom(stamp, Pose(value, -value, value), variance, variance),
                                        (variance, variance, variance))
            else:
                robot.combined.add_imu(robot.now, Imu(stamp, value, variance))
        except RejectedMessage:
            pass
    estimate = robot.combined.estimate
    if estimate:
        assert numpy.isfinite(estimate.pose).all() and numpy.isfinite(estimate.covariance).all()


def test_without_variances_of_the_speeds_those_of_the_pose_are_used():
    robot = Robot()
    robot.send(10)
    robot.now += STEP
    robot.combined.add_imu(robot.now, Imu(robot.now, 0.0, 1e-6))
    robot.combined.add_odom(robot.now, Odom(robot.now, robot.pose, 0.0, 0.0), (0.1, 0.1, 0.2))
    assert robot.combined.odom.linear_variance == 0.1 and robot.combined.odom.angular_variance == 0.2


# dropouts

def test_a_gyro_times_out_and_recovers():
    robot = Robot(IDEAL)
    robot.send(50, 0.2, 0.5)
    robot.send(40, 0.2, 0.5, imu=False)
    behind = robot.combined.estimate
    assert not robot.warnings and not exact(behind, robot.pose)     # it waits: the gyro may only be late
    robot.send(60, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and robot.combined.timed_out['imu_data']
    robot.send(60, 0.2, 0.5)
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.timed_out['imu_data']
    assert robot.warnings == ['imu_data has timed out: no valid message for more than 1 s; not used until it recovers',
                              'imu_data has recovered']


def test_a_gyro_without_any_message_times_out_too():
    robot = Robot(IDEAL)
    robot.send(60, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and 'imu_data has timed out' in robot.warnings[0]


def test_a_gyro_that_is_not_used_is_not_waited_for():
    robot = Robot(IDEAL, gyro_used=False)
    robot.send(2, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and not robot.warnings


def test_without_a_gyro_the_heading_is_as_uncertain_as_the_odometry_reports():
    robot = Robot(IDEAL, gyro_used=False)
    before = robot.send(imu=False)
    for _ in range(10):
        robot.now += STEP
        robot.combined.add_odom(robot.now, Odom(robot.now, robot.pose, 1e-2, 1e-3), VARIANCES)
    # variance of an angular velocity, times the square of 0.02 s, in each step
    assert robot.combined.estimate.covariance[2, 2] - before.covariance[2, 2] == pytest.approx(10 * 1e-3 * 0.02 ** 2)


def test_odometry_times_out_and_its_travel_meanwhile_counts_when_it_recovers():
    robot = Robot(IDEAL)
    robot.send(50, 0.2)
    last = robot.pose
    robot.send(100, 0.0, 0.5, odom=False)
    estimate = robot.combined.estimate
    # meanwhile the gyro measures the turn
    assert robot.combined.timed_out['odom'] and exact(estimate, last._replace(yaw=robot.pose.yaw))
    # and no sensor the travel: 0.5 m/s for 2 s
    assert estimate.covariance[X, X] > 0.9 and estimate.covariance[Y, Y] > 0.9
    robot.send(100, 0.2, 0.0, odom=False)
    robot.send(1, 0.2, 0.0)
    # the wheels report a straight displacement since the dropout, the gyro has reported the turn
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.timed_out['odom']
    assert robot.combined.estimate.covariance[X, X] < 1e-3


@pytest.mark.parametrize('late', [-1, 0, 1])
def test_odometry_times_out_when_stamps_and_arrivals_are_ahead_by_more_than_the_timeout(late):
    robot = Robot(IDEAL)
    last = robot.send(50).stamp
    for ahead in range(1, 60):      # ticks from the odometry to a reading; the timeout is 50
        stamp = last + ahead * STEP
        robot.combined.add_imu(stamp + late * STEP, Imu(stamp, 0.0, 3e-6))
        timed_out = ahead > 50 and ahead + late > 50
        assert robot.combined.timed_out['odom'] == timed_out
        assert robot.combined.estimate.stamp == (stamp if timed_out else last)


def test_odometry_that_waits_for_a_late_gyro_has_not_timed_out():
    robot = Robot(IDEAL)
    last = robot.send(50).stamp
    pending = last + 3 * SECOND
    for stamp in range(last + STEP, pending + 1, STEP):     # readings come 2.5 s late
        if robot.now == pending:
            robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
        assert robot.combined.estimate.stamp == last
        robot.now = stamp + 5 * SECOND // 2
        robot.combined.add_imu(robot.now, Imu(stamp, 0.0, 3e-6))
    assert robot.combined.estimate.stamp == pending and not robot.warnings


def test_a_turn_while_both_sensors_are_silent_is_as_uncertain_as_the_odometry_over_the_whole_dropout():
    robot = Robot(IDEAL)
    robot.send(50)
    before = robot.send(100, 0.0, 2.0, odom=False)      # 2 s and more than half a turn, measured by the gyro
    assert exact(before, robot.pose)
    robot.now += 3 * SECOND // 2
    robot.combined.add_odom(robot.now, Odom(robot.now, robot.pose, 1e-2, 1e-3), VARIANCES)
    robot.combined.add_imu(robot.now, Imu(robot.now, 0.0, 3e-6))
    after = robot.combined.estimate
    assert after.stamp == robot.now and exact(after, robot.pose)
    # the wheels have had less noise than they claim
    assert after.covariance[2, 2] - before.covariance[2, 2] == pytest.approx(1e-3 * 3.5 ** 2, rel=0.2)


@pytest.mark.parametrize('odom_first', [True, False])
def test_odometry_that_recovers_in_a_turn_does_not_count_it_again(odom_first):
    robot = Robot()     # its wheels slip by the 3 % that the filter expects, and it turns at 0.5 rad/s
    for tick in range(300):
        robot.now += STEP
        wheels = Odom(robot.now, Pose(0.0, 0.0, 0.5 * 0.02 * tick / 0.97), 1e-6, 1e-5)
        odom = (robot.combined.add_odom, wheels, VARIANCES)
        imu = (robot.combined.add_imu, Imu(robot.now, 0.5 if tick else 0.0, 3e-6))
        for add, *message in (odom, imu) if odom_first else (imu, odom):
            if add is imu[0] or not 50 < tick < 200:
                add(robot.now, *message)
    assert robot.combined.filter.state[YAW] == pytest.approx(0.5 * 0.02 * tick, abs=1e-3)
    assert len(robot.warnings) == 2


def test_readings_without_any_odometry_are_not_stored():
    robot = Robot()
    robot.send(1000, odom=False)
    assert not robot.combined.readings.waiting


def test_readings_at_the_limit_of_the_measurement_range_are_not_used():
    robot = Robot()
    robot.send(100)
    limit = PRIORS.gyro_measurement_range
    for _ in range(50):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.0, 4.0 * 0.02)
        robot.combined.add_imu(robot.now, Imu(robot.now, limit, 3e-6))
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
    assert robot.combined.filter.state[YAW] == pytest.approx(4.0 * 0.97, abs=1e-3)


def send_late(odom_lag, imu_lag):
    """Ten seconds of a robot whose messages come late (s); it, and where it was at the stamp of the last estimate."""
    robot, poses = Robot(IDEAL), {}
    for _ in range(500):
        robot.now += STEP
        robot.pose = poses[robot.now] = arc(robot.pose, 0.004, 0.01)
        stamp = robot.now - round(odom_lag * SECOND)
        if stamp in poses:
            robot.combined.add_odom(robot.now, Odom(stamp, poses[stamp], 1e-6, 1e-6), VARIANCES)
        robot.combined.add_imu(robot.now, Imu(robot.now - round(imu_lag * SECOND), 0.5, 3e-6))
    return robot, poses[robot.combined.estimate.stamp]


@pytest.mark.parametrize('odom_lag, imu_lag', [(0.0, 1.1), (0.0, 4.0), (1.1, 0.0), (8.0, 0.0)])
def test_a_sensor_that_is_always_late_is_waited_for(odom_lag, imu_lag):
    robot, pose = send_late(odom_lag, imu_lag)
    assert not robot.warnings and exact(robot.combined.estimate, pose)
    behind = (robot.now - robot.combined.estimate.stamp) / SECOND
    assert behind == pytest.approx(max(odom_lag, imu_lag), abs=0.021)


def test_a_gyro_that_is_too_late_times_out_once():
    robot, pose = send_late(0.0, 6.0)
    assert robot.warnings == ['imu_data has timed out: its messages come more than 5 s late; '
                              'not used until it recovers']
    assert robot.combined.estimate.stamp == robot.now and exact(robot.combined.estimate, pose)


def test_odometry_that_is_later_after_a_dropout_counts_again():
    robot = Robot(IDEAL)
    robot.send(50, 0.2)
    poses = {}
    for tick in range(600):     # nothing for 4 s, then all of it, and 1.1 s late from then on
        robot.send(1, 0.2, 0.3, odom=False)
        poses[robot.now] = robot.pose
        stamp = robot.now - round(1.1 * SECOND)
        if tick > 200 and stamp in poses:
            robot.combined.add_odom(robot.now, Odom(stamp, poses[stamp], 1e-6, 1e-6), VARIANCES)
    assert len(robot.warnings) == 2 and not robot.combined.timed_out['odom']
    assert exact(robot.combined.estimate, poses[robot.combined.estimate.stamp], abs=1e-3)
    assert robot.combined.estimate.covariance[X, X] < 1e-3


def test_simulated_time_that_runs_fast_is_no_dropout():
    arrival = 0
    robot = Robot(IDEAL, clock=lambda: arrival)
    for _ in range(20):         # each sensor's messages come in bursts of 3 s, every 0.15 s of the wall
        stamps = [robot.now + STEP * (number + 1) for number in range(150)]
        odoms = []
        for robot.now in stamps:
            robot.pose = arc(robot.pose, 0.004, 0.01)
            odoms.append(robot.odom())
        for odom in odoms:
            robot.combined.add_odom(robot.now, odom, VARIANCES)
        arrival += SECOND * 15 // 100
        for stamp in stamps:
            robot.combined.add_imu(robot.now, Imu(stamp, 0.5, 3e-6))
    assert not robot.warnings and exact(robot.combined.estimate, robot.pose)


def test_messages_that_wait_while_the_process_sleeps_are_no_dropout():
    clock = 0
    robot = Robot(IDEAL, clock=lambda: clock)
    robot.send(50, 0.2, 0.5)
    clock += 10 * SECOND
    stamps, odoms = [], []
    for _ in range(200):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.004, 0.01)
        stamps.append(robot.now)
        odoms.append(robot.odom())
    for stamp in stamps:
        clock += SECOND // 1000
        robot.combined.add_imu(robot.now, Imu(stamp, 0.5, 3e-6))
    for odom in odoms:
        robot.combined.add_odom(robot.now, odom, VARIANCES)
    assert not robot.warnings and exact(robot.combined.estimate, robot.pose)


def test_simulated_time_that_runs_slowly_is_no_dropout():
    arrivals = count(0, 2 * SECOND)
    robot = Robot(IDEAL, clock=lambda: next(arrivals))
    robot.send(100, 0.2, 0.5)
    assert not robot.warnings and exact(robot.combined.estimate, robot.pose)


@pytest.mark.parametrize('lost', [4, 10, 20, 40])
@pytest.mark.parametrize('odom', [True, False])
def test_readings_of_the_gyro_that_are_lost_make_the_heading_uncertain(lost, odom):
    robot = Robot()
    robot.send(100)
    robot.send(50, angular=1.0)
    before = robot.combined.estimate.covariance[2, 2]
    robot.send(lost // 2, angular=1.0, odom=odom, imu=False)    # it stops in the middle
    robot.send(lost // 2, odom=odom, imu=False)
    estimate = robot.send(10)
    error = abs(estimate.pose.yaw - robot.pose.yaw)
    # the wheels of this floor slip by 3 +- 5 %
    assert error < 0.015 and error ** 2 < 9 * estimate.covariance[2, 2] and estimate.covariance[2, 2] > 1.5 * before
    assert not robot.warnings


def test_a_steady_turn_needs_no_reading_of_the_gyro():
    robot = Robot(IDEAL)
    robot.send(50, 0.1, 0.5)
    robot.send(40, 0.1, 0.5, imu=False)
    assert exact(robot.send(10, 0.1, 0.5), robot.pose)


@pytest.mark.parametrize('lost', [4, 20, 40])
def test_a_rate_that_is_a_mean_counts_for_the_whole_gap(lost):
    robot = Robot()
    robot.send(100)
    robot.send(50, angular=1.0)
    robot.send(lost // 2, angular=1.0, odom=False, imu=False)
    robot.send(lost // 2, odom=False, imu=False)
    robot.now += STEP
    robot.combined.add_imu(robot.now, Imu(robot.now, lost / 2 / (lost + 1), 1e-6, is_mean=True))
    robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
    estimate = robot.combined.estimate
    assert abs(estimate.pose.yaw - robot.pose.yaw) < 0.01 and not robot.warnings


def robot_with_a_slow_gyro(every, ticks):
    """A robot that turns and stands by turns, and whose gyro reports the present rate every so many ticks."""
    robot = Robot()
    robot.send(100)
    rate = 0.0
    for tick in range(1, ticks + 1):
        rate = max(rate - 0.1, 0.0) if tick // 60 % 2 else min(rate + 0.1, 1.0)
        robot.send(angular=rate, imu=False)
        if tick % every == 0:
            robot.combined.add_imu(robot.now, Imu(robot.now, rate, 3e-6))
    return robot


@pytest.mark.parametrize('every', [5, 10])
def test_a_slow_gyro_makes_the_heading_uncertain(every):
    robot = robot_with_a_slow_gyro(every, 3000)
    estimate = robot.combined.estimate
    error = estimate.pose.yaw - robot.pose.yaw
    assert error ** 2 < 9 * estimate.covariance[2, 2] and not robot.warnings


# the order of messages

def test_a_gyro_may_be_later_than_the_odometry():
    in_step, late = Robot(), Robot()
    in_step.send(100, 0.2, 0.5)
    stamps = []
    for _ in range(100):
        late.now += STEP
        late.pose = arc(late.pose, 0.004, 0.01)
        late.combined.add_odom(late.now, late.odom(), VARIANCES)
        stamps.append(late.now)
        if len(stamps) == 10:     # by 0.2 s
            for stamp in stamps:
                late.combined.add_imu(late.now, Imu(stamp, 0.5, 3e-6))
            stamps.clear()
    # apart from the first reading, whose start is unknown
    assert exact(late.combined.estimate, in_step.combined.estimate.pose, abs=1e-4)


@pytest.mark.parametrize('rate', [20, 73, 100])
def test_a_gyro_may_have_another_rate(rate):
    robot = Robot(IDEAL)
    next_reading = robot.now
    for _ in range(200):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.004, 0.01)
        robot.combined.add_odom(robot.now, robot.odom(), VARIANCES)
        while next_reading <= robot.now:
            robot.combined.add_imu(robot.now, Imu(next_reading, 0.5, 3e-6))
            next_reading += SECOND // rate
    behind = (robot.now - robot.combined.estimate.stamp) / SECOND
    assert 0 <= behind <= 1.1 / rate + 0.02
    expected = arc(ORIGIN, 0.2 * (4 - 0.02 - behind), 0.5 * (4 - 0.02 - behind))
    start = arc(ORIGIN, 0.004, 0.01)
    c, s = cos(start.yaw), sin(start.yaw)
    assert exact(robot.combined.estimate, Pose(start.x + c * expected.x - s * expected.y,
                                               start.y + s * expected.x + c * expected.y, start.yaw + expected.yaw))


# restarts

def test_messages_from_before_a_reset_do_not_count():
    robot = Robot()
    robot.send(100, 0.2)
    late = [(robot.now - STEP, robot.odom()), (robot.now, robot.odom())]
    robot.combined.arrivals.last_stamp['odom'] -= 2 * STEP       # as if they were still on their way
    robot.combined.reset(robot.now - 10 * STEP)
    for stamp, odom in late:
        robot.combined.add_odom(robot.now, odom._replace(stamp=stamp - 1), VARIANCES)
    assert robot.combined.filter is None
    robot.pose = ORIGIN
    assert exact(robot.send(2), ORIGIN) and not robot.warnings


def test_on_simulated_time_a_stamp_may_be_far_ahead_of_the_clock():
    robot = Robot(IDEAL, max_lead=60 * SECOND)
    for _ in range(100):
        robot.now += STEP
        robot.pose = arc(robot.pose, 0.004, 0.01)
        robot.combined.add_imu(robot.now - 50 * SECOND, Imu(robot.now, 0.5, 3e-6))
        robot.combined.add_odom(robot.now - 50 * SECOND, robot.odom(), VARIANCES)
    assert exact(robot.combined.estimate, robot.pose) and not robot.warnings


@pytest.mark.parametrize('there', [Pose(-1.0, 2.0, pi / 2), Pose(0.4, 0.0, 0.0), Pose(0.2, 0.0, 0.5)])
def test_odometry_that_jumps_restarts_the_filter_there(there):
    robot = Robot()
    robot.send(50, 0.2)
    robot.pose = there
    assert exact(robot.send(2), there) and 'jumped' in robot.warnings[-1]


def test_a_single_jump_is_an_outlier():
    robot, undisturbed = Robot(IDEAL), Robot(IDEAL)
    for each in (robot, undisturbed):
        each.send(50, 0.2)
    home, robot.pose = robot.pose, Pose(-1.0, 2.0, pi / 2)
    robot.send()
    robot.pose = home
    robot.send(50, 0.2)
    undisturbed.send()
    undisturbed.send(50, 0.2)
    assert exact(robot.combined.estimate, undisturbed.combined.estimate.pose) and 'ignored' in robot.warnings[0]


def test_a_clock_that_jumps_back_restarts_the_filter():
    robot = Robot()
    robot.send(50, 0.2)
    robot.now, robot.pose = SECOND, ORIGIN
    assert exact(robot.send(), ORIGIN) and 'The clock jumped back' in robot.warnings[0]
    robot.send(50, 0.2)
    assert robot.combined.estimate.pose.x == pytest.approx(0.2 * 0.98, rel=1e-3)


def test_a_robot_at_3_metres_per_second_is_followed():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.send(200, 3.0, 0.5)
    assert exact(robot.combined.estimate, robot.pose) and not robot.warnings


def test_the_limits_are_parameters():
    robot = Robot(IDEAL, limits=Limits(max_speed=2.0))
    robot.send(50)
    before = robot.send(0)
    robot.send(1, 4.0)
    assert exact(robot.combined.estimate, before.pose) and 'ignored' in robot.warnings[0]


@pytest.mark.parametrize('imu_first', [True, False])
def test_a_turn_while_both_sensors_are_silent_is_never_certain(imu_first):
    robot = Robot()
    robot.send(100)
    robot.send(60, 0.0, 0.5, odom=False)        # odometry times out,
    robot.now += 3 * SECOND // 2                # and then the gyro
    robot.pose = arc(robot.pose, 0.0, 0.75)
    odom = (robot.combined.add_odom, robot.odom(), VARIANCES)
    imu = (robot.combined.add_imu, Imu(robot.now, 0.5, 3e-6))
    for add, *message in (imu, odom) if imu_first else (odom, imu):
        add(robot.now, *message)
    estimate = robot.send(50, 0.0, 0.5)
    error = abs(estimate.pose.yaw - robot.pose.yaw)
    # the wheels of this floor slip by 3 +- 5 % of the 0.75 rad
    assert error < 0.1 and error ** 2 < 9 * estimate.covariance[2, 2]


# set_pose

def test_set_pose_puts_the_robot_there_and_keeps_what_was_learned():
    robot = Robot()
    robot.send(200, bias=0.05)
    covariance = numpy.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.0], [0.0, 0.0, 0.01]])
    robot.combined.set_pose(robot.now, Pose(3.0, -2.0, pi / 2), covariance)
    assert exact(robot.combined.estimate, Pose(3.0, -2.0, pi / 2))
    numpy.testing.assert_allclose(robot.combined.estimate.covariance, covariance, atol=1e-8)
    assert robot.combined.filter.bias == pytest.approx(0.05, abs=1e-4)
    robot.pose = ORIGIN
    estimate = robot.send(100, 0.1, bias=0.05)
    # 0.2 m, of which 2 % slip, in the new direction
    assert exact(estimate, Pose(3.0, -2.0 + 0.2 * 0.98, pi / 2), abs=1e-3)


def test_set_pose_while_the_odometry_has_timed_out():
    robot = Robot(IDEAL)
    robot.send(50)
    robot.send(50, 0.2)
    robot.send(75, 0.2, odom=False)
    robot.combined.set_pose(robot.now + 2 * STEP, Pose(0.0, 0.0, pi / 2), 0.01 * numpy.eye(3))
    estimate = robot.send(10, 0.2, odom=False)
    assert robot.combined.timed_out['odom'] and estimate.pose.yaw == pytest.approx(pi / 2)
    # odometry that is older than the new pose
    late = Odom(robot.now - 9 * STEP, Pose(robot.pose.x - 9 * 0.004, 0.0, 0.0), 1e-6, 1e-6)
    robot.combined.add_odom(robot.now, late, VARIANCES)
    assert exact(robot.combined.estimate, Pose(0.0, 0.0, pi / 2), abs=1e-6)
    # the first 1 of 10 ticks was before the new pose
    assert exact(robot.send(1, 0.2), Pose(0.0, 9 * 0.004, pi / 2), abs=1e-6)


def test_set_pose_before_any_odometry_gives_the_initial_pose():
    robot = Robot()
    robot.combined.set_pose(robot.now, Pose(3.0, -2.0, 1.0), 0.01 * numpy.eye(3))
    assert exact(robot.send(), Pose(3.0, -2.0, 1.0))


def test_set_pose_does_not_depend_on_the_order_of_the_messages():
    results = []
    for late in False, True:
        robot = Robot()
        robot.send(100, 0.2, 0.5)
        at = robot.now + 5 * STEP
        if not late:
            robot.combined.set_pose(at, ORIGIN, 0.01 * numpy.eye(3))
        robot.send(5, 0.2, 0.5)
        if late:
            robot.combined.set_pose(at, ORIGIN, 0.01 * numpy.eye(3))
        results.append(robot.send(20, 0.2, 0.5).pose)
    assert results[0] == pytest.approx(results[1], abs=1e-9)
