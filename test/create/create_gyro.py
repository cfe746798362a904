#!/usr/bin/python3
"""A gyro fault in motion: imu/data pauses at once, with an error in the log and /diagnostics, until the gyro works
again."""
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Imu

from driven import DrivenRobot
import support


class TestCreateGyro(support.Case):
    def test_no_power_in_a_turn(self):
        robot = DrivenRobot(self, 'create', gyro_scale_correction=1.0)
        imu = support.Watch('/imu/data', Imu)
        robot.wait_for_motion(0.0, 0.5)
        robot.publish('gyro_stuck', 12)
        robot.drive(0.0, 0.5, lambda: 'Gyro: ' in robot.node.output, 'the error')
        broken = len(imu.messages)
        robot.node.wait_for_line(r'\[ERROR\].* Gyro: 12 counts: expected at least 100: does it have power\?')
        robot.wait_for_status('12 counts', 'Gyro')
        self.assertEqual(robot.status('Gyro').level, DiagnosticStatus.ERROR)
        self.assertEqual(robot.value('Gyro', 'Reading (counts)'), '12')
        # -(12 - 512) / 512 * 150 degrees/s is 2.6 rad/s; the robot turns at 0.5 rad/s
        self.assertLess(max(abs(message.angular_velocity.z) for message in imu.messages), 0.6)
        self.assertEqual(len(imu.messages), broken)

        robot.publish('gyro_stuck', -1)
        robot.wait_for_standstill()
        robot.node.wait_for_line('Gyro: working again')
        robot.wait_for_status('Calibrated', 'Gyro')
        self.assertLess(abs(imu.next().angular_velocity.z), 0.01)
        self.assertEqual(robot.node.output.count('Gyro: '), 2, robot.node.output)


if __name__ == '__main__':
    support.main(TestCreateGyro)
