"""Sensors that become silent time out and recover, and late sensors are waited for."""
from math import pi, remainder

import pytest

from rbx1_nav.base.kinematics import arc
from rbx1_nav.base.units import SECOND
from rbx1_nav.filter.gyro_readings import MOST
from rbx1_nav.filter.input_checks import Imu, Odom
from sample_priors import IDEAL
from sample_robot import STEP, Robot, exact


def test_a_gyro_times_out_and_recovers():
    robot = Robot(IDEAL)
    robot.send(50, 0.2, 0.5)
    robot.send(40, 0.2, 0.5, imu=False)
    behind = robot.combined.estimate
    assert not robot.warnings and not exact(behind, robot.pose)     # the filter waits: the gyro may only be late
    robot.send(60, 0.2, 0.5, imu=False)
    assert exact(robot.combined.estimate, robot.pose) and robot.combined.timed_out['imu_data']
    robot.send(60, 0.2, 0.5)
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.timed_out['imu_data']
    assert robot.warnings == ['imu_data has timed out: no valid message for more than 1 s; not used until it recovers',
                              'imu_data has recovered']


def test_a_gyro_that_has_never_reported_times_out_too():
    robot = Robot(IDEAL)
    assert robot.send(51, 0.2, 0.5, imu=False) is None and not robot.warnings
    assert robot.send(2, imu=False) and len(robot.warnings) == 1


@pytest.mark.parametrize('late', [False, True])
def test_what_both_sensors_measure_in_a_dropout_of_the_odometry_counts_when_it_recovers(late):
    robot = Robot(IDEAL)
    robot.send(100)
    before = robot.send(50, 0.2)
    robot.send(100, 0.2, 0.5, odom=False)
    robot.send(100, odom=False)
    assert robot.combined.estimate is before and robot.combined.timed_out['odom']     # nothing measures the position
    odom = robot.odom()
    if late:        # the gyro is ahead
        robot.send(5, odom=False)
    robot.combined.add_odom(robot.now, odom)
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.timed_out['odom']
    assert exact(robot.send(50, 0.2, -0.5), robot.pose)
    assert robot.warnings == ['odom has timed out: no valid message for more than 1 s; not used until it recovers',
                              'odom has recovered']


def test_a_dropout_that_is_longer_than_the_stored_readings_is_measured_by_the_wheels():
    robot = Robot()
    robot.send(100)
    robot.send(MOST + 100, 0.0, 0.1, odom=False)
    estimate = robot.send(1, 0.0, 0.1)
    # slip of 3 +- 5 %
    assert len(robot.combined.readings.waiting) == 0
    assert abs(remainder(estimate.pose.yaw - 0.97 * remainder(robot.pose.yaw, 2 * pi), 2 * pi)) < 0.05


def send_late(odom_lag, imu_lag):
    """Run a robot whose messages are late (s) for 10 s; return it, and its pose at the stamp of the last estimate."""
    robot, poses = Robot(IDEAL), {}
    for _ in range(500):
        robot.now += STEP
        robot.pose = poses[robot.now] = arc(robot.pose, 0.004, 0.01)
        stamp = robot.now - round(odom_lag * SECOND)
        if stamp in poses:
            robot.combined.add_odom(robot.now, Odom(stamp, poses[stamp]))
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
    assert robot.warnings == ['imu_data has timed out: its messages arrive more than 5 s late; '
                              'not used until it recovers']
    assert robot.combined.estimate.stamp == robot.now and exact(robot.combined.estimate, pose)


def test_simulated_time_that_runs_fast_is_no_dropout():
    arrival = 0
    robot = Robot(IDEAL, clock=lambda: arrival)
    for _ in range(20):         # each sensor's messages arrive in bursts of 3 s, every 0.15 s of wall time
        stamps = [robot.now + STEP * (number + 1) for number in range(150)]
        odoms = []
        for robot.now in stamps:
            robot.pose = arc(robot.pose, 0.004, 0.01)
            odoms.append(robot.odom())
        for odom in odoms:
            robot.combined.add_odom(robot.now, odom)
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
        robot.combined.add_odom(robot.now, odom)
    assert not robot.warnings and exact(robot.combined.estimate, robot.pose)
