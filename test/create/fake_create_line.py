#!/usr/bin/python3
"""/line shows each command that the emulated robot receives, even if it ignores it, with the time of the last byte."""
import time

from emulated import EmulatedRobot
from rbx1_nav.extras.create.protocol import command, drive_direct
import support

CLOCKS = 0.001      # s: the robot and the stamps use different clocks


class TestLine(support.Case):
    def test_line(self):
        robot = EmulatedRobot(self, 'create')
        robot.open()
        sent = time.time()
        # in passive mode, the robot ignores the second command
        stamp = robot.send(command('start'), drive_direct(100, -100))
        received = time.time()
        self.assertEqual([data for _, data in robot.received()], [command('start'), bytes((145, 0, 100, 255, 156))])
        self.assertTrue(sent + 6 * 10 / 57600 - CLOCKS <= stamp <= received + CLOCKS, (sent, stamp, received))

        robot.port.write(drive_direct(1, 2)[:3])
        robot.wait_until_read()
        sent = time.time()
        self.assertEqual(len(robot.received()), 2)
        robot.port.write(drive_direct(1, 2)[3:])
        support.wait_for(lambda: len(robot.received()) == 3, 'the rest of the command')
        stamp, data = robot.received()[-1]
        self.assertEqual(data, drive_direct(1, 2))
        self.assertGreaterEqual(stamp, sent - CLOCKS)


if __name__ == '__main__':
    support.main(TestLine)
