"""The driver connects to an emulated robot, drives and stops it, and reports its pose."""
from math import pi

import pytest

from rbx1_nav.base.units import SECOND
from rbx1_nav.extras.create import protocol

from driven_create import BOTH, DrivenCreate, started

# rounding of the encoders; rounding of the Create's angle: 1 degree, which shifts the end of 1 m sideways; its angle is
# read every 45 to 58 degrees, with an error of up to a quarter of a degree
POSITION, ANGLE = {'create': 0.02, 'create2': 0.001}, {'create': 0.045, 'create2': 0.002}


@BOTH
def test_odometry_follows_the_robot_out_and_back(robot_type):
    driven = started(robot_type)
    for linear, angular, seconds in 2 * [(0.2, 0, 5), (0, 1, pi)]:
        driven.drive(linear, angular, seconds)
        driven.command_zero()
        driven.run(1)
    assert driven.truth.x ** 2 + driven.truth.y ** 2 < 0.03 ** 2
    for value, truth in zip(driven.pose[:2], driven.truth[:2]):
        assert value == pytest.approx(truth, abs=POSITION[robot_type])
    assert driven.pose.yaw == pytest.approx(driven.truth.yaw, abs=ANGLE[robot_type])
    assert driven.truth.yaw == pytest.approx(2 * pi, abs=0.05)      # ticks of 20 ms at 1 rad/s


@BOTH
def test_a_command_is_sent_at_once(robot_type):
    driven = started(robot_type)
    before = driven.now
    driven.command(0.2, 0)
    driven.run(0.01)
    time = next(time for time, data in driven.commands if data == protocol.drive_direct(200, 200))
    # five bytes, and a query before them, at the line's rate
    assert time - before < SECOND // 200


@BOTH
def test_a_command_times_out(robot_type):
    driven = started(robot_type, cmd_vel_timeout=0.3)
    driven.command(0.2, 0)
    driven.run(0.29)
    assert driven.speeds == (200, 200)
    driven.run(0.02)    # a step, and the transmission of the bytes
    assert driven.speeds == (0, 0)


def test_slow_turns_are_commanded_at_the_least_speed():
    driven = started('create', min_abs_yaw_vel=0.5, max_abs_yaw_vel=1.0)
    for asked, speed in ((0.1, 65), (-0.1, -65), (0.7, 91), (2.0, 130), (0.0, 0)):
        driven.drive(0, asked, 0.1)
        assert driven.speeds == (-speed, speed)


@BOTH
def test_states_are_reported_at_the_update_rate(robot_type):
    driven = started(robot_type, update_rate=20)
    count = len(driven.states)
    driven.run(5)
    assert len(driven.states) - count == pytest.approx(100, abs=2)


def test_a_slow_line_at_the_highest_update_rate_loses_no_reply():
    """A reply takes 16 ms, so the next query is due while it arrives."""
    driven = DrivenCreate('create', update_rate=60, baud=19200)
    driven.line.baud = 19200
    driven.connect()
    driven.run(3)
    driven.drive(0.2, 0.5, 2)
    queries = driven.driver.queries
    assert queries.missed == queries.rejected == 0


@BOTH
def test_a_base_is_ready_when_the_robot_can_be_driven_or_the_reason_is_known(robot_type):
    driven = DrivenCreate(robot_type, robot=robot_type)
    driven.body.switches = 8
    assert not driven.driver.is_ready
    driven.connect()
    assert not driven.driver.is_ready
    driven.run(3)
    assert driven.driver.is_ready and not driven.driver.supervisor.in_control
    assert started(robot_type).driver.is_ready
