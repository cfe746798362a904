#!/usr/bin/python3
"""A silent line is detected, and not counted as travel. A last stop that is not confirmed is reported."""
import signal

from driven import STOP, DrivenRobot
import support


class TestCreateSilence(support.Case):
    def check(self, robot_type, distance):
        robot = DrivenRobot(self, robot_type)
        with robot.driving():
            robot.switch('silence', True)
        robot.node.wait_for_line('The robot has stopped responding')
        robot.wait_for_status('The robot does not answer')
        count = len(robot.received())
        self.assertTrue(robot.moving)
        robot.switch('silence', False)
        robot.wait_for_standstill()
        # the first command that concerns the wheels; a request of the mode may come before it
        self.assertEqual(robot.wait_for_command(count, lambda _, data: data[:1] == STOP[:1])[1], STOP)
        robot.wait_for_status('Stationary')
        self.assertLess(abs(robot.error()[0]), distance)

    def test_a_create(self):
        # a reply in transit may be lost or not: half of 0.2 m/s for 33 ms, more on a busy machine
        self.check('create', 0.03)

    def test_a_create_2(self):
        self.check('create2', 0.001)

    def test_a_stop_that_is_not_confirmed(self):
        robot = DrivenRobot(self, 'create2')
        robot.wait_for_motion()
        robot.switch('silence', True)
        robot.node.signal(signal.SIGTERM)
        self.assertEqual(robot.node.wait(), 1, robot.node.output)
        self.assertIn('The robot has not confirmed that it stopped. If it is still moving, stop it by hand',
                      robot.node.output)
        self.assertTrue(robot.moving)


if __name__ == '__main__':
    support.main(TestCreateSilence)
