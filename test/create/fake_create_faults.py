#!/usr/bin/python3
"""Faults and events of the emulated robot: wheel drop, cliff, bump, dock, power, battery, bad bytes, a stuck gyro."""
from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import OFF, PASSIVE, SAFE, checksum, command, drive_direct
import support


class TestFaults(support.Case):
    def robot(self, robot_type):
        robot = EmulatedRobot(self, robot_type)
        robot.open()
        robot.send(command('start'), command('safe'), drive_direct(100, 100))
        self.assertTrue(robot.moving)
        return robot

    def test_switches(self):
        for robot_type in 'create', 'create2':
            robot = self.robot(robot_type)
            robot.switch('bump', True)
            robot.wait_for(7, 3)
            robot.switch('bump', False)
            robot.wait_for(7, 0)
            self.assertEqual(robot.read(35), {'mode': SAFE})
            for service, number, value in ('drop_wheel', 7, 8), ('cliff', 10, 1), ('dock', 34, 2):
                robot.send(command('safe'), drive_direct(100, 100))
                robot.switch(service, True)
                robot.wait_for(number, value)
                self.assertEqual(robot.read(35), {'mode': PASSIVE})
                self.assertFalse(robot.moving)
                robot.switch(service, False)
                robot.wait_for(number, 0)
            robot.end()

    def test_a_power_cycle(self):
        robot = self.robot('create2')
        support.wait_for(lambda: robot.read(43)['left_encoder'] > 100, 'the encoders to count')
        robot.port.reset_input_buffer()
        robot.power_cycle()
        self.assertFalse(robot.moving)
        self.assertEqual(robot.port.read(8), b'bl-start')

        def restarted():
            robot.port.write(command('start'))
            return robot.received()[-1][1] == command('start')
        support.wait_for(restarted, 'the robot to listen again')
        self.assertEqual(robot.read(43), {'left_encoder': 0})

    def test_a_robot_that_was_switched_off(self):
        robot = self.robot('create2')
        robot.send(command('power'))
        self.assertFalse(robot.moving)
        robot.port.timeout = 0.5
        robot.port.write(command('start') + command('cover') + command('sensors', 35))
        self.assertEqual(robot.port.read(1), b'')
        self.assertFalse(robot.moving)
        robot.port.timeout = support.LIMIT
        robot.power_cycle()
        self.assertEqual(robot.port.read(8), b'bl-start')

    def test_a_stuck_gyro(self):
        robot = self.robot('create')
        for count, value in (0, 0), (700, 700), (1023, 1023), (-1, 512):
            robot.publish('gyro_stuck', count)
            robot.wait_for(33, value)
        robot.publish('gyro_stuck', 1024)
        robot.process.wait_for_line('gyro_stuck: 1024.0: expected a count from -1 to 1023; rejected')

    def test_the_battery(self):
        robot = self.robot('create')
        for topic, value, number, shown in ('charge', 0.25, 25, 750), ('charge', 1.67, 25, 5010), (
                'battery_temperature', 75, 24, 75), ('battery_voltage', 9.5, 22, 9500):
            robot.publish(topic, value)
            robot.wait_for(number, shown)
        robot.publish('charge', 0.0)
        support.wait_for(lambda: not robot.moving, 'the robot to stop')
        robot.port.timeout = 0.5
        robot.port.write(command('start') + command('sensors', 35))
        self.assertEqual(robot.port.read(1), b'')
        robot.publish('charge', 1.0)
        robot.power_cycle()
        support.wait_for(lambda: robot.port.write(command('start') + command('sensors', 35)) and robot.port.read(1),
                         'the robot to answer')

    def test_corruption(self):
        robot = self.robot('create2')
        robot.send(command('stream', 2, 43, 44))
        frames = robot.port.read(9 * 200)
        self.assertEqual([frames[index:index + 2] for index in range(0, 1800, 9)], [b'\x13\x06'] * 200)
        robot.publish('corruption', 0.05)
        robot.port.read(9)
        frames = robot.port.read(9 * 200)
        good = [index for index in range(len(frames) - 8) if frames[index:index + 2] == b'\x13\x06'
                and frames[index + 8] == checksum(frames[index:index + 8])]
        # 0.95 ** 9 of 200 is 126, with a standard deviation of 7
        self.assertTrue(80 < len(good) < 170, len(good))

    def test_a_fraction_out_of_range_is_rejected(self):
        robot = self.robot('create')
        robot.publish('charge', 2.5)
        robot.process.wait_for_line('charge: 2.5: expected a number from 0 to 2; rejected')
        self.assertNotEqual(robot.read(35), {'mode': OFF})


if __name__ == '__main__':
    support.main(TestFaults)
