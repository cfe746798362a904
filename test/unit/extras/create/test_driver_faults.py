"""The driver handles faults of an emulated robot and its line."""
import random

import numpy
import pytest

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.base.units import wrap_angle
from rbx1_nav.extras.create import protocol

from driven_create import BOTH, NO_ERRORS, SURFACES, DrivenCreate, started

STOP, START = protocol.drive_direct(0, 0), protocol.command('start')
CHI_SQUARE = 16.3       # 99.9 % quantile for 3 degrees of freedom


def normalized_error(driven):
    """Return the squared error of the odometry, normalized by its covariance."""
    error = numpy.array(driven.pose) - driven.truth
    error[2] = wrap_angle(error[2])
    return error @ numpy.linalg.solve(driven.driver.motion.odometry.covariance, error)


def drive_on_a_bad_line(robot_type, seed, **params):
    """Return a robot after a drive with 1 % of corrupted bytes."""
    driven = started(robot_type, seed=seed, **params)
    driven.line.corruption = 0.01
    for linear, angular in ((0.2, 0.0), (0.0, 1.0), (0.2, 0.3), (-0.1, -0.5)):
        driven.drive(linear, angular, 3)
    driven.run(1)
    driven.line.corruption = 0.0
    driven.run(1)
    return driven


def interrupt(robot_type, seed, surface, is_pulled, **params):
    """Pull the cable, or let the line fall silent, at a random moment of a random motion, and check the stop. Returns
    the normalized squared error."""
    choose = random.Random(seed)
    driven = started(robot_type, surface=surface, seed=seed, **params)
    driven.drive(choose.uniform(-0.3, 0.3), choose.choice([0, choose.uniform(-1, 1)]), choose.uniform(0.5, 3))
    driven.run(0.002 * choose.randrange(17))
    if is_pulled:
        driven.pull()
        driven.run(choose.uniform(0.05, 4))
    else:
        driven.line.silent = True
        driven.run(choose.uniform(1, 4))
        assert 'The robot has stopped responding' in driven.log[-1]
        driven.line.silent = False
    assert driven.body.moving       # nothing stops the robot
    count = len(driven.commands)
    if is_pulled:
        driven.connect()
    driven.run(0.5 if is_pulled else 3)     # it may have to be searched for
    # the first command that concerns the wheels
    assert next(data for _, data in driven.commands[count:] if data[0] in (STOP[0], START[0])) in (STOP, START)
    assert driven.driver.contact.answers and driven.speeds == (0, 0)
    return normalized_error(driven)


@pytest.mark.parametrize('is_pulled, surface, params', [
    (True, 'ideal', NO_ERRORS), (True, 'low_ply_carpet', {}), (False, 'ideal', NO_ERRORS)])
@BOTH
def test_the_odometry_knows_how_uncertain_a_gap_is(robot_type, is_pulled, surface, params):
    floor = load_surface(surface, SURFACES)
    seeds = *range(20), 475     # the last: an arc
    errors = [interrupt(robot_type, seed, floor, is_pulled, **params) for seed in seeds]
    assert max(errors) < CHI_SQUARE
    # 3 is right; in a silence on an ideal floor, the next reading of a Create is more exact than it is assumed to be
    assert 0.4 < sum(errors) / len(errors) < 5


def test_a_robot_that_never_answers_is_reported_once():
    driven = DrivenCreate('create')
    driven.line.silent = True
    driven.connect()
    driven.run(10)
    assert driven.log == ['No robot answers at 57600, 115200, 19200 baud: expected a Create, Create 2 or Roomba that '
                          'is switched on and connected']


@BOTH
@pytest.mark.parametrize('linear, angular, index', [(0.2, 0, 0), (0, 0.8, 2)])
def test_the_pose_of_a_robot_that_was_reset_while_disconnected_is_as_uncertain_as_its_commanded_travel(
        robot_type, linear, angular, index):
    driven = started(robot_type, **NO_ERRORS)
    driven.drive(linear, angular, 1)
    covariance, before = numpy.array(driven.driver.motion.odometry.covariance), driven.pose
    driven.pull()
    driven.run(4)
    driven.robot.switch_on(driven.now)
    driven.connect()
    driven.run(5)
    grown = driven.driver.motion.odometry.covariance - covariance
    assert driven.robot.mode == protocol.SAFE and driven.pose == before
    # uniform from 0 to the travel in 4 s; 1 % in variance for the 20 ms of an incomplete reading
    assert grown[index, index] == pytest.approx((4 * (linear or angular)) ** 2 / 3, rel=0.02)


@BOTH
def test_more_commands_than_the_line_can_carry_do_not_delay_a_stop(robot_type):
    driven = started(robot_type)
    for index in range(500):
        for _ in range(4):
            driven.command(0.2 + index / 1e5, 0)
        driven.run(0.002)
    driven.command_zero()
    driven.run(0.02)
    assert driven.speeds == (0, 0)


@pytest.mark.parametrize('seed', range(4))
def test_a_corrupted_line_leaves_the_odometry_of_a_create_2_as_it_is(seed):
    driven = drive_on_a_bad_line('create2', seed)
    # as large as without corruption: rounding along the path
    for value, truth in zip(driven.pose, driven.truth):
        assert value == pytest.approx(truth, abs=0.003)
    assert driven.driver.queries.rejected > 20 and driven.driver.contact.dropouts == 0


def test_the_covariance_of_a_create_holds_what_a_line_without_a_checksum_loses_and_corrupts():
    errors = []
    for seed in range(8):
        driven = drive_on_a_bad_line('create', seed, **NO_ERRORS)
        assert driven.driver.queries.missed > 20
        errors.append(normalized_error(driven))
        assert driven.pose.yaw == pytest.approx(driven.truth.yaw, abs=0.1), seed    # no corrupted angle counts
    assert max(errors) < CHI_SQUARE
    assert 0.03 < sum(errors) / len(errors) < 6     # mostly too large: few corrupted counts pass the checks


@pytest.mark.parametrize('corruption', [0.05, 0.1])
def test_a_robot_on_a_very_bad_line_is_stopped(corruption):
    for seed in range(8):
        driven = started('create', seed=seed, **NO_ERRORS)
        driven.drive(0.2, 0.0, 2.0)
        driven.line.corruption = corruption
        driven.drive(0.0, 1.0, 5.0)
        assert driven.speeds == (0, 0)
        assert any('% of the replies of the robot are lost or corrupted' in text or 'the robot does not answer' in text
                   or 'the robot did not answer' in text for text in driven.refusals), driven.refusals
        driven.line.corruption = 0.0
        driven.run(3.0)
        assert normalized_error(driven) < CHI_SQUARE, seed
        # a zero command allows it to be driven again
        driven.command_zero()
        driven.drive(0.2, 0.0, 1.0)
        assert driven.speeds == (200, 200)
