#!/usr/bin/python3
"""fake_create.py: its parameters, services and topics reach the robot, a client uses its line as a serial port, and
/line and /ground_truth show what the robot receives and how it moves."""
from math import pi
import os
import time

import rospy
import serial
from std_srvs.srv import SetBool

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import FULL, PASSIVE, SAFE, command, drive_direct, encode_frame
import support

COUNTS = 508.8 / (pi * 0.072)   # encoder counts per meter
CLOCKS = 0.001      # s: the robot and the stamps use different clocks


class TestEmulatedRobot(support.Case):
    def robot(self, robot_type, *commands, **params):
        """Return a robot that has received these commands."""
        robot = EmulatedRobot(self, robot_type, **params)
        robot.open(params.get('baud'))
        robot.send(command('start'), *commands)
        return robot

    def test_each_command_is_on_line_with_the_time_of_its_last_byte(self):
        robot = EmulatedRobot(self, 'create')
        robot.open()
        sent = time.time()
        # in passive mode, the robot ignores the second command
        stamp = robot.send(command('start'), drive_direct(100, -100))
        received = time.time()
        self.assertEqual([data for _, data in robot.received()], [command('start'), bytes((145, 0, 100, 255, 156))])
        self.assertTrue(sent + 6 * 10 / 57600 - CLOCKS <= stamp <= received + CLOCKS, (sent, stamp, received))

    def test_a_cable_that_is_pulled_and_put_back(self):
        robot = self.robot('create2', command('full'), drive_direct(100, 100))
        robot.switch('pull_cable', True)
        with self.assertRaises(serial.SerialException):
            robot.port.read()
        self.assertFalse(os.path.lexists(robot.link))
        os.mkdir(robot.link)
        response = rospy.ServiceProxy('/fake_create/pull_cable', SetBool)(False)
        os.rmdir(robot.link)
        self.assertFalse(response.success)
        self.assertIn(f'link: {robot.link}: exists, and is not a link: expected', response.message)
        robot.switch('pull_cable', False)
        robot.open()
        self.assertEqual(robot.read(35), {'mode': FULL})
        robot.end()
        self.assertFalse(os.path.lexists(robot.link))

    def test_a_power_cycle(self):
        robot = self.robot('create2', command('safe'), drive_direct(100, 100))
        support.wait_for(lambda: robot.moving, 'the robot to drive')
        robot.port.reset_input_buffer()
        robot.power_cycle()
        self.assertFalse(robot.moving)
        self.assertEqual(robot.port.read(8), b'bl-start')

    def test_services_and_topics(self):
        robot = self.robot('create')
        for service, number, value in ('bump', 7, 3), ('drop_wheel', 7, 8), ('cliff', 10, 1), ('dock', 34, 2):
            robot.switch(service, True)
            robot.wait_for(number, value)
            robot.switch(service, False)
            robot.wait_for(number, 0)
        for topic, value, number, shown in (
                ('charge', 1.67, 25, 5010), ('battery_temperature', 75, 24, 75), ('battery_voltage', 9.5, 22, 9500),
                ('gyro_stuck', 700, 33, 700), ('gyro_stuck', -1, 33, 512)):
            robot.publish(topic, value)
            robot.wait_for(number, shown)
        robot.publish('charge', 2.5)
        robot.process.wait_for_line('charge: 2.5: expected a number from 0 to 2; rejected')
        robot.publish('corruption', 1.0)
        robot.send(command('stream', 1, 35))
        self.assertNotIn(encode_frame(robot.model, [35], {'mode': PASSIVE}), robot.port.read(200))

    def test_good_parameters(self):
        robot = self.robot('create', command('safe'), drive_direct(65, -65), baud=19200, mode_plus_one=True,
                           drops_fractions=True, gyro_stuck=700)
        self.assertEqual(robot.read(35), {'mode': SAFE + 1})
        support.wait_for(lambda: support.yaw(robot.truth.next()) > 0.5, 'the robot to turn')
        self.assertEqual(robot.read(33), {'analog_input': 700})
        # 15 ms at 28.6 degrees/s are less than a degree
        robot.send(command('stream', 1, 20))
        frame = encode_frame(robot.model, [20], {'angle': 0})
        robot.port.read_until(frame)
        self.assertEqual(robot.port.read(6 * 50), 50 * frame)

    def test_wheels_that_slip(self):
        robot = self.robot('create2', command('full'), drive_direct(200, 200), surface='low_ply_carpet',
                           wheel_travel=1.25)
        support.wait_for(lambda: robot.position > 0.3, 'the robot to drive')
        robot.send(drive_direct(0, 0))
        support.wait_for(lambda: not robot.moving, 'the robot to stand')
        # the mean slip is 2 %; the noise over 0.3 m has a standard deviation of 8 %, and is below two with this seed
        ratio = robot.read(43)['left_encoder'] / COUNTS / 1.25 / support.pose(robot.truth.last)[0]
        self.assertTrue(0.85 < ratio < 1.25 and abs(ratio - 1) > 0.003, ratio)


if __name__ == '__main__':
    support.main(TestEmulatedRobot)
