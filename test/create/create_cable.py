#!/usr/bin/python3
"""The cable is unplugged and plugged in during motion: a stop is sent first, and the odometry includes the gap."""

from driven import CHI_SQUARE, IDEAL, STOP, DrivenRobot
import support


class TestCreateCable(support.Case):
    def check(self, robot_type):
        robot = DrivenRobot(self, robot_type, **IDEAL)
        for _ in range(2):
            with robot.driving(0.2, 0.3):
                start = robot.truth.next()
                robot.switch('pull_cable', True)
            robot.node.wait_for_line('Lost the serial connection')
            robot.wait_for_status('no such device')
            # the robot keeps executing its last command
            support.wait_for(lambda: abs(support.yaw(robot.truth.next()) - support.yaw(start)) > 0.3, 'it to move on')
            count = len(robot.received())
            robot.switch('pull_cable', False)
            robot.wait_for_standstill()
            self.assertEqual(robot.wait_for_command(count)[1], STOP)
            robot.wait_for_status('Stationary')
            self.assertLess(robot.normalized_error(), CHI_SQUARE)
        self.assertEqual(robot.value('Serial line', 'Dropouts'), '2')

    def test_a_create(self):
        self.check('create')

    def test_a_create_2(self):
        self.check('create2')


if __name__ == '__main__':
    support.main(TestCreateCable)
