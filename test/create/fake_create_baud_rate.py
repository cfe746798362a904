#!/usr/bin/python3
"""At a wrong baud rate, only garbage passes the line; after the Baud command, the new rate is right."""
from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import PASSIVE, command, drive_direct
import support


class TestBaudRate(support.Case):
    def test_baud_rates(self):
        for robot_type, wrong in ('create', 115200), ('create2', 57600):
            robot = EmulatedRobot(self, robot_type)
            robot.open(wrong)
            robot.port.write(command('start') + command('full') + drive_direct(100, 100))
            robot.wait_until_read()
            robot.port.close()
            robot.open()
            robot.send(command('start'))
            # garbage may contain a command, but not this one
            self.assertNotIn(drive_direct(100, 100), [data for _, data in robot.received()])
            self.assertFalse(robot.moving)
            robot.send(command('stream', 1, 35))
            frame = bytes((19, 2, 35, PASSIVE))
            robot.port.read_until(frame)
            self.assertIn(frame, robot.port.read(50))
            robot.port.baudrate = wrong
            robot.port.reset_input_buffer()
            robot.port.read(20)
            self.assertNotIn(frame, robot.port.read(50))
            robot.port.baudrate = robot.model.baud
            robot.send(command('pause_resume_stream', 0))
            # 19200, a rate that both robots know
            robot.send(command('baud', 7))      # the robot has received it, so the rate may change
            robot.port.baudrate = 19200
            self.assertEqual(robot.read(35), {'mode': PASSIVE})
            robot.end()


if __name__ == '__main__':
    support.main(TestBaudRate)
