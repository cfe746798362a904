"""Robots that lose fractions of a degree, and a short test of whether they do."""
from math import degrees, pi, trunc

import pytest

from rbx1_nav.base.surfaces import load_surface
from rbx1_nav.extras.create.emulator.body import Quirks
from rbx1_nav.extras.create.fractions import AUTO, KEPT, LOST, Fractions

from driven_create import SURFACES, started


def turn(driven, rate, angle):
    """Turn by an angle (rad) at a rate (rad/s). Returns the turns (degrees) of the odometry and of the wheels."""
    before = driven.pose.yaw, driven.body.angle.total
    driven.drive(0, rate, angle / abs(rate))
    driven.command_zero()
    driven.run(2)
    return degrees(driven.pose.yaw - before[0]), driven.body.angle.total - before[1]


@pytest.mark.parametrize('rate', [0.3, -1.0])
@pytest.mark.parametrize('lost', [False, True])
@pytest.mark.parametrize('surface', ['ideal', 'low_ply_carpet'])
def test_a_turn_is_reported_whatever_the_robot_does_with_fractions(surface, lost, rate):
    driven = started('create', surface=load_surface(surface, SURFACES), quirks=Quirks(drops_fractions=lost))
    reported, true = turn(driven, rate, 2 * pi)
    assert reported == pytest.approx(true, rel=0.03)
    kind = driven.driver.counter.fractions.kind
    assert kind == (LOST if lost else KEPT)
    # at the next turn, the handling of fractions is known
    reported, true = turn(driven, -rate, pi)
    assert reported == pytest.approx(true, rel=0.03)
    assert [line for line in driven.log if 'fractions' in line] == [
        'The robot loses fractions of a degree: correcting the odometry. Set angle_fractions:=lost to correct it from '
        'the start'] * lost


PERIOD = 1 / 32         # s between two readings
FAST = 1 / 128          # s between two readings of the test


class Turning:
    """A robot in a turn that is read whenever a reading is due."""

    def __init__(self, kind=AUTO, drops=False, rate=40.0):
        """rate: degrees/s."""
        self.log = []
        self.fractions = Fractions(kind, self.log.append)
        self.drops = drops
        self.rate = self.wheels = rate      # commanded, and of the wheels
        self.true = self.pending = 0.0      # turn (degrees) in total, and since the last reading
        self.total = 0.0        # turn returned
        self.readings = 0       # number of readings of the angle
        self.intervals = []     # s between two queries

    def run(self, seconds, fast=FAST):
        """Turn for some seconds. fast: s between two queries of the test."""
        while seconds > 0:
            elapsed = fast if self.fractions.hurries else PERIOD
            seconds -= elapsed
            self.intervals.append(elapsed)
            self.true += self.wheels * elapsed
            self.pending += self.wheels * elapsed
            commanded = self.rate * elapsed
            angle = None
            if self.fractions.is_due(commanded, elapsed):
                self.readings += 1
                angle = trunc(self.pending)
                self.pending = 0.0 if self.drops else self.pending - angle
            self.total += self.fractions.update(commanded, elapsed, angle).angle

    def stop(self):
        """Stop the robot, and wait until its turn has been read."""
        self.rate = self.wheels = 0.0
        self.run(2.0)

    @property
    def error(self):
        """Difference between the turn that was returned and the true turn, degrees."""
        return self.total - self.true


@pytest.mark.parametrize('rate', [6.0, -20.0, 60.0])
@pytest.mark.parametrize('drops', [False, True])
def test_one_steady_turn_shows_what_the_robot_does_with_fractions(drops, rate):
    robot = Turning(drops=drops, rate=rate)
    robot.run(80 / abs(rate))
    assert robot.fractions.kind == (LOST if drops else KEPT)
    assert len(robot.log) == drops
    robot.stop()
    assert abs(robot.error) < 2
    # from now on, one robot is asked for its angle each time, the other one after 14 degrees or more
    robot.rate = robot.wheels = 32.0
    robot.readings = 0
    robot.run(1.0)
    assert robot.readings <= 2 if drops else robot.readings == 32


@pytest.mark.parametrize('kind', [KEPT, LOST])
def test_a_known_robot_is_not_tested(kind):
    robot = Turning(kind, drops=kind == LOST, rate=41.3)
    robot.run(30.0)
    assert robot.fractions.kind == kind and set(robot.intervals) == {PERIOD}
    robot.stop()
    assert abs(robot.error) < 0.005 * robot.true + 1 and not robot.log


@pytest.mark.parametrize('angle, turn', [(20, 16.5), (10, 16.5)])
def test_whether_a_query_arrived_follows_from_the_next_reading(angle, turn):
    """The query after 10 degrees may not have arrived. The robot then reports 20 degrees, otherwise 10."""
    fractions = Fractions(LOST)
    fractions.update(4.0, 0.4, None)
    fractions.lose(6.0)
    assert fractions.update(16.0, 1.6, angle).angle == pytest.approx(turn)


def test_a_correction_is_no_jump():
    """The heading is corrected by up to 120 degrees/s."""
    fractions = Fractions(LOST)
    fractions.update(20.0, 0.5, None)
    assert [(fractions.update(0.0, 0.05, angle).angle, fractions.unread) for angle in (9, None, None)] == [
        (-6, 4.5), (-4.5, 0), (0, 0)]
