"""Sensors that become silent time out and recover, and late sensors are waited for."""
import pytest

from rbx1_nav.estimation.filter import X, Y, YAW
from rbx1_nav.estimation.inputs import Imu, Odom
from rbx1_nav.robot.kinematics import Pose, arc
from rbx1_nav.units import SECOND
from sample_priors import IDEAL, PRIORS
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


def test_without_a_gyro_the_heading_is_as_uncertain_as_the_slip_of_the_floor():
    robot = Robot(PRIORS, gyro_used=False)
    robot.send(2, imu=False)
    estimate = robot.send(100, angular=1.0, imu=False)
    # a turn of 2 rad with a slip of 3 +- 5 %, and the noise of the carpet
    assert estimate.pose.yaw == pytest.approx(2 * 0.97)
    assert estimate.covariance[2, 2] == pytest.approx(
        (0.05 * 2) ** 2 + PRIORS.heading_noise_turning ** 2 * 2, rel=0.01)


def test_odometry_times_out_and_its_travel_meanwhile_counts_when_it_recovers():
    robot = Robot(IDEAL)
    robot.send(100)
    robot.send(50, 0.2)
    last = robot.pose
    robot.send(100, 0.0, 0.5, odom=False)
    estimate = robot.combined.estimate
    # during the dropout, the gyro measures the turn
    assert robot.combined.timed_out['odom'] and exact(estimate, last._replace(yaw=robot.pose.yaw))
    # and no sensor measures the travel: 0.5 m/s for 2 s
    assert estimate.covariance[X, X] > 0.9 and estimate.covariance[Y, Y] > 0.9
    robot.send(100, 0.2, 0.0, odom=False)
    robot.send(1, 0.2, 0.0)
    # the wheels report a straight displacement since the dropout, and the gyro has reported the turn
    assert exact(robot.combined.estimate, robot.pose) and not robot.combined.timed_out['odom']
    assert robot.combined.estimate.covariance[X, X] < 1e-3


def test_a_turn_that_begins_just_before_the_odometry_times_out_counts():
    robot = Robot(IDEAL)
    robot.send(100)
    for _ in range(4):      # the wheels still report rest
        robot.now += STEP
        robot.combined.add_imu(robot.now, Imu(robot.now, 0.5, 3e-6))
        robot.combined.add_odom(robot.now, robot.odom())
    robot.send(100, 0.0, 0.5, odom=False)
    assert robot.combined.estimate.pose.yaw == pytest.approx(0.04 + robot.pose.yaw, abs=1e-3)


@pytest.mark.parametrize('odom_first', [True, False])
def test_odometry_that_recovers_in_a_turn_does_not_count_it_again(odom_first):
    robot = Robot()     # its wheels slip by 3 %, as the filter expects, and it turns at 0.5 rad/s
    for tick in range(300):
        robot.now += STEP
        wheels = Odom(robot.now, Pose(0.0, 0.0, 0.5 * 0.02 * tick / 0.97))
        odom = (robot.combined.add_odom, wheels)
        imu = (robot.combined.add_imu, Imu(robot.now, 0.5 if tick else 0.0, 3e-6))
        for add, *message in (odom, imu) if odom_first else (imu, odom):
            if add is imu[0] or not 50 < tick < 200:
                add(robot.now, *message)
    assert robot.combined.filter.state[YAW] == pytest.approx(0.5 * 0.02 * tick, abs=1e-3)
    assert len(robot.warnings) == 2


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


@pytest.mark.parametrize('imu_first', [True, False])
def test_a_turn_while_both_sensors_are_silent_is_never_certain(imu_first):
    robot = Robot()
    robot.send(100)
    robot.send(60, 0.0, 0.5, odom=False)        # odometry times out,
    robot.now += 3 * SECOND // 2                # and then the gyro
    robot.pose = arc(robot.pose, 0.0, 0.75)
    odom = (robot.combined.add_odom, robot.odom())
    imu = (robot.combined.add_imu, Imu(robot.now, 0.5, 3e-6))
    for add, *message in (imu, odom) if imu_first else (odom, imu):
        add(robot.now, *message)
    estimate = robot.send(50, 0.0, 0.5)
    error = abs(estimate.pose.yaw - robot.pose.yaw)
    # the wheels of this floor slip by 3 +- 5 % of the 0.75 rad
    assert error < 0.1 and error ** 2 < 9 * estimate.covariance[2, 2]
