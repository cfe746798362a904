#!/usr/bin/python3
"""/ground_truth is the true pose of the emulated robot: its sensors agree with it, within their errors."""
from math import pi

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import command, drive_direct
import support

COUNTS = 508.8 / (pi * 0.072)   # encoder counts per meter


class TestTruth(support.Case):
    def stopped(self, robot):
        """Return the true pose after a stop."""
        robot.send(drive_direct(0, 0))
        support.wait_for(lambda: not robot.moving, 'the robot to stand')
        return support.pose(robot.truth.last)

    def drive(self, robot):
        """Drive straight for 0.3 m; return the true pose after a stop."""
        robot.open()
        robot.send(command('start'), command('full'), drive_direct(200, 200))
        support.wait_for(lambda: robot.position > 0.3, 'the robot to drive')
        return self.stopped(robot)

    def check_straight(self, robot, wheel_travel):
        x, y, yaw = self.drive(robot)
        self.assertEqual((y, yaw), (0, 0))
        travel = robot.read(19)['distance'] / 1000
        self.assertAlmostEqual(travel, x * wheel_travel, delta=0.001)    # whole millimeters
        if robot.model.counts_per_metre:
            self.assertAlmostEqual(robot.read(43)['left_encoder'], x * wheel_travel * COUNTS, delta=1)
        robot.end()

    def test_straight(self):
        self.check_straight(EmulatedRobot(self, 'create'), 1.0)
        self.check_straight(EmulatedRobot(self, 'create2', wheel_travel=1.25), 1.25)

    def test_a_turn(self):
        robot = EmulatedRobot(self, 'create', wheel_base=1.1)
        robot.open()
        robot.send(command('start'), command('full'), drive_direct(65, -65))
        support.wait_for(lambda: support.yaw(robot.truth.next()) > 1, 'the robot to turn')
        x, y, yaw = self.stopped(robot)
        self.assertAlmostEqual(x, 0)
        self.assertAlmostEqual(y, 0)
        self.assertAlmostEqual(robot.read(20)['angle'] * pi / 180, yaw * 1.1, delta=pi / 180)    # whole degrees

    def test_carpet(self):
        robot = EmulatedRobot(self, 'create2', surface='low_ply_carpet')
        x, _, _ = self.drive(robot)
        # the mean slip is 2 %; the noise over 0.3 m has a standard deviation of 8 %, and is below two with this seed
        ratio = robot.read(43)['left_encoder'] / COUNTS / x
        self.assertTrue(0.85 < ratio < 1.25 and abs(ratio - 1) > 0.003, ratio)


if __name__ == '__main__':
    support.main(TestTruth)
