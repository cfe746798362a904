#!/usr/bin/python3
"""The cable of the emulated robot is unplugged: it keeps executing its last Drive, and can be reached again later."""
import os

import rospy
import serial
from std_srvs.srv import SetBool

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import FULL, command, drive_direct
import support


class TestCable(support.Case):
    def robot(self):
        robot = EmulatedRobot(self, 'create2')
        robot.open()
        robot.send(command('start'), command('full'), drive_direct(100, 100))
        return robot

    def test_pulled_and_put_back(self):
        robot = self.robot()
        for _ in range(3):
            device = os.path.realpath(robot.link)
            robot.switch('pull_cable', True)
            with self.assertRaises(serial.SerialException):
                robot.port.read()
            self.assertFalse(os.path.lexists(robot.link))
            start = robot.position
            support.wait_for(lambda: robot.position > start + 0.05, 'the robot to move on')
            robot.switch('pull_cable', False)
            old = robot.port
            robot.open()
            # while the old device is still open, the new device must have a different name
            self.assertNotEqual(os.path.realpath(robot.link), device)
            old.close()
            self.assertEqual(robot.read(35), {'mode': FULL})
            self.assertEqual(robot.read(41), {'requested_right_velocity': 100})
        robot.send(drive_direct(0, 0))
        self.assertFalse(robot.moving)

    def test_a_link_that_can_no_longer_be_made(self):
        robot = EmulatedRobot(self, 'create')
        robot.switch('pull_cable', True)
        os.mkdir(robot.link)
        response = rospy.ServiceProxy('/fake_create/pull_cable', SetBool)(False)
        os.rmdir(robot.link)
        self.assertFalse(response.success)
        self.assertIn(f'link: {robot.link}: exists, and is not a link: expected', response.message)
        robot.switch('pull_cable', False)
        robot.open()

    def test_the_end_of_the_node_removes_the_link(self):
        robot = self.robot()
        robot.end()
        self.assertFalse(os.path.lexists(robot.link))


if __name__ == '__main__':
    support.main(TestCable)
