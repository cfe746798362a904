#!/usr/bin/python3
"""1 % of the bytes from the robot are corrupted: it continues to drive, and the odometry remains right."""

from driven import DrivenRobot
import support


class TestCreateCorruption(support.Case):
    def test_a_create_2(self):
        robot = DrivenRobot(self, 'create2')
        robot.publish('corruption', 0.01)
        robot.drive(0.2, 0.0, lambda: robot.truth.last.pose.pose.position.x > 1.0, 'a meter')
        robot.drive(0.0, 1.0, lambda: support.yaw(robot.truth.last) > 3.0, 'half a turn')
        robot.wait_for_standstill()
        robot.publish('corruption', 0.0)
        robot.diagnostics.next()
        robot.diagnostics.next()
        # each reply of 29 bytes is corrupted with a probability of 0.25, at 30 replies per second
        self.assertGreater(int(robot.value('Serial line', 'Lost replies')), 20)
        self.assertEqual(robot.value('Serial line', 'Dropouts'), '0')
        self.assertLess(max(map(abs, robot.error())), 0.003)     # rounding along a path of 1 m


if __name__ == '__main__':
    support.main(TestCreateCorruption)
